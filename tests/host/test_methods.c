/* test_methods.c: every method with every form of scene, with compensated sums, energy balance and contacts, must
 * have its order or be refused. Also accelerations compared with a reference. */
#include "test.h"

#include "host/cli/commands.h"
#include "host/engine/start.h"

#include "command.h"
#include "motion.h"

/* === suite methods ============================================================================ */

/* A form and a mechanism of this form, whose scene ends at 1 s or 0.25 s. Steps are 2^-k s, so that a whole number
 * of them fits. */
typedef struct form {
    const char *name;
    wh_form form;
    bool ledger;      /* the mechanism has energies */
    bool no_rates;    /* accelerations do not depend on rates */
    const char *kind; /* why the first-order form is refused, or NULL */
    const char *text;
} form;

#define PENDULUM \
    "mechanism m\ncoordinate a [rad]\ncoordinate x [m]\n" \
    "T = 2 [kg]*x'^2/2 + 1 [kg]*0.5 [m]*cos(a)*a'*x' + 0.5 [kg*m^2]*a'^2/2\n" \
    "V = -4 [J]*cos(a) + 3 [N/m]*x^2/2\nF = 0.2 [N*s/m]*x'^2/2\n"
#define SWING \
    "{ start a = 0.7, x = 0.3 [m], a' = 0.4 [rad/s], x' = -0.2 [m/s]; step 1 [s]; until 1 [s] }\n"
#define OSCILLATOR \
    "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 4 [N/m]*x^2/2 + 1 [N/m^3]*x^4/4\n"

static const form forms[] = {
    {"second order, turn angle and length", WH_SECOND_ORDER, true, false, NULL,
     PENDULUM "scene s " SWING},
    {"second order, no rates", WH_SECOND_ORDER, true, true, NULL,
     "mechanism m\ncoordinate a [rad]\ncoordinate x [m]\n"
     "T = 2 [kg]*x'^2/2 + 0.5 [kg*m^2]*a'^2/2\n"
     "V = -4 [J]*cos(a) + 3 [N/m]*x^2/2 + 1 [N]*x*cos(2*a)\nscene s " SWING},
    {"second order, an angle outside sines", WH_SECOND_ORDER, true, false, NULL,
     PENDULUM
     "effect spring \"\" { V += 0.5 [J]*a^2 }\nscene s "
     "{ with spring; start a = 0.7, x = 0.3 [m], a' = 0.4 [rad/s]; step 1 [s]; until 1 [s] }\n"},
    {"second order, given outright", WH_SECOND_ORDER, false, false, NULL,
     "mechanism m\nstate x [m]\nstate a [rad]\n"
     "equation x'' + 4 [1/s^2]*x + 0.3 [1/s]*x' = 0.2 [m/s^2]*cos(a)\n"
     "equation a'' = -3 [1/s^2]*sin(a) - 0.5 [1/(m*s^2)]*x\n"
     "scene s { start a = 0.7, x = 0.3 [m], a' = 0.4 [rad/s], x' = -0.2 [m/s]; step 1 [s]; until 1 [s] }\n"},
    {"conserved, closed", WH_SECOND_ORDER, true, false, NULL,
     "mechanism m\ncoordinate a [rad]\ncoordinate x [m]\n"
     "T = 2 [kg]*x'^2/2 + 1 [kg]*0.5 [m]*cos(a)*a'*x' + 0.5 [kg*m^2]*a'^2/2\nV = -4 [J]*cos(a)\n"
     "scene s { conserve x; start a = 0.7, a' = 0.4 [rad/s], x' = 0.2 [m/s]; step 1 [s]; until 1 [s] }\n"},
    {"a stop out of reach, friction that slides", WH_SECOND_ORDER, true, false, NULL,
     PENDULUM
     "friction x static 0.2 kinetic 0.1 normal 1 [N]\nstop x <= 20 [m] restitution 0.5\n"
     "scene s { start a = 0.7, x = 0.3 [m], a' = 0.4 [rad/s], x' = -2 [m/s]; step 0.25 [s]; until 0.25 [s] }\n"},
    {"a stop that is hit", WH_SECOND_ORDER, true, false, NULL,
     OSCILLATOR "stop x >= -0.1 [m] restitution 0.7\n"
                "scene s { start x = 0.3 [m], x' = -0.8 [m/s]; step 1 [s]; until 1 [s] }\n"},
    {"a crossing that is taken", WH_SECOND_ORDER, true, false, NULL,
     OSCILLATOR
     "input u = 0 [N]\nQ(x) = u\nscene s { when x crosses 0 [m] falling { set x' = 0.5*x' }\n"
     "start x = 0.3 [m], x' = -0.8 [m/s]; step 1 [s]; until 1 [s] }\n"},
    {"first order", WH_FIRST_ORDER, false, false, "'x' is of order 1",
     "mechanism m\nstate x\nstate a [rad]\nequation x' = 1 [1/s]*(cos(a) - x^2)\n"
     "equation a' = 2 [1/s]*(1 + 0.4*x*sin(a))\n"
     "scene s { start x = 0.4, a = 0.3; step 1 [s]; until 1 [s] }\n"},
    {"orders one and two", WH_FIRST_ORDER, false, false, "'i' is of order 1",
     "mechanism m\nstate a [rad]\nstate i [A]\n"
     "equation a'' = -3 [1/s^2]*sin(a) + 1 [1/(A*s^2)]*i\n"
     "equation i' = -2 [1/s]*i - 0.5 [A]*a'\n"
     "scene s { start a = 0.7, a' = 0.4 [rad/s], i = 1 [A]; step 1 [s]; until 1 [s] }\n"},
    {"order three", WH_FIRST_ORDER, false, false, "'x' is of order 3",
     "mechanism m\nstate x [m]\nequation x''' = -1 [1/s]*x'' - 2 [1/s^2]*x' - 1 [1/s^3]*x\n"
     "scene s { start x = 0.7 [m], x' = 0.4 [m/s], x'' = 1 [m/s^2]; step 1 [s]; until 1 [s] }\n"},
    {"conserved, integrated", WH_FIRST_ORDER, false, false,
     "the rate of 't' follows from its conserved momentum",
     "mechanism m\ncoordinate t [s]\ncoordinate x [m]\n"
     "T = 1e-9 [J]*t'^2/2 + 2 [kg]*x'^2/2\nV = 5 [N/m]*x^2/2\nQ(x) = 4 [N]*sin(3 [rad/s]*t)\n"
     "scene s { start t' = 1, x = 0.3 [m]; conserve t; step 1 [s]; until 1 [s] }\n"},
};
enum { FORMS = sizeof forms / sizeof forms[0], VALUES = 64 };

static bool takes(const form *f, wh_method method, bool ledger) {
    return wh_method_takes(method, f->form) &&
           (wh_methods[method].takes != WH_NO_RATES || (f->no_rates && !ledger));
}

/* Computes the state at the end, with steps of 2^-halvings s. */
static int end_of(const form *f, stepping how, int halvings, double value[VALUES]) {
    motion m;
    how.step_s = ldexp(1.0, -halvings);
    motion_open_text(&m, f->text, how);
    TEST_ASSERT_EQUAL_INT_MESSAGE(f->form, m.image->form, f->name);
    TEST_ASSERT_TRUE_MESSAGE(start_has_method(m.image, how.method, m.errors), f->name);
    TEST_ASSERT_EQUAL_INT_MESSAGE(WH_OK, motion_step(&m, m.instance->steps), f->name);
    const int angles = m.image->angles;
    const int count = angles + m.image->reals;
    m.kind->state(m.run, value, value + angles);
    motion_close(&m);
    return count;
}

static double distance(const form *f, stepping how, int halvings) {
    double coarse[VALUES];
    double fine[VALUES];
    double sum = 0.0;
    const int count = end_of(f, how, halvings, coarse);
    end_of(f, how, halvings + 1, fine);
    for (int i = 0; i < count; i++) {
        sum = hypot(sum, coarse[i] - fine[i]);
    }
    return sum;
}

TEST(methods, orders_are_those_of_the_names) {
    int measured = 0;
    for (int i = 0; i < FORMS; i++) {
        const form *f = &forms[i];
        for (int k = 0; k < 4 * WH_METHODS; k++) {
            const wh_method method = (wh_method)(k % WH_METHODS);
            const bool compensated = (k / WH_METHODS) % 2 != 0;
            const bool ledger = k / WH_METHODS >= 2;
            if ((unsigned)(i + k + k / WH_METHODS) % few_or_all(4, 1) != 0 ||
                (ledger && !f->ledger) || !takes(f, method, ledger)) {
                continue;
            }
            const stepping how = {.kind = &engine_double,
                                  .method = method,
                                  .compensated = compensated,
                                  .ledger = ledger};
            const int wanted = wh_methods[method].order;
            /* fewer halvings for a method of fifth order, whose error depends on the place in a step where the stop
             * is hit */
            const bool hits = strstr(f->name, "is hit") != NULL;
            const int halvings = wanted < 5 ? 12 - 2 * wanted : hits ? 2 : 3; /* log2(1 s/step) */
            const int more = wanted < 5 ? 1 : 7 - halvings;
            const double order =
                log2(distance(f, how, halvings) / distance(f, how, halvings + more)) / more;
            char what[160];
            snprintf(what, sizeof what, "%s, %s%s%s: order %.3f", f->name, wh_methods[method].word,
                     compensated ? ", compensated" : "", ledger ? ", ledger" : "", order);
            TEST_ASSERT_TRUE_MESSAGE(fabs(order - wanted) < 0.2, what);
            measured++;
        }
    }
    printf("  %d orders measured\n", measured);
}

TEST(methods, ledger_has_the_methods_order) {
    int measured = 0;
    for (int i = 0; i < FORMS; i++) {
        for (int m = 0; m < WH_METHODS && forms[i].ledger; m++) {
            double left_J[2];
            const int wanted = wh_methods[m].order;
            if ((unsigned)(i + m) % few_or_all(3, 1) != 0 ||
                !takes(&forms[i], (wh_method)m, true)) {
                continue;
            }
            for (int k = 0; k < 2; k++) {
                motion run;
                double entry[VALUES];
                double error[VALUES];
                const double step_s =
                    1.0 / (double)(1U << ((wanted < 4 ? 13 - 2 * wanted : 14 - 2 * wanted) + k));
                motion_open_text(&run, forms[i].text,
                                 (stepping){.kind = &engine_double,
                                            .method = (wh_method)m,
                                            .step_s = step_s,
                                            .ledger = true});
                TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&run, (uint64_t)(0.25 / step_s)));
                run.kind->ledger(run.run, entry, error);
                left_J[k] = fabs(error[0]);
                motion_close(&run);
            }
            char what[160];
            snprintf(what, sizeof what, "%s, %s: %.3g J, %.3g J with half the step", forms[i].name,
                     wh_methods[m].word, left_J[0], left_J[1]);
            TEST_ASSERT_TRUE_MESSAGE(log2(left_J[0] / left_J[1]) > wanted - 0.2, what);
            TEST_ASSERT_TRUE_MESSAGE(left_J[1] > 1e-14, what); /* smaller would be round-off */
            measured++;
        }
    }
    printf("  %d books measured\n", measured);
}

/* Both Euler methods have order one. One moves the position by the old rate, the other by the new rate. */
TEST(methods, semi_implicit_euler_moves_by_the_new_rates) {
    const double h = 1.0 / 256.0;
    for (int i = 0; i < FORMS; i++) {
        const form *f = &forms[i];
        for (int k = 0; k < 8 && f->form == WH_SECOND_ORDER; k++) {
            motion m;
            const bool semi = k % 2 != 0;
            const bool ledger = k >= 4 && f->ledger;
            motion_open_text(&m, f->text,
                             (stepping){.kind = &engine_double,
                                        .method = semi ? WH_SEMI_IMPLICIT_EULER : WH_EULER,
                                        .compensated = k / 2 % 2 != 0,
                                        .step_s = h,
                                        .ledger = ledger});
            double before[VALUES];
            double after[VALUES];
            const int n = m.image->coordinates; /* positions, then rates, in the same sequence */
            m.kind->state(m.run, before, before + m.image->angles);
            TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
            m.kind->state(m.run, after, after + m.image->angles);
            for (int c = 0; c < n; c++) {
                const double by = h * (semi ? after : before)[n + c];
                TEST_ASSERT_TRUE(fabs(after[n + c] - before[n + c]) > 1e-6);
                TEST_ASSERT_TRUE_MESSAGE(fabs(after[c] - before[c] - by) < 1e-15, f->name);
            }
            motion_close(&m);
        }
    }
}

TEST(methods, unsuitable_methods_are_refused) {
    int refused = 0;
    int asked = 0;
    for (int i = 0; i < FORMS; i++) {
        motion m;
        motion_open_text(&m, forms[i].text, IN_DOUBLE);
        for (int method = 0; method < WH_METHODS; method++) {
            char *text = NULL;
            size_t length = 0;
            FILE *out = open_memstream(&text, &length);
            const bool has = start_has_method(m.image, (wh_method)method, m.errors);
            diags_flush(m.errors, out);
            fclose(out);
            const bool wanted = takes(&forms[i], (wh_method)method, false);
            TEST_ASSERT_TRUE_MESSAGE(has == wanted, forms[i].name);
            TEST_ASSERT_TRUE_MESSAGE(has == (length == 0), text);
            const char *kind = wh_methods[method].takes == WH_NO_RATES && forms[i].kind == NULL
                                   ? "accelerations depend on the rate of"
                                   : forms[i].kind;
            const bool hits = kind != NULL && strstr(text, "is not defined with contacts") != NULL;
            TEST_ASSERT_TRUE_MESSAGE(has || hits || strstr(text, kind) != NULL, text);
            TEST_ASSERT_TRUE_MESSAGE(has || strstr(text, "hint: ") != NULL, text);
            refused += !has;
            asked += !wanted;
            free(text);
        }
        motion_close(&m);
    }
    TEST_ASSERT_TRUE(asked >= 4);
    TEST_ASSERT_EQUAL_INT(asked, refused);
}

/* === suite reference ========================================================================== */
/* The output of `whirl accel`, compared with accelerations that SymPy and mpmath derived (tests/reference/accel.txt,
 * made by derive.py).
 *
 * The criterion is |got - want| <= 1e-12 |want|. If the reference is zero, the bound is 1e-12 of the largest
 * acceleration of the state, or 1e-12 if all are zero. */

#define REFERENCE "tests/reference/accel.txt"
#define TOLERANCE 1e-12
enum { LINE = 2048, WORDS = 40 };

/* Splits `text` into words, stores them after the first `count` words, and then NULL. Returns the number of words. */
static int split(char *text, const char *words[WORDS], int count) {
    char *rest = NULL;
    for (char *word = strtok_r(text, " \n", &rest); word != NULL;
         word = strtok_r(NULL, " \n", &rest)) {
        TEST_ASSERT_TRUE(count + 1 < WORDS);
        words[count++] = word;
    }
    words[count] = NULL;
    return count;
}

/* The value in a line such as `theta'' = 1.25`; NaN if there is no such name. */
static double value_of(const char *text, const char *name) {
    char line[100];
    snprintf(line, sizeof line, "\n%s = ", name);
    const char *at = strstr(text, line + 1) == text ? text : strstr(text, line);
    return at != NULL ? strtod(strchr(at, '=') + 1, NULL) : (double)NAN;
}

/* Checks a line `FILE | a=1 b'=2 | a''=3 b''=4`. Returns the number of accelerations. */
static int check_line(char *line, double *worst) {
    static said what;
    const char *words[WORDS];
    const char *wanted[WORDS];
    double value[WORDS];
    double scale = 0.0;
    char *given = strchr(line, '|');
    char *expected = given != NULL ? strchr(given + 1, '|') : NULL;
    TEST_ASSERT_NOT_NULL_MESSAGE(expected, "malformed line in " REFERENCE);
    *given = *expected = '\0';
    (void)split(given + 1, words, split(line, words, 0));
    const int count = split(expected + 1, wanted, 0);
    command_say(command_accel, words, &what);
    TEST_ASSERT_EQUAL_STRING("", what.err);
    TEST_ASSERT_EQUAL_INT(0, what.status);
    for (int i = 0; i < count; i++) {
        char *equals = strchr(wanted[i], '=');
        *equals = '\0';
        value[i] = strtod(equals + 1, NULL);
        scale = fmax(scale, fabs(value[i]));
    }
    int lines = 0;
    for (const char *at = what.out; (at = strchr(at, '\n')) != NULL; at++) {
        lines++;
    }
    TEST_ASSERT_EQUAL_INT_MESSAGE(count, lines, what.out);
    for (int i = 0; i < count; i++) {
        char about[200];
        const double got = value_of(what.out, wanted[i]);
        const double size = value[i] != 0.0 ? fabs(value[i]) : scale > 0.0 ? scale : 1.0;
        const double off = fabs(got - value[i]) / size;
        snprintf(about, sizeof about, "%s: %s is %.17g, not %.17g", words[0], wanted[i], got,
                 value[i]);
        TEST_ASSERT_TRUE_MESSAGE(off <= TOLERANCE, about); /* false for NaN, too */
        *worst = fmax(*worst, off);
    }
    return count;
}

static void check_folder(const char *folder, int states_at_least) {
    FILE *file = fopen(REFERENCE, "r");
    TEST_ASSERT_NOT_NULL_MESSAGE(file, REFERENCE " cannot be read: run from the project's root");
    char line[LINE];
    int states = 0;
    int values = 0;
    double worst = 0.0;
    while (fgets(line, (int)sizeof line, file) != NULL) {
        TEST_ASSERT_NOT_NULL_MESSAGE(strchr(line, '\n'), "a reference line is too long");
        if (strncmp(line, folder, strlen(folder)) == 0) {
            values += check_line(line, &worst);
            states++;
        }
    }
    fclose(file);
    printf("  %s: %d values in %d states, off by at most %.2g\n", folder, values, states, worst);
    TEST_ASSERT_TRUE_MESSAGE(states >= states_at_least, "too few reference states read");
}

TEST(reference, accelerations_of_the_dissertations_mechanisms) {
    check_folder("core/models/", 120);
}

TEST(reference, accelerations_of_textbook_mechanisms_and_systems) {
    check_folder("tests/mechanisms/", 186);
}

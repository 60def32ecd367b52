/* test_price.c: the cost of operation lists, for expressions whose least cost is known. Also trials.
 * Other suites test the values. */
#include "test.h"

#include "host/base/alloc.h"
#include "host/fixed/engine_fixed.h"
#include "host/fixed/fixed_plan.h"
#include "host/study/price_table.h"

#include "command.h"
#include "derived.h"
#include "priced.h"

/* === suite price ============================================================================== */

/* Number of operations, and of pairs of sine and cosine, for one output. The names are seven numbers x0 ... x6 and
 * two angles a and b. */
typedef struct price {
    int operations;
    int waves;
} price;

__attribute__((format(printf, 1, 2))) static price price_of(const char *format, ...) {
    char output[2000];
    char text[3000];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(output, sizeof output, format, arguments);
    va_end(arguments);
    snprintf(
        text, sizeof text,
        "mechanism m\ncoordinate x0\ncoordinate x1\ncoordinate x2\ncoordinate x3\n"
        "coordinate x4\ncoordinate x5\ncoordinate x6\ncoordinate a [rad]\ncoordinate b [rad]\n"
        "T = 1 [kg*m^2]*(x0'^2 + x1'^2 + x2'^2 + x3'^2 + x4'^2 + x5'^2 + x6'^2 + a'^2 + b'^2)/2\n"
        "output it = %s\n",
        output);
    derived d = derived_surely(derived_text(text), text);
    const price of = {op_list_operations(d.image->list[IMAGE_OBSERVE]),
                      op_list_count(d.image->list[IMAGE_OBSERVE]).waves};
    derived_free(&d);
    return of;
}

static void expect(price got, int operations, int waves, const char *what) {
    char line[2200];
    snprintf(line, sizeof line, "%s: %d operations, %d sine pairs; wanted %d, %d", what,
             got.operations, got.waves, operations, waves);
    TEST_ASSERT_TRUE_MESSAGE(got.operations <= operations && got.waves <= waves, line);
}

/* Horner's scheme needs a product and a sum for each power. */
TEST(price, polynomials_use_horners_scheme) {
    for (int degree = 1; degree <= 9; degree++) {
        char sum[400] = "1";
        for (int k = 1; k <= degree; k++) {
            snprintf(sum + strlen(sum), sizeof sum - strlen(sum), " %c %d*x0^%d",
                     k % 3 == 0 ? '-' : '+', k + 1, k);
        }
        expect(price_of("%s", sum), 2 * degree, 0, sum);
    }
}

TEST(price, equal_coefficients_are_taken_out) {
    uint64_t seed = 17;
    for (int count = 2; count <= 7; count++) {
        for (int round = 0; round < 8; round++) {
            char sum[200] = "0";
            bool plus = false;
            for (int k = 0; k < count; k++) {
                const bool negative = random_one_of(&seed, 2) != 0;
                plus = plus || !negative;
                snprintf(sum + strlen(sum), sizeof sum - strlen(sum), " %c 3*x%d",
                         negative ? '-' : '+', k);
            }
            expect(price_of("%s", sum), count - 1 + 1 + (plus ? 0 : 1), 0, sum);
            expect(price_of("%s + 5*x0*x1", sum), count - 1 + 1 + (plus ? 0 : 1) + 3, 0, sum);
        }
    }
}

/* The algebra expands a product of nested sums. The operation list must still cost no more than the nested form. */
TEST(price, factors_are_taken_out_again) {
    expect(price_of("x0*(2*x1 + 3*x2)"), 4, 0, "one factor");
    expect(price_of("x0*(2*x1 + x2*(3*x3 + 5*x4))"), 7, 0, "a factor inside");
    expect(price_of("x0*(2*x1 + x2*(3*x3 + x4*(5*x5 + 7*x6)))"), 10, 0, "two factors inside");
    expect(price_of("x0^2*(2*x1 + 3*x2) + x0*5*x3 + 7"), 9, 0, "powers of a factor");
    expect(price_of("x0*x1*(2*x2 + 3*x3) + 5*x4*x5"), 8, 0, "two factors");
    expect(price_of("1 [s]*x0'*(2*x1 + 3*x2) + x3*(5*x1 + 7*x4)"), 9, 0, "rates");
    expect(price_of("x0*x1 + x0*x2 + x0*x3"), 3, 0, "no coefficients");
}

TEST(price, common_subexpressions_are_computed_once) {
    static const char *const of[] = {"exp(x0)",    "sqrt(x0)",    "atan2(x0, x1)", "abs(x0)",
                                     "log(x0*x1)", "max(x0, x1)", "sin(x0*x1)"};
    for (size_t i = 0; i < sizeof of / sizeof of[0]; i++) {
        const price one = price_of("%s", of[i]);
        expect(price_of("%s*x2 + 3*%s*x3", of[i], of[i]), one.operations + 3, one.waves, of[i]);
        expect(price_of("x4 + 5*%s + 3*x2*%s", of[i], of[i]), one.operations + 4, one.waves, of[i]);
    }
}

TEST(price, sines_of_multiples_follow_from_one) {
    uint64_t seed = 19;
    for (int round = 0; round < 24; round++) {
        char sum[400] = "7*sin(a)*x0";
        for (int k = 1; k <= 4; k++) {
            snprintf(sum + strlen(sum), sizeof sum - strlen(sum), " + %d*%s(%u*a)", k + 1,
                     random_one_of(&seed, 2) != 0 ? "sin" : "cos",
                     random_one_of(&seed, 2) + (unsigned)k);
        }
        expect(price_of("%s", sum), 40, 1, sum);
    }
    expect(price_of("exp(sin(a)) + 3*exp(cos(2*a))"), 40, 1, "sines inside functions");
    expect(price_of("atan2(sin(2*a), x0 + cos(a)) + x1*sqrt(3 + sin(3*a))"), 40, 1, "sines inside");
    expect(price_of("sin(x0*sin(2*a)) + x1*cos(a)"), 40, 2, "a sine inside a sine");
    expect(price_of("sin(2*a) + 3*sin(a)"), 6, 1, "twice an angle");
    expect(price_of("3*cos(2*a)"), 5, 1, "the cosine of twice an angle");
    expect(price_of("cos(a + b) + 3*cos(a) + 5*cos(b)"), 11, 2, "a sum of angles");
    expect(price_of("3*cos(a - b) + 5*sin(a) + cos(b)"), 11, 2, "a difference of angles");
}

/* Powers of sines must stay powers if an expansion into sums would lose digits and cost more. */
TEST(price, powers_of_sines_are_restored) {
    for (int n = 1; n <= 7; n++) {
        char what[60];
        int products = -2;
        for (int rest = 2 * n; rest > 0; rest /= 2) {
            products += 1 + rest % 2;
        }
        snprintf(what, sizeof what, "sin(a)^%d", 2 * n);
        expect(price_of("%s", what), 1 + products, 1, what);
        snprintf(what, sizeof what, "cos(a)^%d", 2 * n);
        expect(price_of("%s", what), 1 + products, 1, what);
    }
    expect(price_of("x0*(1 + cos(2*a))"), 4, 1, "a square of a cosine");
    expect(price_of("1 - cos(2*a)"), 3, 1, "a square of a sine");
    expect(price_of("x0*(1 - cos(2*a)) + x1*(1 + cos(4*b))"), 9, 2, "squares beside each other");
}

/* Returns the operations of a step with n equations. Each coefficient and each right side is a state of its own, but
 * the coefficient with index `number` is the constant 3. */
static int price_of_system(int n, int number) {
    char text[4000] = "mechanism m\n";
#define PUT(...) snprintf(text + strlen(text), sizeof text - strlen(text), __VA_ARGS__)
    for (int i = 0; i < n * (n + 2); i++) {
        PUT("state s%d\n", i);
    }
    for (int i = 0; i < n; i++) {
        PUT("equation 1 [s]*(0");
        for (int j = 0; j < n; j++) {
            PUT(i * n + j == number ? " + 3*s%d'" : " + s%d'*s%d", j, n + i * (n + 1) + j);
        }
        PUT(") = s%d\n", n + i * (n + 1) + n);
    }
    for (int i = n; i < n * (n + 2); i++) {
        PUT("equation 1 [s]*s%d' = 0\n", i);
    }
#undef PUT
    derived d = derived_surely(derived_text(text), text);
    const int operations = op_list_operations(d.image->list[IMAGE_STEP]);
    derived_free(&d);
    printf("  %d equations: %d operations\n", n, operations);
    return operations;
}

/* Up to three equations are solved by Cramer's rule. Each further equation costs an elimination: divide a column,
 * subtract the row from each other row, and substitute back. */
TEST(price, equations_are_eliminated_one_by_one) {
    int last = 0; /* operations of the system with one equation fewer */
    for (int n = 1; n <= 6; n++) {
        const int now = price_of_system(n, -1);
        const int more = (n - 1) + 2 * (n - 1) * (n - 1) + 2 * (n - 1) + 2 * (n - 1) + 1;
        const int most = n == 1 ? 1 : n == 2 ? 12 : n == 3 ? 43 : last + more;
        TEST_ASSERT_TRUE_MESSAGE(now <= most, "elimination");
        last = now;
    }
}

/* If a coefficient of two equations is a number, it must be the pivot, wherever it is, and no determinant is needed.
 * Forward: a quotient, two products with a difference each, a quotient. Back: a product, a difference, a quotient. */
TEST(price, a_number_is_the_pivot) {
    for (int at = 0; at < 4; at++) {
        TEST_ASSERT_LESS_OR_EQUAL_INT(9, price_of_system(2, at));
    }
}

/* The cost must not depend on the decimals of parameters. Values that differ by round-off count as one number, and a
 * value near a simple fraction counts as that fraction. */
TEST(price, decimals_cost_nothing) {
    uint64_t seed = 23;
    int least = 1000;
    int most = 0;
    for (int round = 0; round < 40; round++) {
        char text[600];
        snprintf(text, sizeof text,
                 "mechanism m\ncoordinate a [rad]\ncoordinate b [rad]\ncoordinate x [m]\n"
                 "parameter m = %.17g [kg]\nparameter r = %.17g [m]\nparameter k = %.17g [N/m]\n"
                 "T = m*r^2*(3*a'^2/2 + b'^2 + a'*b'*cos(a - b)/3) + m*x'^2/6 - m*r*x'*a'*sin(a)\n"
                 "V = m*9.81 [m/s^2]*r*(2*cos(a) + cos(b)/3) + k*r^2*(a - b)^2/2 + k*x^2/3\n",
                 random_between(&seed, 0.1, 9.0), random_between(&seed, 0.1, 9.0),
                 random_between(&seed, 1.0, 99.0));
        derived d = derived_surely(derived_text(text), text);
        const int operations = op_list_operations(d.image->list[IMAGE_STEP]);
        least = operations < least ? operations : least;
        most = operations > most ? operations : most;
        derived_free(&d);
    }
    printf("  any parameters: %d to %d operations\n", least, most);
    TEST_ASSERT_EQUAL_INT(least, most);
}

/* === suite price_dearest ====================================================================== */
/* The cost of a setting in trials (host/study/trial.h): the maximum over all places, and settings and steps
 * that a scene refuses. */

/* Three motions of different cost. Only the last one is linear. */
static const char *const springs[] = {
    "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 9 [N/m]*x^2/2\n"
    "scene s { start x = 1 [m]; step 1 [ms]; until 1 [s]\n"
    "range x = -2 .. 2 [m], x' = -9 .. 9 [m/s] }\n",
    "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 9 [N/m]*x^2/2 + 2 [N/m^3]*x^4/4\n"
    "scene s { start x = 1 [m]; step 1 [ms]; until 1 [s]\n"
    "range x = -2 .. 2 [m], x' = -9 .. 9 [m/s] }\n",
    "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 9 [N/m]*x^2/2\nF = 1 [N*s/m]*x'^2/2\n"
    "scene s { start x = 1 [m]; step 1 [ms]; until 1 [s]\n"
    "range x = -2 .. 2 [m], x' = -9 .. 9 [m/s] }\n"};
static const whole_ratio spacing_price_dearest = {1, 500};
enum { PRICE_DEAREST_RECORDS = 100 };

static cost cost_at(priced *p, int point, const setting *s, const char *step) {
    image *im = priced_image(p, point, s, step);
    TEST_ASSERT_NOT_NULL(im);
    diags *errors = diags_new();
    fixed_plan *plan = s->number == &engine_fixed ? fixed_plan_make(im, false, errors) : NULL;
    im->fixed = plan;
    const cost c = cost_of(im, p->request.board, setting_cost_number(s));
    fixed_plan_free(plan);
    diags_free(errors);
    image_free(im);
    return c;
}

static void expect_same(const cost *want, const cost *have, const char *what) {
    TEST_ASSERT_TRUE_MESSAGE(have->instructions_worst.most == want->instructions_worst.most, what);
    TEST_ASSERT_TRUE_MESSAGE(have->cycles.value == want->cycles.value, what);
    TEST_ASSERT_TRUE_MESSAGE(have->flash_bytes.value == want->flash_bytes.value, what);
    TEST_ASSERT_TRUE_MESSAGE(have->state_bytes.value == want->state_bytes.value, what);
}

TEST(price_dearest, dearest_place_counts) {
    static const char *const boards[] = {"mps2-an386", "mps2-an385"};
    for (int turn = 0; turn < 3; turn++) {
        const char *texts[3] = {springs[turn], springs[(turn + 1) % 3], springs[(turn + 2) % 3]};
        priced p;
        priced_open(&p, texts, 3);
        TEST_ASSERT_TRUE(
            priced_begin(&p, boards[turn % 2], spacing_price_dearest, PRICE_DEAREST_RECORDS, NULL));
        const setting s[] = {priced_setting(WH_RK4, &engine_float),
                             priced_setting(WH_HEUN, &engine_double),
                             priced_setting(WH_RK4, &engine_fixed)};
        int known = 0;
        for (int i = 0; i < 3; i++) {
            cost dearest = {0};
            for (int k = 0; k < 3; k++) {
                const cost c = cost_at(&p, k, &s[i], "0.0004");
                if (k == 0 || c.instructions_worst.most > dearest.instructions_worst.most) {
                    dearest = c;
                }
            }
            bool own = false;
            const cost c = trial_cost(&p.trial, &s[i], (deviation_pace){5, 1}, &own);
            TEST_ASSERT_TRUE_MESSAGE(own, c.why);
            expect_same(&dearest, &c, wh_methods[s[i].image.method].word);
            known += c.instructions_worst.most > 0.0;
        }
        TEST_ASSERT_TRUE(known >= 2);
        /* without sines, a table of sines is not a setting of its own */
        setting lookup = s[0];
        lookup.image.angles = ANGLES_LOOKUP;
        bool own = true;
        const cost none = trial_cost(&p.trial, &lookup, (deviation_pace){5, 1}, &own);
        TEST_ASSERT_TRUE(!own && none.instructions.basis == COST_NOT_KNOWN);
        /* leapfrog is not a setting if there is a damper */
        const setting leapfrog = priced_setting(WH_LEAPFROG, &engine_float);
        (void)trial_cost(&p.trial, &leapfrog, (deviation_pace){5, 1}, &own);
        TEST_ASSERT_FALSE(own);
        priced_close(&p);
    }
}

/* Refuses fixed point and matrices if the step is longer than longest_s. */
static double longest_s;
static bool none_longer(const setting *s, double step_s) {
    return !setting_price_varies(s) || step_s <= longest_s;
}

/* If fixed point or a matrix is not possible with a long step, the table must begin with the longest possible step.
 * Without any possible step the setting must not count. */
TEST(price_dearest, refused_steps_are_omitted) {
    static const double longest[] = {2.0, 0.011, 0.0011, 0.00011, 1e-12};
    int settings = 0;
    for (size_t i = 0; i < sizeof longest / sizeof longest[0]; i++) {
        const table_request w = {.operations = 1e8, .periods = 1, .workers = 1};
        double first_s[2] = {0.0, 0.0}; /* longest step in fixed point and by a matrix */
        priced p;
        priced_open(&p, springs, 1);
        TEST_ASSERT_TRUE(
            priced_begin(&p, "mps2-an386", spacing_price_dearest, PRICE_DEAREST_RECORDS, NULL));
        longest_s = longest[i];
        p.takes = none_longer;
        table *made = table_new(&p.trial, &w);
        for (int k = 0; k < made->count; k++) {
            const table_row *row = &made->row[k];
            if (setting_price_varies(&row->setting)) {
                double *first = &first_s[setting_is_fixed(&row->setting) ? 0 : 1];
                *first = fmax(*first, ratio_times(1, trial_step(&p.trial, row->pace)));
            }
        }
        for (int k = 0; k < 2;
             k++) { /* the coarsest step of the table is 0.1 s, the finest 4e-11 s */
            TEST_ASSERT_TRUE(first_s[k] <= longest_s);
            TEST_ASSERT_EQUAL_INT(longest_s > 1e-5, first_s[k] > fmin(longest_s / 3.0, 0.01));
        }
        settings = i == 0 ? made->settings : settings;
        /* fixed point, and two matrices in three number types */
        TEST_ASSERT_EQUAL_INT(longest_s > 1e-5 ? settings : settings - 7, made->settings);
        table_free(made);
        priced_close(&p);
    }
}

TEST(price_dearest, contacts_are_omitted_on_request) {
    priced p;
    priced_open(&p, priced_ball, 1);
    TEST_ASSERT_TRUE(priced_begin(&p, "mps2-an386", spacing_price_dearest, 10, NULL));
    const setting rk4 = priced_setting(WH_RK4, &engine_float);
    image *im = priced_image(&p, 0, &rk4, "0.0004");
    TEST_ASSERT_TRUE(im->contacts > 0);
    bool own;
    const cost with = cost_of(im, p.request.board, COST_FLOAT);
    im->contacts = 0;
    const cost without = cost_of(im, p.request.board, COST_FLOAT);
    im->contacts = 1;
    cost c = trial_cost(&p.trial, &rk4, (deviation_pace){5, 1}, &own);
    expect_same(&with, &c, "with");
    TEST_ASSERT_TRUE(own && with.cycles.value != without.cycles.value);
    p.trial.without_events = true;
    c = trial_cost(&p.trial, &rk4, (deviation_pace){5, 1}, &own);
    expect_same(&without, &c, "without");
    image_free(im);
    priced_close(&p);
}

/* test_rated.c: the accuracy and cost that a run reports at its end, and the step that `--error` chooses, for random
 * scenes with known motions (rated.h). */
#include "derived.h"
#include "host/cli/commands.h"
#include "host/engine/start.h"
#include "host/study/cost.h"
#include "rated.h"

enum { ROWS = 3, WORDS = 20 };
#define RECORDS_FILE "build/tests/rated.columns"

typedef struct told_row {
    double step_s;
    char error[24];
    double cycles, flash, ram, stack;
} told_row;

typedef struct told {
    double until_s;
    told_row row[ROWS];
} told;

static void run(const rated *r, const char *const *more, said *what) {
    const char *words[WORDS] = {"",        model_keep(r->text), "--method",
                                r->method, "--number",          r->number};
    int count = 6;
    words[count] = "--compensated";
    count += r->compensated ? 1 : 0;
    for (; *more != NULL; more++) {
        words[count++] = *more;
    }
    words[count] = NULL;
    command_say(command_run, words + 1, what);
    model_drop();
}

static bool read_rows(const char *text, const char *number, told *t) {
    char head[80];
    snprintf(head, sizeof head,
             "accuracy and cost  in %s on mps2-an386 (Cortex-M4F), until t =", number);
    const char *at = strstr(text, head);
    if (at == NULL) {
        return false;
    }
    at = said_number(at + strlen(head), &t->until_s);
    at = strchr(at, '\n') + 1;
    for (int i = 0; i < ROWS; i++) {
        told_row *row = &t->row[i];
        at = said_number(strchr(at, '\n') + 1, &row->step_s);
        at += strspn(at, " ");
        const size_t length = strncmp(at, "above 1", 7) == 0 ? 7 : strcspn(at, " ");
        snprintf(row->error, sizeof row->error, "%.*s", (int)length, at);
        at = said_number(at + length, &row->cycles);
        at = said_number(at, &row->flash);
        at = said_number(at, &row->ram);
        at = said_number(at, &row->stack);
    }
    return true;
}

/* Largest deviation of a run: of one state in its unit; or, if state = -1, of the worst state relative to its
 * largest value. */
static double error_of(const rated *r, double step_s, double spacing_s, int records,
                       const long double *row, int state) {
    char step[40];
    char every[40];
    char until[40];
    said what;
    snprintf(step, sizeof step, "%.9g", step_s);
    snprintf(every, sizeof every, "%.9g", spacing_s);
    snprintf(until, sizeof until, "%.9g", records * spacing_s);
    run(r,
        (const char *const[]){"--step", step, "--every", every, "--until", until, "--quiet",
                              "--columns", RECORDS_FILE, NULL},
        &what);
    FILE *in = fopen(RECORDS_FILE, "rb");
    TEST_ASSERT_NOT_NULL(in);
    double off[RATED_STATES] = {0};
    double largest[RATED_STATES] = {0};
    static char line[1000];
    bool whole = what.status == said_owes(what.err);
    whole = whole && fgets(line, sizeof line, in) != NULL; /* reads the header */
    for (int k = 0; k <= records && whole; k++) {
        whole = fgets(line, sizeof line, in) != NULL;
        const char *at = line + (whole ? strcspn(line, " ") : 0); /* skips the time column */
        for (int i = 0; i < r->states && whole; i++) {
            const long double now = row[(size_t)k * (size_t)r->states + (size_t)i];
            char *end;
            const double x = strtod(at, &end);
            whole = end != at;
            at = end;
            off[i] = fmax(off[i], (double)fabsl((long double)x - now));
            largest[i] = fmax(largest[i], (double)fabsl(now));
        }
    }
    fclose(in);
    double worst = whole ? 0.0 : (double)INFINITY; /* infinite after a failed run */
    for (int i = 0; i < r->states; i++) {
        const double unit = state >= 0 ? 1.0 : largest[i];
        if (unit > 0.0 && (state < 0 || state == i)) {
            worst = fmax(worst, off[i] / unit);
        }
    }
    return worst;
}

/* The time in the line `trusted`, or the end of the run if the line says so; negative if the line has no time. */
static double trusted_s(const char *text, const rated *r) {
    double until_s = -1.0;
    const char *at = strstr(text, "\ntrusted            ");
    TEST_ASSERT_NOT_NULL(at);
    if (strstr(at, "to the end:") != NULL) {
        return r->until_s;
    }
    const char *until = strstr(at, "until t = ");
    if (until != NULL && until < strchr(at + 1, '\n')) {
        said_number(until + strlen("until t = "), &until_s);
    }
    return until_s;
}

static void check_cost(const rated *r, const told *t) {
    static char text[RATED_TEXT + 40];
    double each_s =
        1e-6; /* the step of `whirl price`: 1, 2 or 5 times a power of ten, at least 1000 steps */
    for (int i = 0; each_s * (i % 3 == 1 ? 2.5 : 2.0) <= r->until_s / 1000.0 * (1.0 + 1e-9); i++) {
        each_s *= i % 3 == 1 ? 2.5 : 2.0;
    }
    const int front = (int)(strstr(r->text, "step ") - r->text);
    snprintf(text, sizeof text, "%.*sstep %.9g [s]; until %.9g [s] }\n", front, r->text, each_s,
             r->until_s);
    derived d = derived_surely(derived_scene(text, "s"), r->text);
    image_settings settings = IMAGE_SETTINGS_DEFAULT;
    diags *errors = diags_new();
    for (int m = 0; m < WH_METHODS; m++) {
        settings.method =
            strcmp(wh_methods[m].word, r->method) == 0 ? (wh_method)m : settings.method;
    }
    settings.compensated = r->compensated;
    image *im = image_make(d.equations, NULL, &settings, IMAGE_TO_RUN, errors);
    const cost c = cost_of(im, cost_board_named("mps2-an386"),
                           strcmp(r->number, "float") == 0 ? COST_FLOAT : COST_DOUBLE);
    for (int i = 0; i < ROWS; i++) {
        char cycles[24];
        const told_row *row = &t->row[i];
        snprintf(cycles, sizeof cycles, "%.3g", c.cycles.value / row->step_s);
        TEST_ASSERT_EQUAL_DOUBLE(strtod(cycles, NULL), row->cycles);
        TEST_ASSERT_EQUAL_DOUBLE(nearbyint(c.flash_bytes.value), row->flash);
        TEST_ASSERT_EQUAL_DOUBLE(nearbyint(c.ram_bytes.value), row->ram);
        TEST_ASSERT_EQUAL_DOUBLE(nearbyint(c.stack_bytes.value), row->stack);
    }
    image_free(im);
    diags_free(errors);
    derived_free(&d);
}

typedef struct measure {
    unsigned compared;    /* number of rows with a known error */
    unsigned at_rounding; /* number of rows in double at the limit of round-off */
    unsigned unsaid;      /* number of scenes without rows */
    double worst_double, worst_float;
} measure;

static void compare(const rated *r, const told_row *row, double error, int steps, measure *m) {
    const bool in_float = strcmp(r->number, "float") == 0;
    char about[RATED_TEXT + 200];
    snprintf(about, sizeof about, "%s%s %s%s, step %g: told %s, it is %g", r->text, r->method,
             r->number, r->compensated ? " compensated" : "", row->step_s, row->error, error);
    if (strcmp(row->error, "above 1") == 0) {
        TEST_ASSERT_TRUE_MESSAGE(error > 0.8, about);
        return;
    }
    if (!in_float && error < 10.0 * DBL_EPSILON * steps) {
        m->at_rounding++;
        return;
    }
    TEST_ASSERT_TRUE_MESSAGE(row->error[0] != '<', about);
    const double ratio = strtod(row->error, NULL) / error;
    const double off = fmax(ratio, 1.0 / ratio);
    TEST_ASSERT_TRUE_MESSAGE(off <= (in_float ? 1.5 : 1.2), about);
    double *worst = in_float ? &m->worst_float : &m->worst_double;
    *worst = fmax(*worst, off);
    m->compared++;
}

static void check_rows(const rated *r, measure *m) {
    static said what;
    told t;
    run(r, (const char *const[]){NULL}, &what);
    TEST_ASSERT_EQUAL_INT_MESSAGE(said_owes(what.err), what.status, what.err);
    const double until_s = trusted_s(what.out, r);
    if (!read_rows(what.out, r->number, &t)) {
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(what.out, "\naccuracy and cost  not shown: "),
                                     what.out);
        TEST_ASSERT_TRUE_MESSAGE(until_s < 4.0 * r->step_s, what.out);
        m->unsaid++;
        return;
    }
    const double spacing_s = 2.0 * r->step_s;
    const double rounded = 1e-5 * r->until_s; /* round-off of the printed times */
    TEST_ASSERT_TRUE_MESSAGE(
        t.until_s <= until_s + rounded && t.until_s > until_s - spacing_s - rounded, what.out);
    const int records = (int)nearbyint(t.until_s / spacing_s);
    long double *row = rated_motion(r, spacing_s, records);
    for (int i = 0; i < ROWS; i++) {
        const double step_s = ldexp(spacing_s, -i);
        TEST_ASSERT_DOUBLE_WITHIN(1e-5 * step_s, step_s, t.row[i].step_s);
        compare(r, &t.row[i], error_of(r, step_s, spacing_s, records, row, -1), records << i, m);
    }
    free(row);
    check_cost(r, &t);
}

static void test_rows_are_right(void) {
    dice d = dice_of("rated", 45);
    const unsigned cases = dice_cases(few_or_all(6, 100));
    measure m = {.worst_double = 1.0, .worst_float = 1.0};
    for (unsigned i = 0; i < cases; i++) {
        rated r;
        rated_draw(&d, &r);
        check_rows(&r, &m);
    }
    printf("  %u scenes: %u rows compared, at most a factor %.3f off in double and %.3f in float; "
           "%u rows of rounding, %u scenes without rows\n",
           cases, m.compared, m.worst_double, m.worst_float, m.at_rounding, m.unsaid);
    TEST_ASSERT_TRUE(m.compared > cases && m.unsaid * 5 <= cases);
}

/* Largest error of the first coordinate at the end of any step. */
static double coordinate_error(const rated *r, double step_s, double until_s) {
    const int records = (int)(until_s / step_s * (1.0 + 1e-9));
    rated of = *r;
    of.step_s = step_s;
    long double *row = rated_motion(&of, step_s, records);
    const double error = error_of(&of, step_s, step_s, records, row, 0);
    free(row);
    return error;
}

/* The chosen step must meet the requested error, and twice that step must not, unless the run says that it tries no
 * longer steps. Returns false if no step was found. */
static bool check_chosen(dice *d, const rated *r) {
    static const char *const names[] = {"q0", "x", "a", "r"};
    static said what;
    char error[60];
    int n = 0;
    while (n < 3 && strstr(r->text, (const char *const[]){"coordinate q0", "coordinate x",
                                                          "coordinate a"}[n]) == NULL) {
        n++;
    }
    const double allowed = pow(10.0, dice_between(d, -6.0, -0.5));
    snprintf(error, sizeof error, "%s=%.6g%s", names[n], allowed * 1e3, n == 2 ? "e-3" : "mm");
    run(r, (const char *const[]){"--error", error, NULL}, &what);
    if (what.status > said_owes(what.err)) {
        TEST_ASSERT_EQUAL_INT_MESSAGE(1, what.status, what.err);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(what.err, "no tried step stays within --error"),
                                     what.err);
        return false;
    }
    double step_s;
    double until_s;
    const char *chosen = strstr(what.out, "chosen step"); /* another sentence may come first */
    TEST_ASSERT_NOT_NULL_MESSAGE(chosen, what.out);
    TEST_ASSERT_TRUE_MESSAGE(strchr(chosen, '\n') < strstr(what.out, " steps to t = "), what.out);
    const char *longer = strstr(chosen, " s would also stay within the error, but has warnings\n");
    const bool warned = strstr(what.err, "warning") != NULL;
    TEST_ASSERT_TRUE_MESSAGE(
        warned <= (strstr(chosen, "the error of this step is within --error") != NULL), what.err);
    TEST_ASSERT_FALSE_MESSAGE(warned && longer != NULL, what.err);
    said_number(chosen + strlen("chosen step"), &step_s);
    said_number(strstr(what.out, "until t = ") + strlen("until t = "), &until_s);
    char about[RATED_TEXT + 300];
    snprintf(about, sizeof about, "%s%s %s, %s: %.100s", r->text, r->method, r->number, error,
             what.out);
    TEST_ASSERT_TRUE_MESSAGE(coordinate_error(r, step_s, until_s) <= 1.05 * allowed, about);
    if (longer != NULL) { /* a longer step meets the error, but with a warning */

        static said other;
        while (longer[-1] != ' ') {
            longer--;
        }
        char step[60];
        snprintf(step, sizeof step, "%.*s", (int)strcspn(longer, " "), longer);
        run(r, (const char *const[]){"--step", step, NULL}, &other);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(other.err, "warning"), about);
        TEST_ASSERT_TRUE_MESSAGE(coordinate_error(r, strtod(step, NULL), until_s) <= 1.05 * allowed,
                                 about);
    } else if (strstr(what.out, "longer steps were not tried") == NULL) {
        TEST_ASSERT_TRUE_MESSAGE(coordinate_error(r, 2.0 * step_s, until_s) > 0.95 * allowed,
                                 about);
    }
    return true;
}

static void test_error_chooses_the_largest_step(void) {
    dice d = dice_of("rated --error", 47);
    const unsigned cases = dice_cases(few_or_all(4, 60));
    unsigned chosen = 0;
    for (unsigned i = 0; i < cases; i++) {
        rated r;
        rated_draw(&d, &r);
        chosen += check_chosen(&d, &r) ? 1 : 0;
    }
    printf("  %u scenes: a step chosen in %u\n", cases, chosen);
    TEST_ASSERT_TRUE(chosen * 2 > cases);
}

static void says(int status, const char *text, const char *const *words) {
    static said what;
    command_say(command_run, words, &what);
    TEST_ASSERT_EQUAL_INT_MESSAGE(status == 0 ? said_owes(what.err) : status, what.status,
                                  what.err);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(status == 0 ? what.out : what.err, text), what.out);
}

static void test_a_run_without_rows_says_why(void) {
#define RUN(...) ((const char *const[]){__VA_ARGS__, NULL})
    says(
        0,
        "not shown: events make the cost of a step depend on the motion; this command in Whirl's source tree shows them: "
        "whirl choose --error 1e-3 ball_bounces --set e=0.5 --until 1s --board rv32imac\n",
        RUN("ball_bounces", "--set", "e=0.5", "--until", "1s", "--board", "rv32imac"));
    says(
        0,
        "not shown: the rows take more than a second; this command shows them: whirl price thomson_a --until 6s\n",
        RUN("thomson_a", "--step", "0.1ms", "--until", "6s"));
    says(0, "not shown: the cost of --stabilized is not known\n",
         RUN("docs/hard/long.whirl:pendulum_swings", "--until", "1s", "--stabilized"));
    says(0, "fewer than two steps", RUN("thomson_a", "--step", "1s", "--until", "1s"));
    says(2, "error: --error chooses the step, so --step cannot set it",
         RUN("thomson_a", "--error", "X=1mm", "--step", "1ms"));
    says(2, "hint: write a value such as --error x=0.1mm", RUN("thomson_a", "--error", "1mm"));
    says(2, "Y is not an output, coordinate or rate", RUN("thomson_a", "--error", "Y=1mm"));
    says(1, "shorter steps do not reduce the error, because of round-off",
         RUN("thomson_a", "--error", "X=1e-15m", "--until", "2s"));
    says(2, "length", RUN("thomson_a", "--error", "X=1s"));
    says(2, "there is no board 'nix'", RUN("thomson_a", "--board", "nix"));
#undef RUN
}

SUITE(rated) {
    RUN_TEST(test_rows_are_right);
    RUN_TEST(test_error_chooses_the_largest_step);
    RUN_TEST(test_a_run_without_rows_says_why);
    (void)remove(RECORDS_FILE);
}

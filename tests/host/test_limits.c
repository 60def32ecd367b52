/* test_limits.c: the longest stable step, by bisection on runs of the program, compared with the methods' stability
 * polynomials on the imaginary and the real axis. Also the steps in hints. */
#include "command.h"
#include "host/check/summary.h"
#include "motion.h"

#define STEPS 40000
#define BEYOND 30.0

static const char spring[] = "mechanism m\ncoordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 1 [N/m]*x^2/2\n"
                             "scene s { start x = 1 [m]\nstep 1 [ms]\nuntil 1e6 [s] }\n";
static const char decay[] = "mechanism m\nstate x [m]\nequation x' = -1 [1/s]*x\n"
                            "scene s { start x = 1 [m]\nstep 1 [ms]\nuntil 1e6 [s] }\n";
static const char system_swing[] =
    "mechanism m\nstate x [m]\nstate v [m/s]\nequation x' = v\nequation v' = -1 [1/s^2]*x\n"
    "scene s { start x = 1 [m]\nstep 1 [ms]\nuntil 1e6 [s] }\n";

/* Does the motion stay bounded? For systems of first order, even a growth of 1e-9 counts: the matrix of a step is
 * normal, so a stable motion never grows. */
static bool stays(const char *text, wh_method method, double step_s) {
    motion m;
    bool bounded = true;
    motion_open_text(&m, text,
                     (stepping){.kind = &engine_double, .method = method, .step_s = step_s});
    const bool first = m.image->form == WH_FIRST_ORDER;
    double size = 1.0;
    for (int k = 0; k < STEPS && bounded; k++) {
        bounded = motion_step(&m, 1) == WH_OK;
        size = text == system_swing ? hypot(motion_value(&m, "x"), motion_value(&m, "v"))
                                    : fabs(motion_value(&m, "x"));
        bounded = bounded && size < BEYOND;
    }
    motion_close(&m);
    return bounded && (!first || size < 1.0 + 1e-9);
}

static double measured(const char *text, wh_method method) {
    double low = 0.5;
    double high = 5.0;
    TEST_ASSERT_TRUE_MESSAGE(stays(text, method, low), wh_methods[method].word);
    TEST_ASSERT_FALSE_MESSAGE(stays(text, method, high), wh_methods[method].word);
    while (high - low > 1e-3) {
        const double middle = 0.5 * (low + high);
        if (stays(text, method, middle)) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

/* Known limits (Hairer & Wanner, Solving Ordinary Differential Equations II, section IV.2). Those of Nyström methods
 * come from bisection on the polynomials of their rows (docs/stability.md). 0: never stable; negative: not possible. */
static const struct {
    wh_method method;
    double swings;
    double decays;
    double system_swings;
} known[] = {{WH_EULER, 0.0, 2.0, 0.0},
             {WH_SEMI_IMPLICIT_EULER, 2.0, -1.0, -1.0},
             {WH_HEUN, 0.0, 2.0, 0.0},
             {WH_RK4, 2.8284271, 2.7852936, 2.8284271},
             {WH_RK4_PLAIN, 2.8284271, 2.7852936, 2.8284271},
             {WH_RK38, 2.8284271, 2.7852936, 2.8284271},
             {WH_NYSTROEM3, 2.1409, 2.5127, 1.7321},
             {WH_NYSTROEM4, 2.5865, 2.7853, 2.8284},
             {WH_LEAPFROG, 2.0, -1.0, -1.0},
             {WH_NYSTROEM5, 2.3905, 3.3865, 0.8523}};

static void hold(const char *text, wh_method method, double limit, const char *what) {
    if (limit == 0.0) { /* even a quarter of the step must be unstable */
        TEST_ASSERT_FALSE_MESSAGE(stays(text, method, 0.5), wh_methods[method].word);
        printf("  %-20s %s: none\n", wh_methods[method].word, what);
    } else if (limit > 0.0) {
        const double h = measured(text, method);
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(0.003 * limit, limit, h, wh_methods[method].word);
        printf("  %-20s %s: %.4f, known %.4f\n", wh_methods[method].word, what, h, limit);
    }
}

TEST(limits, measured_limits_are_the_known_ones) {
    unsigned seen = 0;
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        hold(spring, known[i].method, known[i].swings, "swings");
        hold(decay, known[i].method, known[i].decays, "decays");
        hold(system_swing, known[i].method, known[i].system_swings, "systems swing");
        TEST_ASSERT_EQUAL_INT(known[i].decays > 0.0,
                              wh_methods[known[i].method].takes == WH_ANY_SYSTEM);
        seen |= 1U << known[i].method;
    }
    TEST_ASSERT_EQUAL_UINT((1U << WH_METHODS) - 1U, seen);
}

/* docs/dev/numerics.md must have a row with these limits for each method. */
TEST(limits, the_page_has_the_known_limits) {
    FILE *in = fopen("docs/dev/numerics.md", "r");
    TEST_ASSERT_NOT_NULL(in);
    char *page = calloc(1, 1 << 20);
    TEST_ASSERT_NOT_NULL(page);
    TEST_ASSERT_TRUE(fread(page, 1, (1 << 20) - 1, in) > 0);
    fclose(in);
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        const wh_method_row *row = &wh_methods[known[i].method];
        char decays[16] = "";
        char line[240];
        if (known[i].decays > 0.0) {
            snprintf(decays, sizeof decays, "%.2f", known[i].decays);
        }
        snprintf(line, sizeof line, "| `%s` | %s | %d | %d | %s | %s | %.2f |\n", row->word,
                 row->title, row->order, row->stages,
                 row->takes == WH_ANY_SYSTEM ? "any"
                 : row->takes == WH_NO_RATES ? "no rates"
                                             : "second order",
                 decays, known[i].swings);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(page, line), line);
    }
    free(page);
}

/* Nice steps are 1, 2 and 5 times powers of ten, here from 5000 down over 16 decades. The result must be the largest
 * nice step up to the given one. */
TEST(limits, nice_steps) {
    dice die = dice_of("nice steps", 68);
    for (unsigned c = 0; c < dice_cases(2000); c++) {
        const double most_s = exp(dice_between(&die, log(1e-12), log(1e4)));
        const double nice_s = step_nice_s(most_s);
        const double leading = nice_s / pow(10.0, floor(log10(nice_s) + 1e-9));
        const bool one = fabs(leading - 1.0) < 1e-9;
        const bool two = fabs(leading - 2.0) < 1e-9;
        TEST_ASSERT_TRUE(one || two || fabs(leading - 5.0) < 1e-9);
        const double next_s = nice_s * (two ? 2.5 : 2.0);
        TEST_ASSERT_TRUE(nice_s <= most_s * (1.0 + 2e-9));
        TEST_ASSERT_TRUE(next_s > most_s || next_s > 5001.0);
        /* a nice step less round-off must give the nice step; less 1e-7 of it, the next shorter nice step */
        TEST_ASSERT_TRUE(fabs(step_nice_s(nice_s * (1.0 - 1e-13)) / nice_s - 1.0) < 1e-12);
        TEST_ASSERT_TRUE(step_nice_s(nice_s * (1.0 - 1e-7)) < 0.6 * nice_s);
    }
    TEST_ASSERT_TRUE(fabs(step_nice_s(1.001e-12) - 1e-12) < 1e-24);
    TEST_ASSERT_TRUE(step_nice_s(0.999e-12) == 0.0);
    TEST_ASSERT_TRUE(step_nice_s(0.0) == 0.0);
}

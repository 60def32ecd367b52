/* test_trust.c: until when a run can be trusted, as `whirl trust` estimates it, against references in long double that share
 * no step with it: four chaotic systems in float, float with compensated sums and double. */
#include "horizons.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "command.h"
#include "unity.h"

void suite_trust(void);

typedef struct arithmetic {
    const char *name;
    const char *step;
    horizons_setting how;
} arithmetic;

static const arithmetic arithmetics[] = {
    {"float, 1 ms", "1 [ms]", {&engine_float, false, WH_RK4, TABLES_NONE, MATRIX_NONE}},
    {"float compensated, 1 ms", "1 [ms]", {&engine_float, true, WH_RK4, TABLES_NONE, MATRIX_NONE}},
    {"double, 1 ms", "1 [ms]", {&engine_double, false, WH_RK4, TABLES_NONE, MATRIX_NONE}},
    {"double, 0.1 ms", "0.1 [ms]", {&engine_double, false, WH_RK4, TABLES_NONE, MATRIX_NONE}},
};
enum { ARITHMETICS = sizeof arithmetics / sizeof arithmetics[0] };

/* What the references may differ by where the run passes the tolerance, in parts of that. */
#define KNOWN 0.05

static void say(const char *what, const horizons *h) {
    const step_doubling *t = h->twins;
    double least = (double)INFINITY;
    double most = 0.0;
    for (int k = 1; k < t->columns; k++) {
        least = fmin(least, horizons_column_ratio(h, k));
        most = fmax(most, horizons_column_ratio(h, k));
    }
    printf("  %-44s %.6g s, true %.6g s: %.3f; columns %.3f ... %.3f; known to %.1e\n", what,
           h->estimate.until_s, h->true_until_s, horizons_ratio(h), least, most, h->known);
}

static void expect_near(const char *what, const horizons *h, double least, double most) {
    say(what, h);
    TEST_ASSERT_TRUE_MESSAGE(h->known < KNOWN, what);
    TEST_ASSERT_FALSE_MESSAGE(h->estimate.to_the_end, what);
    TEST_ASSERT_TRUE_MESSAGE(isfinite(h->true_until_s) && h->true_until_s < h->twins->end_s, what);
    TEST_ASSERT_TRUE_MESSAGE(horizons_ratio(h) >= least && horizons_ratio(h) <= most, what);
    for (int k = 1; k < h->twins->columns; k++) {
        const double ratio = horizons_column_ratio(h, k);
        TEST_ASSERT_TRUE_MESSAGE(ratio >= least && ratio <= most, what);
    }
}

/* `file` with a scene that begins so and ends then, in each arithmetic. */
static void chaotic(const char *name, bool builtin, const char *file, const char *starts,
                    const double *until_s) {
    const int count = (int)few_or_all(3, ARITHMETICS);
    for (int i = 0; i < count; i++) {
        const arithmetic *a = &arithmetics[i];
        char more[600];
        char what[100];
        snprintf(more, sizeof more,
                 "\nscene trusted {\n  use %s\n  start %s\n  step %s\n  until %g [s]\n}\n", name,
                 starts, a->step, until_s[i]);
        char *text = builtin ? horizons_builtin(file, more) : horizons_file(file, more);
        snprintf(what, sizeof what, "%s, %s", name, a->name);
        horizons h = horizons_of(text, "trusted", a->how, HORIZON_TOLERANCE);
        expect_near(what, &h, 0.9, 1.1);
        horizons_free(&h);
        free(text);
    }
}

static void test_thomson_a(void) {
    chaotic("thomson", true, "thomson.whirl",
            "theta1 = 0, theta2 = 0, X = 0, theta1' = 0, theta2' = 0, X' = 0",
            (const double[]){12.0, 12.0, 12.0, 14.0});
}

static void test_double_pendulum(void) {
    chaotic("double_pendulum", false, "tests/mechanisms/double_pendulum.whirl",
            "a = 2.5 [rad], b = 2 [rad]", (const double[]){60.0, 60.0, 60.0, 60.0});
}

static void test_triple_pendulum(void) {
    chaotic("triple_pendulum", false, "tests/mechanisms/triple_pendulum.whirl",
            "q1 = 2.2 [rad], q2 = 2.8 [rad], q3 = 1.7 [rad]\n  set c = 0.0002 [N*m*s]",
            (const double[]){20.0, 20.0, 20.0, 20.0});
}

/* A system of first order. */
static void test_lorenz(void) {
    chaotic("lorenz", false, "tests/mechanisms/lorenz.whirl", "x = 1, y = 0.5, z = 2",
            (const double[]){40.0, 40.0, 45.0, 60.0});
}

void suite_trust(void) {
    RUN_TEST(test_lorenz);
    RUN_TEST(test_thomson_a);
    RUN_TEST(test_double_pendulum);
    RUN_TEST(test_triple_pendulum);
}

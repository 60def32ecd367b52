/* test_turned_errors.c: what turning sines on does to the errors of the built-in scenes: a table for docs/numerics.md,
 * beside looking them up at each stage.
 *
 * The distance of the whole state, rates included, SI units, from runs with a sixteenth of the step that look up. In
 * double, sums compensated, so that the errors are the method's. */
#include <math.h>
#include <stdio.h>

#include "command.h"
#include "motion.h"

#include "unity.h"

void suite_turned_errors(void);

enum { VALUES = 3 * IMAGE_COMPONENTS_MAX, FINER = 16 };

#define UNTIL_S 2.0

/* The state at UNTIL_S. */
static int end_of(const char *name, image_angles angles, double step_s, double value[VALUES]) {
    const stepping how = {.kind = &engine_double,
                          .method = WH_RK4,
                          .compensated = true,
                          .step_s = step_s,
                          .angles = angles};
    motion m;
    motion_open(&m, name, how);
    motion_to(&m, UNTIL_S);
    m.kind->state(m.run, value, value + m.image->angles);
    const int count = m.image->angles + m.image->reals;
    motion_close(&m);
    return count;
}

static double error_of(const char *name, image_angles angles, double step_s,
                       const double exact[VALUES]) {
    double value[VALUES];
    const int count = end_of(name, angles, step_s, value);
    double sum = 0.0;
    for (int i = 0; i < count; i++) {
        sum = hypot(sum, value[i] - exact[i]);
    }
    return sum;
}

static void test_turning_errs_as_looking_up_does(void) {
    static const char *const scenes[][2] = {
        {"S5", "two_mass_relative"},   {"S6", "epicyclic_from_rest"},
        {"S6", "epicyclic_conserved"}, {"S7", "driven_hinge_from_rest"},
        {"S8", "thomson_a"},           {"S8", "thomson_b"},
        {"S8", "thomson_a_conserved"}, {"S8", "thomson_b_conserved"},
        {"S8, S9", "thomson_a_spin"},  {"S8, S9", "thomson_b_spin"},
        {"S9", "thomson_plane_a"},     {"S9", "thomson_plane_b"},
        {"S9", "thomson_pair_a"},      {"S9", "thomson_pair_b"},
        {"S11", "laskowitz_shifted"},  {"S11", "laskowitz_uneven"},
        {"S16", "carriage_free"},      {"S16", "carriage_ratio"}};
    printf("| row | scene | error at 1 ms, turned | lookup | ratio | order, turned | lookup |\n"
           "|---|---|---|---|---|---|---|\n");
    for (size_t i = 0; i < sizeof scenes / sizeof scenes[0]; i += usual_or(1, 3)) {
        const char *name = scenes[i][1];
        double exact[VALUES];
        double error[2];
        double order[2];
        (void)end_of(name, ANGLES_LOOKUP, 1e-3 / FINER, exact);
        for (int a = 0; a < 2; a++) {
            const image_angles angles = a == 0 ? ANGLES_TURNED : ANGLES_LOOKUP;
            error[a] = error_of(name, angles, 1e-3, exact);
            /* where steps resolve the motion, and before rounding shows */
            const double fine_s = error[a] < 1e-8 ? 2e-3 : 0.5e-3;
            order[a] = log2(error_of(name, angles, 2.0 * fine_s, exact) /
                            error_of(name, angles, fine_s, exact));
        }
        printf("| %s | `%s` | %.3g | %.3g | %.3f | %.2f | %.2f |\n", scenes[i][0], name, error[0],
               error[1], error[0] / error[1], order[0], order[1]);
        TEST_ASSERT_TRUE_MESSAGE(fabs(error[0] / error[1] - 1.0) < 0.01, name);
        TEST_ASSERT_TRUE_MESSAGE(fabs(order[0] - order[1]) < 0.05, name);
        TEST_ASSERT_TRUE_MESSAGE(order[0] > 3.5, name);
    }
}

void suite_turned_errors(void) { RUN_TEST(test_turning_errs_as_looking_up_does); }

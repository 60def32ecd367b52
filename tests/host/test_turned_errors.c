/* test_turned_errors.c: errors of built-in scenes with rotated sines, a table for docs/dev/numerics.md, compared with
 * lookup at each stage.
 *
 * Distance of the whole state, rates included, SI units, from lookup runs with a sixteenth of the step. In double
 * with compensated sums, so that the errors are the method's. */
#include "command.h"
#include "motion.h"

enum { VALUES = 3 * IMAGE_COMPONENTS_MAX, FINER = 16 };

#define UNTIL_S 2.0

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

TEST(turned_errors, turning_errs_as_looking_up_does) {
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
    const bool first_only = few_or_all(usual_or(1, 0), 0) != 0; /* of each row */
    for (size_t i = 0; i < sizeof scenes / sizeof scenes[0]; i += usual_or(1, 3)) {
        const char *name = scenes[i][1];
        if (first_only && i > 0 && strcmp(scenes[i][0], scenes[i - 1][0]) == 0) {
            continue;
        }
        double exact[VALUES];
        double error[2];
        double order[2];
        (void)end_of(name, ANGLES_LOOKUP, 1e-3 / FINER, exact);
        for (int a = 0; a < 2; a++) {
            const image_angles angles = a == 0 ? ANGLES_TURNED : ANGLES_LOOKUP;
            error[a] = error_of(name, angles, 1e-3, exact);
            /* steps resolve the motion, and round-off does not show */
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

#define SWING_S 30.0 /* about five periods */
enum { SWING_POINTS = 20 };

/* A pendulum with w = 1 rad/s from 2 rad: angle and rate at some times. */
static void swing(wh_method method, image_angles angles, double step_s,
                  double value[2 * SWING_POINTS]) {
    static const char text[] =
        "mechanism p\ncoordinate th [rad]\nT = 1 [kg*m^2]*th'^2/2\n"
        "V = -1 [J]*cos(th)\nscene swing { start th = 2 [rad]; until 30 [s] }\n";
    motion m;
    motion_open_text(&m, text,
                     (stepping){.kind = &engine_double,
                                .method = method,
                                .compensated = true,
                                .step_s = step_s,
                                .angles = angles});
    for (int i = 0; i < SWING_POINTS; i++) {
        motion_to(&m, (i + 1) * SWING_S / SWING_POINTS);
        m.kind->state(m.run, &value[2 * i], &value[2 * i + 1]);
    }
    motion_close(&m);
}

static double apart(const double *a, const double *b) {
    double most = 0.0;
    for (int i = 0; i < 2 * SWING_POINTS; i++) {
        most = fmax(most, fabs(a[i] - b[i]));
    }
    return most;
}

/* Rotation has an error of h^6, not small next to a method of order 5. */
TEST(turned_errors, turning_beside_the_error_of_each_method) {
    static const wh_method methods[] = {WH_NYSTROEM3, WH_RK4, WH_RK38, WH_NYSTROEM4, WH_NYSTROEM5};
    static const double step_s[] = {0.05, 0.1, 0.3, 0.5};
    double exact[2 * SWING_POINTS];
    swing(WH_NYSTROEM5, ANGLES_LOOKUP, 0.0025, exact);
    printf("| method | w h | error, lookup | error, turned | apart, %% of lookup's error |\n"
           "|---|---|---|---|---|\n");
    for (size_t k = 0; k < sizeof methods / sizeof methods[0]; k++) {
        for (size_t n = 0; n < sizeof step_s / sizeof step_s[0]; n++) {
            double turned[2 * SWING_POINTS];
            double lookup[2 * SWING_POINTS];
            swing(methods[k], ANGLES_TURNED, step_s[n], turned);
            swing(methods[k], ANGLES_LOOKUP, step_s[n], lookup);
            const double error = apart(lookup, exact);
            const double share = apart(turned, lookup) / error;
            printf("| `%s` | %g | %.3g | %.3g | %.2g |\n", wh_methods[methods[k]].word, step_s[n],
                   error, apart(turned, exact), 100.0 * share);
            const double wh = step_s[n];
            const bool fifth = wh_methods[methods[k]].order == 5;
            /* of order 4, by h^2 of its error; of order 5, by h */
            TEST_ASSERT_TRUE_MESSAGE(
                share < (fifth ? 2.5 * wh + 10.0 * wh * wh : 0.5 * wh * wh + 0.001),
                wh_methods[methods[k]].word);
        }
    }
}

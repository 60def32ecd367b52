/* test_turned_errors.c: the error of rotated sines for each method, compared with lookup at each stage; a table for
 * docs/dev/numerics.md. A pendulum in double with compensated sums shows the methods' errors only. */
#include "command.h"
#include "motion.h"

#define SWING_S 30.0 /* about five periods */
enum { SWING_POINTS = 20 };

/* Computes angle and rate at some times of a pendulum with w = 1 rad/s that starts at 2 rad. */
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

/* Rotation has an error of order h^6, which is not small beside a method of order 5. */
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
            /* relative to the method's error: falls as h^2 for order 4, as h for order 5 */
            TEST_ASSERT_TRUE_MESSAGE(
                share < (fifth ? 2.5 * wh + 10.0 * wh * wh : 0.5 * wh * wh + 0.001),
                wh_methods[methods[k]].word);
        }
    }
}

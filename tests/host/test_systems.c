/* test_systems.c: systems given by equations outright, of mixed and high order (dissertation, appendix
 * A: n-th order to first order), run against solutions in closed form. Their highest derivatives are
 * checked in test_reference.c; what cannot be solved is refused in test_bad_input.c. */
#include "ranges.h"

#include <math.h>
#include <stdio.h>

#include "derived.h"

#include "unity.h"

void suite_systems(void);

#define PI 3.14159265358979323846
enum { TEXT_SIZE = 8192 };

/* A file's first scene. */
static void open_file(motion *m, const char *path, stepping how) {
    char text[TEXT_SIZE];
    FILE *in = fopen(path, "r");
    TEST_ASSERT_NOT_NULL_MESSAGE(in, path);
    const size_t length = fread(text, 1, sizeof text - 1, in);
    fclose(in);
    TEST_ASSERT_TRUE(length < sizeof text - 1);
    text[length] = '\0';
    motion_open_text(m, text, how);
}

/* --- fourth order: beam on an elastic bed ---------------------------------------------------------------- */

/* Largest error of w and its first three derivatives, in units of w's start, 1 mm. */
static double beam_error(double step_s) {
    motion m;
    double worst = 0.0;
    open_file(&m, "tests/mechanisms/beam.whirl", IN_DOUBLE_STEP(step_s));
    for (unsigned i = 0; i <= 25; i++) {
        const double u = 0.08 * i;
        motion_to(&m, u);
        /* closed form: w = 1 mm exp(-u) cos(u), u = c t (k/4 EI)^(1/4) = t/s */
        const double w[4] = {exp(-u) * cos(u), -exp(-u) * (cos(u) + sin(u)), 2.0 * exp(-u) * sin(u),
                             2.0 * exp(-u) * (cos(u) - sin(u))};
        static const char *const names[4] = {"w", "w'", "w''", "w'''"};
        for (unsigned k = 0; k < 4; k++) {
            worst = fmax(worst, fabs(1e3 * motion_value(&m, names[k]) - w[k]));
        }
    }
    motion_close(&m);
    return worst;
}

static void test_fourth_order_beam_follows_its_closed_form(void) {
    const double coarse = beam_error(0.04);
    const double fine = beam_error(0.01);
    expect_between("beam: error at 40 ms", 1e-8, 1e-5, coarse);
    expect_between("beam: order of the error", 3.8, 4.5, log2(coarse / fine) / 2.0);
    expect_between("beam: error at 1 ms", 0.0, 1e-11, beam_error(1e-3));
}

/* --- ten coupled equations: a rod's third mode ----------------------------------------------------------- */

static void test_ten_coupled_equations_swing_in_one_mode(void) {
    motion m;
    double worst = 0.0;
    /* closed form: consistent mass, w^2 = (6 k/m)(1 - cos a)/(2 + cos a), a = 3 pi/11 */
    const double a = 3.0 * PI / 11.0;
    const double w = sqrt(6.0 * 400.0 / 3.0 * (1.0 - cos(a)) / (2.0 + cos(a)));
    open_file(&m, "tests/mechanisms/coupled_ten.whirl", IN_DOUBLE);
    for (unsigned i = 0; i <= 20; i++) {
        const double t = 0.1 * i;
        motion_to(&m, t);
        for (unsigned k = 0; k < 10; k++) {
            char name[8];
            snprintf(name, sizeof name, "x%u", k);
            const double wanted = 0.01 * sin(a * (k + 1)) * cos(w * t);
            worst = fmax(worst, fabs(motion_value(&m, name) - wanted));
        }
    }
    motion_close(&m);
    /* RK4's phase error: amplitude x w t x (w h)^4/120 = 0.01 x 20.5 x 9e-11 = 1.8e-11 */
    expect_between("ten coupled: error within 2 s, m", 1e-12, 1e-10, worst);
}

/* --- mixed orders: motor and pendulum --------------------------------------------------------------------- */

static void test_motor_with_inductance_holds_the_pendulum(void) {
    motion m;
    open_file(&m, "tests/mechanisms/dc_motor_pendulum.whirl", IN_DOUBLE);
    motion_to(&m, 150.0); /* the pendulum comes to rest at 0.13 per second */
    /* closed form at rest: current u/R = 8 A; torque K i = m g l sin(theta) = k (phi - theta) */
    const double torque = 0.08 * 8.0;
    const double theta = asin(torque / (0.25 * 9.80665 * 0.4));
    expect_between("motor and pendulum: current at rest, A", 8.0 - 1e-6, 8.0 + 1e-6,
                   motion_value(&m, "current"));
    expect_between("motor and pendulum: pendulum at rest, rad", theta - 1e-6, theta + 1e-6,
                   motion_value(&m, "theta"));
    expect_between("motor and pendulum: twist of the shaft, rad", torque / 12.0 - 1e-6,
                   torque / 12.0 + 1e-6, motion_value(&m, "phi") - motion_value(&m, "theta"));
    motion_close(&m);
}

/* --- first order from any order --------------------------------------------------------------------------- */

static void check_shape(const char *path, int unknowns, int components) {
    derived d = derived_file(path);
    printf("  %s\n", path);
    TEST_ASSERT_EQUAL_STRING("", d.errors);
    TEST_ASSERT_NOT_NULL(d.image);
    TEST_ASSERT_EQUAL_INT(unknowns, d.equations->count);
    TEST_ASSERT_EQUAL_INT(components, d.image->angles + d.image->reals);
    derived_free(&d);
}

static void test_as_many_first_order_equations_as_orders(void) {
    check_shape("tests/mechanisms/jerk.whirl", 1, 3);
    check_shape("tests/mechanisms/beam.whirl", 1, 4);
    check_shape("tests/mechanisms/dc_motor_pendulum.whirl", 3, 5);
    check_shape("tests/mechanisms/mixed_order.whirl", 3, 6);
    check_shape("tests/mechanisms/coupled_ten.whirl", 10, 20);
}

void suite_systems(void) {
    RUN_TEST(test_fourth_order_beam_follows_its_closed_form);
    RUN_TEST(test_ten_coupled_equations_swing_in_one_mode);
    RUN_TEST(test_motor_with_inductance_holds_the_pendulum);
    RUN_TEST(test_as_many_first_order_equations_as_orders);
}

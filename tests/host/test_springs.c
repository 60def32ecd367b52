/* test_springs.c: the scene springs_ring, whose forces use every function of the core. The reference integrates the
 * equations, which are written by hand, by Runge-Kutta 4 in long double with libm. */
#include "motion.h"

#define PI_L 3.141592653589793238462643383279502884L

typedef struct plane {
    long double x, y, vx, vy;
} plane;

static plane slope_of(plane at) {
    const long double m = 2.0L;
    const long double strap = -300.0L * logl(at.x) / at.x;
    const long double u = at.x - 1.0L;
    const long double air = 1e5L * 4e-4L * (powl(0.6L / (0.6L + u), 1.4L) - 1.0L);
    const long double foam = -2.0L * 120.0L * 0.3L / PI_L * tanl(PI_L * at.y / 0.6L);
    const long double bond = expl(-at.y / 0.2L);
    const long double glue = -2.0L * 2.0L * (1.0L - bond) * bond / 0.2L;
    const long double arm = -8.0L * asinl(at.y / 0.6L) / sqrtl(0.36L - at.y * at.y);
    const long double fold = acosl(at.x / 1.6L) - acosl(1.0L / 1.6L);
    const long double knee = 6.0L * fold / sqrtl(2.56L - at.x * at.x);
    const long double high = at.y + 0.7L;
    const long double guide =
        -12.0L * (atan2l(high, at.x) - atan2l(0.7L, 1.0L)) / (at.x * at.x + high * high);
    const long double rail = -2.0L / PI_L * 1.5L * atanl(at.vx / 0.1L);
    return (plane){at.vx, at.vy, (strap + air + knee - guide * high + rail) / m,
                   (foam + glue + arm + guide * at.x) / m - 9.81L};
}

static plane moved(plane from, plane slope, long double h) {
    return (plane){from.x + h * slope.x, from.y + h * slope.y, from.vx + h * slope.vx,
                   from.vy + h * slope.vy};
}

static plane stepped(plane at, long double h) {
    const plane k1 = slope_of(at);
    const plane k2 = slope_of(moved(at, k1, h / 2.0L));
    const plane k3 = slope_of(moved(at, k2, h / 2.0L));
    const plane k4 = slope_of(moved(at, k3, h));
    at = moved(at, k1, h / 6.0L);
    at = moved(at, k2, h / 3.0L);
    at = moved(at, k3, h / 3.0L);
    return moved(at, k4, h / 6.0L);
}

/* Largest distance from the reference within 5 s. The reference has an eighth of the step. */
static double distance(stepping how) {
    motion m;
    motion_open(&m, "springs_ring", how);
    plane at = {1.15L, 0.12L, 0.0L, 0.0L};
    double worst = 0.0;
    for (int i = 0; i < 5000; i++) {
        TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
        for (int part = 0; part < 8; part++) {
            at = stepped(at, 1.25e-4L);
        }
        worst = fmax(worst, fabs(motion_value(&m, "x") - (double)at.x));
        worst = fmax(worst, fabs(motion_value(&m, "y") - (double)at.y));
    }
    const double strain = motion_value(&m, "strain");
    const double pressure = motion_value(&m, "pressure");
    motion_close(&m);
    printf("  springs_ring in %s: within %.2e m in 5 s\n",
           how.kind == &engine_float ? "float" : "double", worst);
    TEST_ASSERT_DOUBLE_WITHIN(2.0 * worst, (double)logl(at.x), strain);
    TEST_ASSERT_DOUBLE_WITHIN(1e6 * worst, 1e5 * (double)powl(0.6L / (at.x - 0.4L), 1.4L),
                              pressure);
    return worst;
}

TEST(springs, every_law_pushes_as_it_should) {
    const double in_double = distance(IN_DOUBLE);
    const double in_float = distance(IN_FLOAT);
    TEST_ASSERT_TRUE(in_double < 1.5e-8);
    TEST_ASSERT_TRUE(in_float < 5e-6 && in_float > 1e-7);
}

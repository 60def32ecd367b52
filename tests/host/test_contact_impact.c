/* test_contact_impact.c: impacts through a coupled mass matrix: a cart with a pendulum, either of them against a wall
 * (core/models/contacts.whirl, `crash`).
 *
 * Closed form: M = (M + m, m l cos; m l cos, m l^2). A stop with gradient J leaves v+ = v + M^-1 J^T (1 + e) |J v|/(J
 * M^-1 J^T). Without gravity and with the pendulum at rest, the motion before the impact is uniform. The cart meets the
 * wall just before the end of a step, so the step's state shows the impact alone. */
#include "contacts.h"
#include "test.h"

#define CART_KG 2.0
#define BOB_KG 1.0
#define ROD_M 0.5
#define RESTITUTION 0.6
#define TILT 0.7 /* the pendulum's angle, rad */
#define SPEED 2.0

typedef struct velocities {
    double X;
    double theta;
} velocities;

static velocities momenta(velocities v) {
    const double side = BOB_KG * ROD_M * cos(TILT);
    return (velocities){(CART_KG + BOB_KG) * v.X + side * v.theta,
                        side * v.X + BOB_KG * ROD_M * ROD_M * v.theta};
}

/* v + M^-1 J^T amount, by Cramer's rule. */
static velocities pushed(velocities v, velocities J, double amount) {
    const double a = CART_KG + BOB_KG;
    const double b = BOB_KG * ROD_M * cos(TILT);
    const double c = BOB_KG * ROD_M * ROD_M;
    const double det = a * c - b * b;
    return (velocities){v.X + amount * (c * J.X - b * J.theta) / det,
                        v.theta + amount * (a * J.theta - b * J.X) / det};
}

static velocities impact(velocities v, velocities J) {
    const velocities way = pushed((velocities){0.0, 0.0}, J, 1.0);
    const double speed = J.X * v.X + J.theta * v.theta;
    return pushed(v, J, -(1.0 + RESTITUTION) * speed / (J.X * way.X + J.theta * way.theta));
}

static velocities run(const char *called, const char *distance, double offset, stepping how) {
    motion m;
    char more[400];
    /* the impact is in the 256th step of 2^-10 s, some 1e-15 s (in float 1e-6 s) before its end */
    const double early = how.kind == &engine_double ? 2e-15 : 2e-6;
    snprintf(more, sizeof more,
             "\nscene meets {\n  use crash\n  with %s\n  set %s = %.17g [m]\n"
             "  start X = 0, theta = %.17g, X' = %.17g [m/s], theta' = 0\n  step 1 [s]/1024\n}\n",
             called, distance, 0.5 - early + offset, TILT, SPEED);
    motion_open_more(&m, "contacts.whirl", more, how);
    motion_to(&m, 255.0 / 1024.0);
    TEST_ASSERT_EQUAL_UINT64(0, contacts_events(&m));
    motion_to(&m, 0.25);
    TEST_ASSERT_EQUAL_UINT64(1, contacts_events(&m));
    const velocities v = {motion_value(&m, "X'"), motion_value(&m, "theta'")};
    motion_close(&m);
    return v;
}

/* `bound`: on the velocities; `free`: relative, on the momentum that the wall does not change. */
static void check(const char *what, velocities J, velocities got, double bound, double free) {
    const velocities before = {SPEED, 0.0};
    const velocities want = impact(before, J);
    const velocities p = momenta(got);
    const velocities p_before = momenta(before);
    printf("  %s: X' = %.15g, theta' = %.15g\n", what, got.X, got.theta);
    expect_between("  cart's speed off the closed form, m/s", 0.0, bound, fabs(got.X - want.X));
    expect_between("  pendulum's off, rad/s", 0.0, bound, fabs(got.theta - want.theta));
    /* the impulse is a multiple of J: the momentum across it is constant */
    const double across = J.theta * (p.X - p_before.X) - J.X * (p.theta - p_before.theta);
    expect_between("  momentum along the free direction, change, relative", 0.0, free,
                   fabs(across) / fabs(p_before.theta));
    /* and the impact happened: the pendulum got its share */
    TEST_ASSERT_TRUE(fabs(got.theta) > 1.0);
}

TEST(contact_impact, cart_meets_the_wall) {
    const velocities J = {-1.0, 0.0};
    /* the project's bound; round-off, and the 10 N m that act for 2e-15 s after the impact */
    check("cart, double", J, run("wall", "d", 0.0, IN_DOUBLE), 1e-12, 2e-14);
    /* a float's last place is 2^-23: ten of them, times the system's condition number, 14; after the impact 20 rad/s^2
     * act for 2e-6 s */
    check("cart, float", J, run("wall", "d", 0.0, IN_FLOAT), 6e-5, 2e-5);
}

TEST(contact_impact, bob_meets_the_wall) {
    const velocities J = {-1.0, -ROD_M * cos(TILT)};
    const double offset = ROD_M * sin(TILT);
    check("bob, double", J, run("bob_wall", "d_b", offset, IN_DOUBLE), 1e-12, 2e-14);
    check("bob, float", J, run("bob_wall", "d_b", offset, IN_FLOAT), 6e-5, 2e-5);
}

/* The pendulum's own speed matters, too: both swing, with gravity. Reference from another program. */
TEST(contact_impact, impacts_of_a_swinging_pendulum_converge) {
    static const char *const names[] = {"crash_cart", "crash_both"};
    for (unsigned i = 0; i < 2; i++) {
        double before = 0.0;
        double least = HUGE_VAL;
        for (unsigned k = 0; k < 4; k++) {
            motion m;
            const double h = 0.008 / (double)(1U << k);
            motion_open(&m, names[i], IN_DOUBLE_STEP(h));
            motion_to(&m, 1.0);
            motion_to(&m, 3.0);
            const double error = contacts_error(&m, names[i], "3.0");
            motion_close(&m);
            printf("  %s, %g ms: error %.2e\n", names[i], 1e3 * h, error);
            if (k > 0) {
                least = fmin(least, log2(before / error));
            }
            before = error;
        }
        /* the project's bound; the method's order is 4, and cancelling errors look like more */
        expect_between("  least order", 3.0, 6.0, least);
        /* RK4 with w h = 0.0044: 3 s of 1.5e-9 a radian's (w h)^4/120 would be 5e-11. A wrong impact has an error in
         * the order of m/s */
        expect_between("  error at 1 ms", 1e-14, 1e-7, before);
    }
}

/* test_equations.c: the derived equations are the dissertation's, at random states. */
#include "derived.h"

enum { STATES = 50 };

/* Left side minus right side of equation i, and the size of its terms. */
static double residual(const equations *e, state_values *s, int i, double *size) {
    const double parts[] = {poly_evaluate(e->velocity[i], state_value, s),
                            poly_evaluate(e->potential[i], state_value, s),
                            -poly_evaluate(e->applied[i], state_value, s)};
    double sum = 0.0;
    *size = 0.0;
    for (int k = 0; k < 3; k++) {
        sum += parts[k];
        *size += fabs(parts[k]);
    }
    for (int j = 0; j < e->count; j++) {
        const double part =
            poly_evaluate(e->mass[i * e->count + j], state_value, s) * s->value[j][2];
        sum += part;
        *size += fabs(part);
    }
    return sum;
}

/* The printed equations, left minus right side; v[coordinate][primes]. */
typedef void printed(const double v[][ORDERS_MAX], const double *p, double *rest);

/* (3), (4), (5): r, theta, phi; m, g */
static void spherical(const double v[][ORDERS_MAX], const double *p, double *rest) {
    const double m = p[0], g = p[1];
    const double r = v[0][0], dr = v[0][1], ddr = v[0][2];
    const double s = sin(v[1][0]), c = cos(v[1][0]), w = v[1][1], dw = v[1][2];
    const double f = v[2][1], df = v[2][2];
    rest[0] = -m * r * w * w + m * ddr - m * r * s * s * f * f + m * g * c;
    rest[1] = 2 * m * r * w * dr + m * r * r * dw - m * r * r * s * f * f * c - m * g * r * s;
    rest[2] = 2 * m * r * s * s * f * dr + 2 * m * r * r * s * f * c * w + m * r * r * s * s * df;
}

/* (6), (7): X, Y; m1, m2, K1, K2, A, B */
static void two_masses(const double v[][ORDERS_MAX], const double *p, double *rest) {
    const double m1 = p[0], m2 = p[1], K1 = p[2], K2 = p[3], A = p[4], B = p[5];
    rest[0] = (m1 + m2) * v[0][2] + m2 * v[1][2] + K1 * v[0][0] + A * (v[1][1] + v[0][1]);
    rest[1] = v[0][2] * m2 + m2 * v[1][2] + K2 * v[1][0] + A * v[1][1] + A * v[0][1] + B * v[1][1];
}

/* Appendix B, the two accelerations of the absolute set; m1, m2, K1, K2, A, B, L1, L2 */
static void two_masses_absolute(const double v[][ORDERS_MAX], const double *p, double *rest) {
    const double m1 = p[0], m2 = p[1], K1 = p[2], K2 = p[3], A = p[4], B = p[5], L1 = p[6],
                 L2 = p[7];
    const double X = v[0][0], Y = v[1][0], vX = v[0][1], vY = v[1][1];
    rest[0] = m1 * v[0][2] + (-B * vY + B * vX + K1 * X - K1 * L1 - K2 * Y + K2 * X + K2 * L2);
    rest[1] = m2 * v[1][2] - (-B * vY - vY * A + B * vX - K2 * Y + K2 * X + K2 * L2);
}

/* (11), (10): theta, X; m, r, I and the input M */
static void epicyclic(const double v[][ORDERS_MAX], const double *p, double *rest) {
    const double m = p[0], r = p[1], I = p[2], M = 2.0;
    const double s = sin(v[0][0]), c = cos(v[0][0]), w = v[0][1], dw = v[0][2];
    rest[0] = -2 * m * v[1][2] * r * s + (4 * m * r * r + 4 * I) * dw - M;
    rest[1] = 2 * m * v[1][2] - 2 * m * r * dw * s - 2 * m * r * w * w * c;
}

/* EQ1, EQ2 of section III.3 */
static void driven_hinge(const double v[][ORDERS_MAX], const double *p, double *rest) {
    const double k = p[0] * p[1] * p[1], I = p[2], M = -2.0;
    const double s1 = sin(v[0][0]), c1 = cos(v[0][0]), s2 = sin(v[1][0]), c2 = cos(v[1][0]);
    const double w1 = v[0][1], w2 = v[1][1];
    rest[0] =
        -k * (-c2 * s1 + s2 * c1) * w2 * w2 - k * (-c2 * c1 - s2 * s1) * v[1][2] + k * v[0][2] - M;
    rest[1] = (I + k) * v[1][2] + (k * c2 * c1 + k * s2 * s1) * v[0][2] - k * c2 * s1 * w1 * w1 +
              k * s2 * c1 * w1 * w1;
}

/* EQ1, EQ2 of section III.4; EQ3 is the rate of the momentum along the slider (its print is damaged). */
static void thomson(const double v[][ORDERS_MAX], const double *p, double *rest) {
    const double m = p[0], r = p[1], I = p[2], M = -2.0, k = m * r * r;
    const double s1 = sin(v[0][0]), c1 = cos(v[0][0]), s2 = sin(v[1][0]), c2 = cos(v[1][0]);
    const double w1 = v[0][1], a1 = v[0][2], w2 = v[1][1], a2 = v[1][2], aX = v[2][2];
    rest[0] = (-4 * m * r * s1 * c1 - 4 * m * r * s1) * aX +
              (4 * k * s1 * c1 * s2 - 2 * k * c2 + 2 * k * s1 * s2 + 2 * k * c1 * c2 +
               4 * k * c1 * c1 * c2) *
                  a2 +
              (8 * k * c1 + 4 * I + 12 * k) * a1 - 4 * k * s1 * w1 * w1 +
              (2 * k * s2 + 2 * k * s1 * c2 - 2 * k * c1 * s2 - 4 * k * c1 * c1 * s2 +
               4 * k * c1 * c2 * s1) *
                  w2 * w2 -
              M;
    rest[1] = -m * r * s2 * aX + k * a2 +
              m * r *
                  (4 * r * c1 * c1 * c2 + 2 * r * c1 * c2 + 4 * r * s1 * c1 * s2 - 2 * r * c2 +
                   2 * r * s1 * s2) *
                  a1 +
              m * r * w1 * w1 *
                  (-2 * r * s1 * c2 + 8 * r * c1 * c1 * s2 - 4 * r * s2 + 2 * r * c1 * s2 -
                   8 * r * c1 * c2 * s1);
    rest[2] = 3 * m * aX - 4 * m * r * (a1 * s1 + w1 * w1 * c1) -
              2 * m * r * (a1 * sin(2 * v[0][0]) + 2 * w1 * w1 * cos(2 * v[0][0])) -
              m * r * (a2 * s2 + w2 * w2 * c2);
}

static void check_printed(const char *name, printed *as_printed) {
    derived d = derived_builtin(name);
    derived_expect(&d, name);
    uint64_t seed = 1088;
    for (int k = 0; k < STATES; k++) {
        state_values s;
        random_state(&s, &d, &seed);
        double rest[UNKNOWNS] = {0.0};
        as_printed((const double(*)[ORDERS_MAX])s.value, d.instance->parameter, rest);
        for (int i = 0; i < d.equations->count; i++) {
            double size;
            const double ours = residual(d.equations, &s, i, &size);
            TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-13 * size, rest[i], ours, name);
        }
    }
    derived_free(&d);
}

TEST(equations, the_dissertations_equations) {
    check_printed("spherical_particle", spherical);
    check_printed("masses_relative", two_masses);
    check_printed("masses_absolute", two_masses_absolute);
    check_printed("epicyclic", epicyclic);
    check_printed("driven_hinge", driven_hinge);
    check_printed("thomson", thomson);
}

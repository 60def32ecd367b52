/* naive_thomson.h: Thomson's device as in a textbook: the mass matrix of its three coordinates, Gauss elimination, the classic
 * Runge-Kutta method on six states. Define NAME, `sines` and sines_of() before the inclusion. */
#ifndef TESTS_NAIVE_THOMSON_H
#define TESTS_NAIVE_THOMSON_H

#include "naive.h"

#define TORQUE (-2.0) /* torque, N m */
#define MASS 2.0      /* each disc, kg */
#define RADIUS 0.3    /* m */

enum { STATES = 6 }; /* theta1, theta2, X, theta1', theta2', X' */

const naive_mechanism naive = {NAME,
                               STATES,
                               5.0,
                               {-10.6144740124010441, -17.0959717050394372, 0.839285809779478438,
                                -5.06295906952996249, 1.20577040594969357, -1.06211080436277226},
                               5e-6};

static void slope(const double y[STATES], double dy[STATES]) {
    const double mr = MASS * RADIUS;
    const double mrr = MASS * RADIUS * RADIUS;
    const double inertia = MASS * RADIUS * RADIUS / 2.0;
    sines s;
    sines_of(y[0], y[1], &s);
    const double a_squared = y[3] * y[3];
    const double b_squared = y[4] * y[4];

    const double m11 = 12.0 * mrr + 4.0 * inertia + 8.0 * mrr * s.cos_a;
    const double m12 = 2.0 * mrr * (s.cos_a_b + s.cos_2a_b);
    const double m13 = -2.0 * mr * (2.0 * s.sin_a + s.sin_2a);
    const double m22 = mrr;
    const double m23 = -mr * s.sin_b;
    const double m33 = 3.0 * MASS;
    const double f1 =
        TORQUE + 4.0 * mrr * s.sin_a * a_squared - 2.0 * mrr * (s.sin_a_b + s.sin_2a_b) * b_squared;
    const double f2 = 2.0 * mrr * (s.sin_a_b + 2.0 * s.sin_2a_b) * a_squared;
    const double f3 = 4.0 * mr * (s.cos_a + s.cos_2a) * a_squared + mr * s.cos_b * b_squared;

    /* Gauss: eliminates the first column, then the second. */
    const double l2 = m12 / m11;
    const double l3 = m13 / m11;
    const double n22 = m22 - l2 * m12;
    const double n23 = m23 - l2 * m13;
    const double n33 = m33 - l3 * m13;
    const double g2 = f2 - l2 * f1;
    const double g3 = f3 - l3 * f1;
    const double l = n23 / n22;
    dy[0] = y[3];
    dy[1] = y[4];
    dy[2] = y[5];
    dy[5] = (g3 - l * g2) / (n33 - l * n23);
    dy[4] = (g2 - n23 * dy[5]) / n22;
    dy[3] = (f1 - m12 * dy[4] - m13 * dy[5]) / m11;
}

#include "naive_rk4.h"

#endif

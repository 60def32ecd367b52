/* naive_epicyclic.c: the epicyclic gear as in a textbook: the mass matrix of equations (10) and (11), Cramer's rule, libm's
 * sine and cosine, the classic Runge-Kutta method on four states. */
#include <math.h>

#include "naive.h"

#define TORQUE 2.0 /* torque, N m */
#define MASS 2.0   /* each gear, kg */
#define RADIUS 0.3 /* m */

enum { STATES = 4 }; /* theta, X, theta', X' */

const naive_mechanism naive = {
    "naive_epicyclic",
    STATES,
    9.0,
    {89.6342558331565748, 0.329611268310012897, 22.2610447620456337, 6.64570198844706309},
    5e-8};

static void slope(const double y[STATES], double dy[STATES]) {
    const double inertia = MASS * RADIUS * RADIUS / 2.0;
    const double s = sin(y[0]);
    const double c = cos(y[0]);
    const double m11 = 4.0 * MASS * RADIUS * RADIUS + 4.0 * inertia;
    const double m12 = -2.0 * MASS * RADIUS * s;
    const double m22 = 2.0 * MASS;
    const double f1 = TORQUE;
    const double f2 = 2.0 * MASS * RADIUS * c * y[2] * y[2];
    const double det = m11 * m22 - m12 * m12;
    dy[0] = y[2];
    dy[1] = y[3];
    dy[2] = (f1 * m22 - m12 * f2) / det;
    dy[3] = (m11 * f2 - m12 * f1) / det;
}

#include "naive_rk4.h"

/* naive_rk4.h: a step of the classic Runge-Kutta method. Define STATES and slope() before the inclusion. */
#ifndef TESTS_NAIVE_RK4_H
#define TESTS_NAIVE_RK4_H

__attribute__((noinline)) void naive_step(double y[], double h) {
    double k1[STATES];
    double k2[STATES];
    double k3[STATES];
    double k4[STATES];
    double at[STATES];
    slope(y, k1);
    for (int i = 0; i < STATES; i++) {
        at[i] = y[i] + h / 2.0 * k1[i];
    }
    slope(at, k2);
    for (int i = 0; i < STATES; i++) {
        at[i] = y[i] + h / 2.0 * k2[i];
    }
    slope(at, k3);
    for (int i = 0; i < STATES; i++) {
        at[i] = y[i] + h * k3[i];
    }
    slope(at, k4);
    for (int i = 0; i < STATES; i++) {
        y[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
    }
}

void naive_start(double y[]) {
    for (int i = 0; i < STATES; i++) {
        y[i] = 0.0;
    }
}

#endif

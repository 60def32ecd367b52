/* naive.h: a mechanism as a textbook programs it, to have something to compare the price with. */
#ifndef TESTS_NAIVE_H
#define TESTS_NAIVE_H

enum { NAIVE_STATES_MAX = 6 };

typedef struct naive_mechanism {
    const char *name;
    int states;   /* coordinates, then rates */
    double end_s; /* the reference state belongs to this time */
    double end[NAIVE_STATES_MAX];
    double most; /* largest error allowed there with steps of 1 ms */
} naive_mechanism;

extern const naive_mechanism naive;

/* One step of the classic Runge-Kutta method from rest at zero on, h_s seconds long. */
void naive_step(double state[], double h_s);

#endif

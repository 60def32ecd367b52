/* naive.h: a mechanism as in a textbook, as a reference for the step's price. */
#ifndef TESTS_NAIVE_H
#define TESTS_NAIVE_H

enum { NAIVE_STATES_MAX = 6 };

typedef struct naive_mechanism {
    const char *name;
    int states;   /* coordinates, then rates */
    double end_s; /* time of the reference state */
    double end[NAIVE_STATES_MAX];
    double most; /* largest allowed error at end_s, with steps of 1 ms */
} naive_mechanism;

extern const naive_mechanism naive;

/* Sets state[] to rest at zero. */
void naive_start(double state[]);
/* One step of h_s seconds by the classic Runge-Kutta method. */
void naive_step(double state[], double h_s);

#endif

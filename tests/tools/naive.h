/* naive.h: a mechanism as in a textbook, as a reference for the step's price. */
#ifndef TESTS_NAIVE_H
#define TESTS_NAIVE_H

#ifdef __cplusplus
extern "C" {
#endif

enum { NAIVE_STATES_MAX = 6 };

typedef struct naive_mechanism {
    const char *name;
    int states;   /* coordinates, then rates */
    double end_s; /* time of the reference state */
    double end[NAIVE_STATES_MAX];
    double most; /* largest error allowed there with steps of 1 ms */
} naive_mechanism;

extern const naive_mechanism naive;

/* Sets state[] to rest at zero and the next step to the first. A library may store the state itself. */
void naive_start(double state[]);
/* One step of the classic Runge-Kutta method, h_s seconds long. */
void naive_step(double state[], double h_s);
void naive_read(double state[]);

/* The file that makes naive_step() from a mechanism's slope(), to be included after it. */
#ifndef NAIVE_STEPPER
#define NAIVE_STEPPER "naive_rk4.h"
#endif

#ifdef __cplusplus
}
#endif

#endif

/* naive.h: a mechanism as a textbook programs it, to have something to compare the price with. */
#ifndef TESTS_NAIVE_H
#define TESTS_NAIVE_H

#ifdef __cplusplus
extern "C" {
#endif

enum { NAIVE_STATES_MAX = 6 };

typedef struct naive_mechanism {
    const char *name;
    int states;   /* coordinates, then rates */
    double end_s; /* the reference state belongs to this time */
    double end[NAIVE_STATES_MAX];
    double most; /* largest error allowed there with steps of 1 ms */
} naive_mechanism;

extern const naive_mechanism naive;

/* state[] is at rest at zero, and the next step is the first; a library may keep the state itself. */
void naive_start(double state[]);
/* One step of the classic Runge-Kutta method, h_s seconds long. */
void naive_step(double state[], double h_s);
/* state[] is where the last step has come to. */
void naive_read(double state[]);

/* What makes naive_step() of a mechanism's slope(): a file to be included behind it. */
#ifndef NAIVE_STEPPER
#define NAIVE_STEPPER "naive_rk4.h"
#endif

#ifdef __cplusplus
}
#endif

#endif

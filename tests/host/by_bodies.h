/* by_bodies.h: bodies on a line, each by itself, in long double: never is added what belongs to two of them. */
#ifndef TESTS_HOST_BY_BODIES_H
#define TESTS_HOST_BY_BODIES_H

enum { BODIES_MOST = 3 };

typedef struct bodies_state {
    long double x_m[BODIES_MOST];
    long double v_mps[BODIES_MOST];
} bodies_state;

typedef struct by_bodies {
    const void *of; /* what the two below are given */
    int bodies;
    double step_s;
    int steps;
    /* How the rates change. */
    void (*accelerate)(const void *of, const bodies_state *s, long double *a_mps2);
    /* The coordinates in which the scene has these places. */
    void (*count)(const void *of, const long double *x_m, long double *q_m);
} by_bodies;

/* Runge-Kutta 4 from these places at rest: the coordinates at the end, and the range of each. */
void by_bodies_run(const by_bodies *b, const long double *start_m, long double *end_m,
                   double *range_m);

#endif

/* by_bodies.h: motion of bodies on a line in long double, each in absolute coordinates, so that quantities of two
 * bodies are never added. */
#ifndef TESTS_HOST_BY_BODIES_H
#define TESTS_HOST_BY_BODIES_H

enum { BODIES_MOST = 3 };

typedef struct bodies_state {
    long double x_m[BODIES_MOST];
    long double v_mps[BODIES_MOST];
} bodies_state;

typedef struct by_bodies {
    const void *of; /* passed to the two functions below */
    int bodies;
    double step_s;
    int steps;
    /* Computes the slopes of the rates. */
    void (*accelerate)(const void *of, const bodies_state *s, long double *a_mps2);
    /* Converts these positions to the scene's coordinates. */
    void (*count)(const void *of, const long double *x_m, long double *q_m);
} by_bodies;

/* Integrates by Runge-Kutta 4 from rest at start_m. Returns the coordinates at the end and the range of each. */
void by_bodies_run(const by_bodies *b, const long double *start_m, long double *end_m,
                   double *range_m);

#endif

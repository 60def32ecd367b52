/* run_monitor.h: the range of each component of a run, and the place at which its coordinates came closest to a singular one.
 *
 * A singular place has a mass matrix with a pivot of nearly nothing. The matrix is eliminated after steps in which the accelerations
 * changed most so far, so that a run asks for it as often as the logarithm of that change. Scenes with contacts are not asked: their
 * accelerations jump. Nothing of it touches the run. */
#ifndef CHECK_RUN_MONITOR_H
#define CHECK_RUN_MONITOR_H

#include "books.h"
#include "host/engine/vector_field.h"

/* Where a pivot of the mass matrix was least, of the largest that its diagonal entry had. */
typedef struct run_monitor_singular {
    double inertia; /* 1 where it was not asked for */
    int component;  /* the rate that it is of, */
    double at_s;
    int near;       /* the position that makes it singular, or -1, */
    double near_at; /* which stood so there */
} run_monitor_singular;

typedef struct run_monitor {
    vector_field *field;
    double step_s;
    uint64_t steps;
    double *low; /* [n] */
    double *high;
    double *slope;  /* [2 * n] now, before */
    double *mass;   /* [rows * rows] */
    double *most;   /* [rows] largest diagonal entries seen */
    double *change; /* [n] the largest change of its slope in a step, looked at */
    bool looks;     /* for singular places */
    run_monitor_singular singular;
} run_monitor;

run_monitor *run_monitor_open(const image *im, const engine_kind *kind);
void run_monitor_close(run_monitor *w); /* NULL is fine */
/* Enter the state after each step, the start included, after the books; `b` may be NULL. */
void run_monitor_enter(run_monitor *w, const engine_kind *kind, const books *b, const void *run);

#endif

/* run_monitor.h: the range of each component of a run, and the place where its coordinates came closest to a singularity.
 *
 * At a singular place a pivot of the mass matrix is nearly zero. The matrix is eliminated only after steps with the largest change
 * of the accelerations so far. So the number of eliminations grows as the logarithm of that change. Scenes with contacts are not
 * tested: their accelerations jump. The monitor never changes the run. */
#ifndef CHECK_RUN_MONITOR_H
#define CHECK_RUN_MONITOR_H

#include "books.h"
#include "host/engine/vector_field.h"

/* The least pivot of the mass matrix, relative to the largest value of its diagonal entry. */
typedef struct run_monitor_singular {
    double inertia; /* 1 without a test */
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
    double *change; /* [n] the largest change of its slope in a tested step */
    bool looks;     /* for singular places */
    run_monitor_singular singular;
} run_monitor;

run_monitor *run_monitor_open(const image *im, const engine_kind *kind);
void run_monitor_close(run_monitor *w); /* NULL is fine */
/* Enters the state after each step, the start included, after the balance; `b` may be NULL. */
void run_monitor_enter(run_monitor *w, const engine_kind *kind, const books *b, const void *run);

#endif

/* cure.h: what a warning is to name as a cure, done: the run again with it, watched and judged as the run was. Linear theory
 * proposes, and of a run that was ruined it knows little: where it went is not where the motion goes. */
#ifndef RUN_CURE_H
#define RUN_CURE_H

#include <signal.h>

#include "engine.h"

typedef struct cure_wish {
    wh_method method;
    double step_s; /* the run's own, or another */
    bool compensated;
    bool in_double; /* whatever the run's number */
} cure_wish;

typedef enum cure_outcome {
    CURE_DOES,     /* nothing is to be said of the run with it */
    CURE_DOES_NOT, /* it is to be warned of, too, or fails */
    CURE_ROUNDS,   /* nothing but that the number has too few digits, or may have (digits.h) */
    CURE_NOT_TRIED, /* it would take too long, or was stopped; or the number has a plan for its one step */
} cure_outcome;

/* What one run's cures have taken so far. */
typedef struct cures {
    const image *image;
    const engine_kind *kind;
    const volatile sig_atomic_t *stop; /* ends a trial; may be NULL */
    double spent;                      /* of what they may take, 1 */
    bool ended;                        /* the last one that was tried went through to its end */
} cures;

/* Operations that it takes, of all that a run's cures may; above 1, or where no whole number of steps counts it, it is not tried. */
double cure_share(const cures *c, const cure_wish *what);

cure_outcome cure_try(cures *c, const cure_wish *what);

#endif

/* held.h: a run's records held against a tube round the exact motion: until when each coordinate and rate is proved to be
 * within a tolerance of it, at the end of every step. The records are those of the run as it is, float's or double's, to
 * the bit. */
#ifndef PROVE_HELD_H
#define PROVE_HELD_H

#include <signal.h>

#include "host/run/engine.h"
#include "tube.h"

#define HELD_TOLERANCE 1e-3 /* of a coordinate's range in the run */

typedef struct held_wish {
    const exact_motion *motion;
    const image *image;
    const engine_kind *kind;
    double tolerance;
    const double *within;              /* [states] SI; 0: the tolerance times the range */
    const volatile sig_atomic_t *stop; /* may be NULL */
    /* At the end of each of the run's steps: where the exact motion is, exact[states]. May be NULL. */
    void (*see)(void *told, uint64_t step, const enclosure *exact);
    void *told;
} held_wish;

typedef enum held_verdict {
    HELD_TO_THE_END, /* within, at every step's end: proved */
    HELD_LEFT,       /* proved until until_s; and at the step behind it proved to be further off */
    HELD_UNTOLD,     /* proved until until_s; behind it the tube is too wide to tell */
    HELD_TUBE_ENDS   /* proved until until_s, where the tube ends */
} held_verdict;

/* Of a state of the motion; SI. */
typedef struct held_state {
    held_verdict verdict;
    bool open;
    double range;  /* the most less the least value in the run, at least a thousandth of its size */
    double within; /* what it is to be within */
    double until_s;
    double off;    /* not less than it has been off, until then */
    double radius; /* of the tube, the most until then */
} held_state;

typedef struct held {
    held_state *state; /* [motion->states] */
    int states;
    wh_status status;   /* of the run's last step */
    uint64_t run_steps; /* that were done */
    uint64_t tube_steps;
    double tube_s;   /* the tube's last time */
    bool tube_ended; /* before the end of the run */
    bool stopped;
} held;

held held_run(const held_wish *w);
void held_free(held *h);

#endif

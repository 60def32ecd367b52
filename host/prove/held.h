/* held.h: a run's records held against a tube round the exact motion: until when each coordinate and rate is proved to be
 * within a tolerance of it, at the end of every step. The records are those of the run as it is, float's or double's, to
 * the bit. */
#ifndef PROVE_HELD_H
#define PROVE_HELD_H

#include <signal.h>
#include <stdio.h>

#include "host/prove/tube.h"
#include "host/run/engine.h"

#define HELD_TOLERANCE 1e-3 /* of a coordinate's range in the run */

typedef struct held_wish {
    const exact_motion *motion;
    const image *image;
    const engine_kind *kind;
    double tolerance;
    const double *within;              /* [states] SI; 0: the tolerance times the range */
    double products_most;              /* of enclosures that it may take; 0: as many as it wants */
    const volatile sig_atomic_t *stop; /* may be NULL */
    /* At the start, and at the end of each of the run's steps that the tube gets to: where the exact motion is,
     * exact[states], and the run, SI. May be NULL. */
    void (*see)(void *told, uint64_t step, const enclosure *exact, const double *run);
    void *told;
    void (*progress)(double share); /* may be NULL */
} held_wish;

typedef enum held_verdict {
    HELD_TO_THE_END, /* within, at every step's end: proved */
    HELD_LEFT,       /* proved until until_s; and at the step behind it proved to be further off */
    HELD_UNTOLD,     /* proved until until_s; behind it the tube is too wide to tell */
    HELD_UNENDED /* proved until until_s, where the tube or the run ends: held_found's `end` says why */
} held_verdict;

/* What ended it. */
typedef enum held_end {
    HELD_AT_END,   /* of the run's steps, or all states have left */
    HELD_RUN_ENDS, /* the run failed */
    HELD_NO_STEP,  /* no step of the tube leads on */
    HELD_SPENT,    /* it would take more than it may */
    HELD_STOPPED   /* it was asked to stop */
} held_end;

/* Of a state of the motion; SI. */
typedef struct held_state {
    held_verdict verdict;
    bool open;
    bool begun;   /* it is within at the start: else nothing is proved */
    double range; /* the most less the least value in the run, at least a thousandth of its size */
    double
        within; /* what it is to be within: asked for, or the tolerance times its range, or times a thousandth of the
                      largest range of its unit */
    double until_s;
    double off;    /* not less than it has been off, until then */
    double radius; /* of the tube, the most until then */
} held_state;

typedef struct held_found {
    held_state *state; /* [motion->states] */
    int states;
    wh_status status;   /* of the run's last step */
    uint64_t run_steps; /* that were done */
    uint64_t tube_steps;
    double tube_s; /* the tube's last time */
    held_end end;
    bool ranged; /* the run was done, so that it is known what it is to be within */
} held_found;

held_found held_run(const held_wish *w);
void held_free(held_found *h);

/* === in words ================================================================================= */
/* What is proved of a run, in words and in rows. */

void held_print(FILE *out, const held_found *h, const held_wish *w);

/* Rows of comma-separated values, in SI, with all digits: the time, and of each state the least and the most that the exact
 * motion may be, and what the run has. */
void held_rows_head(FILE *out, const held_wish *w);
void held_row(FILE *out, const held_wish *w, uint64_t step, const enclosure *exact,
              const double *run);

#endif

/* containment.h: comparison of a run's records with a tube around the exact motion. For each coordinate and rate it
 * proves a time until which the error at every step's end is within a tolerance. */
#ifndef PROVE_CONTAINMENT_H
#define PROVE_CONTAINMENT_H

#include <stdio.h>

#include "host/engine/engine.h"
#include "host/prove/flowpipe.h"

#define CONTAINMENT_TOLERANCE 1e-3 /* relative to a coordinate's range in the run */

typedef struct containment_request {
    const exact_motion *motion;
    const image *image;
    const engine_kind *kind;
    double tolerance;
    const double *within; /* [states] allowed errors, SI; 0 means tolerance * the state's range */
    double products_most; /* limit on the number of products of enclosures; 0: no limit */
    /* Called at the start and at each step's end that the tube reaches. exact[states] encloses the exact motion;
     * run[states] has the run's values. Both are in SI. `see` may be NULL. */
    void (*see)(void *context, uint64_t step, const enclosure *exact, const double *run);
    void *context;
    void (*progress)(double share); /* may be NULL */
} containment_request;

typedef enum containment_verdict {
    CONTAINMENT_TO_THE_END, /* the error is proved to be within the tolerance at every step's end */
    /* proved until until_s; at the next step's end, the error is proved to exceed the tolerance */
    CONTAINMENT_LEFT,
    CONTAINMENT_UNDECIDED, /* proved until until_s; then the tube is too wide to decide */
    CONTAINMENT_UNENDED /* proved until until_s; then the proof ended: see containment_found.end */
} containment_verdict;

typedef enum containment_end {
    CONTAINMENT_AT_END,   /* the whole run is compared, or every state is decided */
    CONTAINMENT_RUN_ENDS, /* the run failed */
    CONTAINMENT_NO_STEP,  /* the tube has no further step */
    CONTAINMENT_SPENT,    /* the limit on products was reached */
    CONTAINMENT_STOPPED   /* the user interrupted */
} containment_end;

/* The result for one state. Its quantities are in SI. */
typedef struct containment_state {
    containment_verdict verdict;
    bool open;
    bool begun;   /* the error is within the tolerance at the start; if not, nothing is proved */
    double range; /* greatest minus least value in the run, at least 1e-3 of the largest |value| */
    /* allowed error, SI: as requested, or from the tolerance and the ranges */
    double within;
    double until_s;
    double off;    /* upper bound on the state's error until until_s */
    double radius; /* largest radius of the tube until until_s */
} containment_state;

typedef struct containment_found {
    containment_state *state; /* [motion->states] */
    int states;
    wh_status status;   /* status of the run's last step */
    uint64_t run_steps; /* completed steps of the run */
    uint64_t flowpipe_steps;
    double tube_s; /* time of the last record that was compared with the tube */
    containment_end end;
    bool ranged; /* the first run was not interrupted, so the tolerances are known */
} containment_found;

containment_found containment_run(const containment_request *w);
void containment_free(containment_found *h);

/* === results in words ========================================================================= */

void containment_print(FILE *out, const containment_found *h, const containment_request *w);

/* Write comma-separated rows, in SI with all digits: the time, and for each state the least and greatest value of the
 * exact motion and the run's value. */
void containment_rows_head(FILE *out, const containment_request *w);
void containment_row(FILE *out, const containment_request *w, uint64_t step, const enclosure *exact,
                     const double *run);

#endif

/* pole.h: detects steps that jump over a pole, or through a contact (missed.h). No motion passes a state at which an
 * expression grows without bound, such as x'/(v0 + x') at x' = -v0. But a step can jump over this state without
 * evaluating the expression near it. If the finer run jumps over it, too, the two runs can agree.
 *
 * Values that change their sign at a pole are evaluated after each step. After a sign change the path between the two
 * states is tested for a pole. In a step with events, divisors that depend on values set by the event are not tested:
 * an impact changes rates, and a crossing assigns values, without passing through a pole. */
#ifndef CHECK_POLE_H
#define CHECK_POLE_H

#include "missed.h"

typedef struct pole_crossing pole_crossing;

/* Returns NULL if the scene has no moving divisor, and no contact or force that a step may miss. */
pole_crossing *pole_crossing_open(const image *im);
void pole_crossing_close(pole_crossing *j); /* NULL is fine */
/* Call it at the start and after each step. The search ends at the first pole or missed contact. */
void pole_crossing_enter(pole_crossing *j, const engine_kind *kind, const void *run);
/* pole_crossing_pass(): skips a step, in place of pole_crossing_enter(). The next step is not tested either, because
 * its begin is unknown. pole_crossing_unseen(): number of untested steps. */
void pole_crossing_pass(pole_crossing *j);
uint64_t pole_crossing_unseen(const pole_crossing *j);
/* Has the run jumped over a pole or missed a contact? */
bool pole_crossing_some(const pole_crossing *j);
/* The begin of the step that jumped over the pole, or missed the contact. */
double pole_crossing_begin_s(const pole_crossing *j);
/* The missed contact or force (missed_enter()); MISSED_NOTHING for a pole. */
missed_found pole_crossing_through(const pole_crossing *j);
/* The expression with the pole. */
const diagnostics_question *pole_crossing_over(const pole_crossing *j);

/* === a pole on the way =========================================================================== */
/* Finds a pole on the path from one state to the next.
 *
 * At a pole, a divisor changes its sign, and an expression grows about as fast as 1/distance. Halving locates the sign
 * change. Each expression is sampled on both sides, at the smallest distances at which round-off does not hide its
 * growth. If all expressions grow more slowly, such as 1/sqrt(distance), the place is no pole, and the search goes on.
 *
 * A divisor such as 1 - cos(q) touches zero without a change of sign. If its tangents at both ends of a part of the
 * path permit a zero, golden sections find the least magnitude of the divisor. This place is tested for growth. */

typedef struct pole_way {
    void *of;
    int signs;
    int values;
    const double *nearest; /* [signs] smallest tested distance from a zero, in shares of the path */
    /* Evaluates the divisors (sign[signs]) and expressions (value[values]) at this share of the path, 0 to 1. */
    void (*at)(void *of, double share, double *sign, double *value);
} pole_way;

/* May a value touch zero on a path? value[]: its samples at the shares 0, POLE_ASIDE, 1 - POLE_ASIDE and 1. The
 * magnitude of the value is assumed to be convex. */
#define POLE_ASIDE 0x1p-20
bool pole_may_touch(const double value[static 4]);

/* The first expression with a pole on the path, or -1. */
int pole_on(const pole_way *w);

#endif

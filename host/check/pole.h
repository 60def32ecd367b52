/* pole.h: steps that jump over a pole, or through a contact (missed.h). No motion passes a state at which an expression
 * grows without bound, such as x'/(v0 + x') at x' = -v0. But a step that is longer than the distance to the pole does
 * not evaluate the expression near it. Nor does a step of half the length, so the run and its finer run agree.
 *
 * Values that change their sign at a pole are evaluated after each step. After a sign change the path between the two
 * states is tested for a pole. In a step with events, divisors that an event may change abruptly are not tested: an
 * impact changes rates, and a crossing assigns values, without passing through a pole. */
#ifndef CHECK_POLE_H
#define CHECK_POLE_H

#include "missed.h"

typedef struct pole_crossing pole_crossing;

/* Returns NULL if the scene has no moving divisor, and no contact or force that a step may miss. */
pole_crossing *pole_crossing_open(const image *im);
void pole_crossing_close(pole_crossing *j); /* NULL is fine */
/* Enters the state after each step, the start included. The search ends at the first pole. */
void pole_crossing_enter(pole_crossing *j, const engine_kind *kind, const void *run);
/* pole_crossing_pass(): skips a step, in place of pole_crossing_enter(). The next step is not tested either, because its
 * begin is unknown. pole_crossing_unseen(): number of steps that were not tested. */
void pole_crossing_pass(pole_crossing *j);
uint64_t pole_crossing_unseen(const pole_crossing *j);
/* Has the run jumped over a pole or missed a contact? */
bool pole_crossing_some(const pole_crossing *j);
/* The contact that the run passed through, as missed_enter() reports it; MISSED_NOTHING if it was a pole. *begin_s: the
 * begin of that step. */
missed_found pole_crossing_through(const pole_crossing *j, double *begin_s);
/* The expression with the pole. *begin_s: the begin of the step that jumped. */
const diagnostics_question *pole_crossing_over(const pole_crossing *j, double *begin_s);

/* === a pole on the way =========================================================================== */
/* Finds a pole on the way from one state to the next.
 *
 * Some values change their sign at a pole (divisors), others grow there (expressions). A sign change is located by halving. Each
 * expression is followed towards that place on both sides, down to the smallest distances at which it still changes smoothly.
 * Nearer there is only round-off. The place is a pole if an expression grows at least as fast as one over the distance. A limit,
 * an integrable singularity (one over a root), growth in jumps and growth that ends are no poles. After a rejected place the rest
 * of the way is tested separately, because 1 + k/s changes its sign twice where s changes its sign once.
 *
 * A value that only touches zero, such as 1 - cos(q), changes no sign. If its size falls at the begin of a way and rises at the
 * end, steeply enough to touch zero, golden sections find its minimum. The minimum is tested in the same way. If the value has
 * changed its sign at the minimum, as k + s + s^2/m may, the ways on both sides of it are tested. */

typedef struct pole_way {
    void *of;
    int signs;
    int values;
    const double
        *nearest; /* [signs] smallest tested distance from a zero, as a share of the path */
    /* Evaluates sign[signs] and value[values] at this share of the way, 0 to 1. */
    void (*at)(void *of, double share, double *sign, double *value);
} pole_way;

/* May a value with these samples at 0, POLE_ASIDE, 1 - POLE_ASIDE and 1 have touched zero in between? A value with the
 * curvature of a square stays above its tangents. */
#define POLE_ASIDE 0x1p-20
bool pole_may_touch(const double value[static 4]);

/* The first expression with a pole on the path, or -1. */
int pole_on(const pole_way *w);

#endif

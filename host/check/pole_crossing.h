/* pole_crossing.h: steps that jump over a pole, or through a contact (missed.h). No motion passes a place of unbounded growth, such
 * as x'/(v0 + x') at x' = -v0. But a step longer than the way there never sees it. Half the step does not either, so the two runs
 * agree.
 *
 * Values that change their sign at a pole (denominators.h) are evaluated after each step. After a sign change the way between the
 * two states is tested for a pole (pole.h). In steps with events only divisors that depend on places alone are tested, because an
 * impact makes rates jump without passing through a pole. The same holds for values that a crossing sets. */
#ifndef CHECK_POLE_CROSSING_H
#define CHECK_POLE_CROSSING_H

#include "missed.h"

typedef struct pole_crossing pole_crossing;

/* NULL without any moving divisor or contact to miss. */
pole_crossing *pole_crossing_open(const image *im);
void pole_crossing_close(pole_crossing *j); /* NULL is fine */
/* Enters the state after each step, the start included. The search ends at the first pole. */
void pole_crossing_enter(pole_crossing *j, const engine_kind *kind, const void *run);
/* Skips a step, and the next state. And the number of skipped steps. */
void pole_crossing_pass(pole_crossing *j);
uint64_t pole_crossing_unseen(const pole_crossing *j);
/* Has the run jumped over one? */
bool pole_crossing_some(const pole_crossing *j);
/* The contact that it passed through, as missed_enter() returns it, and the begin of that step; nothing: it was a
 * pole. */
missed_found pole_crossing_through(const pole_crossing *j, double *begin_s);
/* The expression with the pole, and the begin of that step. */
const diagnostics_question *pole_crossing_over(const pole_crossing *j, double *begin_s);

#endif

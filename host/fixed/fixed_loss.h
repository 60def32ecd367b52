/* fixed_loss.h: round-off of the steps of a run in fixed point, compared with the same step of RK4 in double from the same
 * state. The difference of the increments is lost; its sum since the start is reported (host/check/slow.h). */
#ifndef FIXED_FIXED_LOSS_H
#define FIXED_FIXED_LOSS_H

#include "host/fixed/fixed_plan.h"

typedef struct fixed_loss fixed_loss;

fixed_loss *fixed_loss_new(const fixed_plan *p, const wh_fixed_state *start);
void fixed_loss_free(fixed_loss *l);

/* Around each step. A step with clamped values does not count, because clamping is reported separately. */
void fixed_loss_before(fixed_loss *l, const wh_fixed_state *state);
void fixed_loss_after(fixed_loss *l, const wh_fixed_state *state);

/* Of component i, angles first: the largest size of that sum since the start, and the span that the component would have
 * covered with it; SI. */
double fixed_loss_off(const fixed_loss *l, int i, double *span);

/* The smallest increment of component i; SI. */
double fixed_loss_unit(const fixed_plan *p, int i);

#endif

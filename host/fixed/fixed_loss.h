/* fixed_loss.h: what rounding takes from the steps of a run in fixed point: beside each, the same step of RK4 in double, from
 * the same state. What that adds and the run's did not is lost; its sum since the start is told (host/check/slow.h). */
#ifndef FIXED_FIXED_LOSS_H
#define FIXED_FIXED_LOSS_H

#include "host/fixed/fixed_plan.h"

typedef struct fixed_loss fixed_loss;

fixed_loss *fixed_loss_new(const fixed_plan *p, const wh_fixed_state *start);
void fixed_loss_free(fixed_loss *l);

/* Around each step. One in which values were held at an end of their range does not count: that is told by itself. */
void fixed_loss_before(fixed_loss *l, const wh_fixed_state *state);
void fixed_loss_after(fixed_loss *l, const wh_fixed_state *state);

/* Of component i, angles first: the largest size of that sum since the start, and the span that the component would have
 * covered with it; SI. */
double fixed_loss_off(const fixed_loss *l, int i, double *span);

/* What component i moves by, at least; SI. */
double fixed_loss_unit(const fixed_plan *p, int i);

#endif

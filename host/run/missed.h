/* missed.h: what a step passes through: a latch between two places, a stop or a steep hill of potential energy thinner than
 * the way of a step. Both ends of the step are outside, so that the core sees nothing of it, and half the step sees it no better.
 *
 * The way of a step is the cubic through the places and rates at its ends. Each gap and condition is bounded on it by
 * intervals (host/number/enclosure.h), a gap also by its rate (mean value form), and the way is halved where that leaves it
 * open, until a place inside is found or there is none. Accelerations are bounded so where an exponential function is in them:
 * far above those at both ends, and enough to turn the rate, the step has passed over a force. */
#ifndef RUN_MISSED_H
#define RUN_MISSED_H

#include "engine.h"

typedef struct missed missed;

/* NULL where there is neither a stop, a hold nor such a force. */
missed *missed_open(const image *im);
void missed_close(missed *m); /* NULL is fine */
/* Enter the state after each step, the start included; `eventful`: the step had events, and is not judged. Returns the
 * contact that the step passed through; or the number of contacts and on top the coordinate whose force; or -1. */
int missed_enter(missed *m, const engine_kind *kind, const void *run, bool eventful);

#endif

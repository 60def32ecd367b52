/* missed.h: contacts and forces that a step passes through: a latch between two places, a crossing that is crossed back, a
 * stop, a steep hill of potential energy or a friction's narrow limit, each thinner than the way of a step. Both ends of the step are outside, so the core sees nothing of it. A step of half
 * the length sees it no better.
 *
 * The way of a step is the cubic through the places and rates at its ends. A step with events has a way between each two of
 * them. Each gap and condition is bounded on it by Taylor forms (taylor_bounds.h). The way is halved until a place inside is found or
 * excluded. A contact that stays open after so many parts is reported as open. Accelerations are bounded so if an exponential
 * function is in them: far above those at both ends, and enough to turn the rate, the step has passed over a force. One that
 * stays open is reported as open. A friction's limits are bounded so if they move: it has passed over one if they are far
 * larger than at both ends where it slides, or too small to keep it where it sticks.
 *
 * A stop's gap with abs, max, min or sign may have edges. The core keeps what rests on one face there, and does not let it go at
 * an edge. A step in which the slope of such a gap jumps while the stop rests is reported. */
#ifndef CHECK_MISSED_H
#define CHECK_MISSED_H

#include "host/engine/engine.h"

typedef struct missed missed;

/* NULL where there is neither a contact nor such a force. */
missed *missed_open(const image *im);
void missed_close(missed *m); /* NULL is fine */
/* `what`: the contact that a step passed through, or the number of contacts plus the coordinate whose force it passed over,
 * or -1. Not sure: it could neither be found nor excluded. */
typedef struct missed_found {
    int what;
    bool sure;
    bool edge; /* a body that rested on the stop slid over an edge of it */
} missed_found;
#define MISSED_NOTHING ((missed_found){-1, false, false})

/* Enter the state after each step, the start included. `eventful`: the step had events. `blind`: the state before it was not
 * entered, and nothing is looked for. */
missed_found missed_enter(missed *m, const engine_kind *kind, const void *run, bool eventful,
                          bool blind);

#endif

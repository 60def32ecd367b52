/* missed.h: contacts and forces that are thinner than the path of one step. Examples are a latch between two places, a
 * crossing that is crossed back, a stop, a steep rise of the potential energy, or a friction's narrow limit. Both ends of
 * the step are outside, so the core does not notice them. A step of half the length does not either.
 *
 * The path of a step is the cubic through the positions and rates at its ends. A step with events has one path between each
 * two events. Taylor forms bound each gap and condition on the path. The path is halved until a point inside the contact is
 * found or excluded. If that fails, the contact is reported as undecided.
 *
 * Accelerations with a kink, an exponential or a hyperbolic function are bounded in the same way. A step has passed over a
 * force if the acceleration is far above both ends and large enough to turn the rate. Moving limits of a friction are bounded,
 * too. A step has passed over the friction if, between its ends, the limits of a sliding friction are far larger, or those of
 * a sticking friction too small to keep it. If the bounds do not decide, the force is undecided.
 *
 * A stop's gap with abs, max, min or sign may have edges. The core keeps a resting body on the face that it rests on, and
 * does not release it at an edge. A step is reported if the slope of such a gap jumps while the body rests. */
#ifndef CHECK_MISSED_H
#define CHECK_MISSED_H

#include "host/engine/engine.h"

typedef struct missed missed;

/* NULL without any contact or force that may have a narrow hill. */
missed *missed_open(const image *im);
void missed_close(missed *m); /* NULL is fine */
/* `what`: the index of the contact that a step passed through; or the number of contacts plus the index of the coordinate
 * whose force was missed; or -1 for nothing. `sure`: false: undecided. */
typedef struct missed_found {
    int what;
    bool sure;
    bool edge; /* a resting body slid over an edge of its stop */
} missed_found;
#define MISSED_NOTHING ((missed_found){-1, false, false})

/* Enters the state `to` after each step, the start included. `from`: the state before the step; NULL: it is not known, and
 * the step is not tested. `eventful`: the step had events. */
missed_found missed_enter(missed *m, const engine_kind *kind, const void *run, const double *from,
                          const double *to, bool eventful);

#endif

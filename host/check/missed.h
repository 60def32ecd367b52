/* missed.h: detects contacts and forces that act only between the ends of a step. The core does not evaluate them,
 * and a run with half the step may miss them, too. Examples are a latch, a thin stop, a narrow peak of a force,
 * and a brief change of a friction limit.
 *
 * The path of a step is the cubic through the positions and rates at its ends. Events split a step into several paths.
 * Taylor forms bound each gap and condition on the path. The path is halved until a point inside the contact is found
 * or excluded. If the halvings do not suffice, the contact is reported as undecided.
 *
 * Accelerations with a kink, an exponential or a hyperbolic function are bounded in the same way. A force is missed if
 * the acceleration far exceeds the accelerations at both ends, and would change the rate noticeably.
 *
 * Friction limits that are not constant are bounded, too. A change is missed if the friction slides and its limit is
 * far larger inside the path than at the ends. It is also missed if the friction sticks and should slip in the path.
 *
 * A stop's gap with abs, max, min or sign may have edges. The core keeps a resting body on the stop's face, even beyond
 * an edge. So a step is reported if the slope of such a gap jumps while the body rests. */
#ifndef CHECK_MISSED_H
#define CHECK_MISSED_H

#include "host/engine/engine.h"

typedef struct missed missed;

/* Returns NULL if the image has no contacts, and its accelerations cannot have a narrow peak. */
missed *missed_open(const image *im);
void missed_close(missed *m); /* NULL is fine */
typedef struct missed_found {
    int what;  /* contact k: k; force on coordinate i: (number of contacts) + i; -1: none */
    bool sure; /* false: undecided */
    bool edge; /* a resting body slid over an edge of its stop */
} missed_found;
#define MISSED_NOTHING ((missed_found){-1, false, false})

/* Call it at the start and after each step. `to`: the present state. `from`: the state before the step; if it is NULL,
 * the step is not tested. `eventful`: the step had events. */
missed_found missed_enter(missed *m, const engine_kind *kind, const void *run, const double *from,
                          const double *to, bool eventful);

#endif

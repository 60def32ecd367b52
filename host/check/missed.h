/* missed.h: detects contacts and forces that act only between the ends of a step. The core does not evaluate them; a
 * run with half the step may miss them, too. Examples are a latch, a crossing that is crossed back, a thin stop, a
 * narrow peak of a force, and a friction limit that changes briefly.
 *
 * The path of a step is the cubic through the positions and rates at its ends; events split the step into several
 * paths. Taylor forms bound each gap and condition on the path. Halving the path finds a point inside the contact, or
 * excludes one; else the contact is reported as undecided.
 *
 * Accelerations with a kink, an exponential or a hyperbolic function are bounded in the same way. A force is missed if
 * the acceleration far exceeds those at both ends and would change the rate noticeably. Friction limits that are not
 * constant are bounded, too. A limit is missed if it is far larger inside a sliding path than at its ends, or
 * too small inside the path to keep a sticking friction stuck.
 *
 * A stop's gap with abs, max, min or sign may have edges. The core keeps a resting body on its face, even beyond an
 * edge. A step is reported if the slope of such a gap jumps while the body rests. */
#ifndef CHECK_MISSED_H
#define CHECK_MISSED_H

#include "host/engine/engine.h"

typedef struct missed missed;

/* Returns NULL if the image has no contacts, and its accelerations cannot have a narrow peak. */
missed *missed_open(const image *im);
void missed_close(missed *m); /* NULL is fine */
/* what: index of the missed contact, or number of contacts plus index of the coordinate of a missed force; -1: none. */
typedef struct missed_found {
    int what;
    bool sure; /* false: undecided */
    bool edge; /* a resting body slid over an edge of its stop */
} missed_found;
#define MISSED_NOTHING ((missed_found){-1, false, false})

/* Call it at the start and after each step. `to`: the present state. `from`: the state before the step; if it is NULL,
 * the step is not tested. `eventful`: the step had events. */
missed_found missed_enter(missed *m, const engine_kind *kind, const void *run, const double *from,
                          const double *to, bool eventful);

#endif

/* aliasing.h: does more go on within a step than its stages see? A force at 1 kHz, in steps of 4 ms, is the same at every
 * stage, and is one that stands still. In steps of half the length it is that too, so that the finer run agrees.
 *
 * A third run takes a step that shares no period with either: the run's span over a prime number of steps. It meets
 * such a force at other moments each time, and ends elsewhere. They are compared at the end of the
 * span that the finer run trusts.
 */
#ifndef CHECK_ALIASING_H
#define CHECK_ALIASING_H

#include "step_doubling.h"

/* Once the runs have ended: fills in t->aliased. `of` pays for it; NULL: nobody. False: that is too little, or was
 * interrupted. */
bool aliasing_find(step_doubling *t, const budget *of);

#endif

/* aliasing.h: detects forcing that aliases with the step. A force of 1 kHz, in steps of 4 ms, is the same at every stage,
 * like a constant force. So it is in steps of half the length, and the finer run agrees. A third run takes a step that
 * shares no period with either: the run's span over a prime number of steps. It samples such a force at varying phases,
 * and ends elsewhere. The runs are compared at the end of the finer run's trusted span. */
#ifndef CHECK_ALIASING_H
#define CHECK_ALIASING_H

#include "step_doubling.h"

/* Fills in t->aliased, or t->unaliased, after the end of the runs. `of`: the budget to charge. */
void aliasing_find(step_doubling *t, budget *of);

#endif

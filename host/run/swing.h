/* swing.h: a system's swing or decay that is not linear: what linearising says of it at one place need not hold of the whole. */
#ifndef RUN_SWING_H
#define RUN_SWING_H

#include "linearised.h"

/* Does a swing or decay like this one, elsewhere on the run's way, grow by itself? Then what the method adds there it takes
 * somewhere else, and most of it may cancel. */
bool swing_varies(const linearised *l, const linear_motion *m);

/* By how much of a component's range, at most, the run's records are off the way of Runge-Kutta 4, in double, by half of
 * the run's step, from the same start. Of a scene without contacts. */
double swing_off(const watch *w);

#endif

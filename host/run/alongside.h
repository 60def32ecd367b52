/* alongside.h: a run once more, step by step beside the way of a quarter of its step: where its balance alone is in doubt, is its motion
 * right? Records are too few to tell: what a stiff damper ends in ten steps is over at the first of them. */
#ifndef RUN_ALONGSIDE_H
#define RUN_ALONGSIDE_H

#include "watch.h"

/* Is the run of this image, which has ended, within `part` of each component's range of the way of Runge-Kutta 4, in double, by
 * a quarter of its step, at every step? Of a scene without contacts; false where to ask takes too long. */
bool alongside_agrees(const image *im, const engine_kind *kind, const watch *w, double part);

#endif

/* faint.h: does a run move by so little that its number has no digits left for it? */
#ifndef RUN_FAINT_H
#define RUN_FAINT_H

#include "watch.h"

/* Below the least normal number (1.2e-38 in float, 2.2e-308 in double) numbers keep their last place and lose digits: what
 * sums round away is no part of what is summed any more. Says so, with a hint, of the component of which most is lost:
 * where the steps round away more than a thousandth of the furthest that it, or what has its unit, ever is. */
void faint_say(FILE *out, const image *im, const engine_kind *kind, const watch *w);

#endif

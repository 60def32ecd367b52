/* slow.h: what moves too slowly for the units of its steps: to be told, with the way out.
 *
 * A float turn angle moves by whole units, 2^32 a turn, 1.5e-9 rad. Below half of one a step it stands still, and
 * near that its rate is off. In fixed point so do all components, by units of their ranges. It is told of one when
 * what rounding took from its steps, summed since the start, was at some time more than SLOW_SHARE of the span that
 * they asked for, and more than a few units. So one that swings or turns and is slow only now and then is not: what
 * its slow steps lose is little beside its span. */
#ifndef CHECK_SLOW_H
#define CHECK_SLOW_H

#include <stdio.h>

#include "host/engine/engine.h"

#define SLOW_SHARE 1e-3
#define SLOW_LEAST_RAD 3e-9  /* two units: what an angle that hardly moves may show of rounding */
#define SLOW_LEAST_UNITS 4.0 /* in fixed point, where the accelerations are of whole units, too */

/* Is component i, angles first, one of those? */
bool slow_component(const engine_kind *kind, const void *run, int i);

/* How many are. */
int slow_count(const engine_kind *kind, const image *im, const void *run);

/* The largest part of its span that one of them is put off by; 0: there is none. */
double slow_share(const engine_kind *kind, const image *im, const void *run);

/* A note for each, and how to cure them. */
void slow_say(FILE *out, const image *im, const engine_kind *kind, const void *run);

#endif

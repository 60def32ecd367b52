/* slow.h: detects components that move too slowly for the units to which they are rounded.
 *
 * A float turn angle is rounded to units of 2^-32 turn, 1.5e-9 rad. An angle that should move by less than half a unit
 * per step does not move. The rate of a slightly faster angle is wrong. In fixed point, every component has a unit. A
 * component is slow if the round-off of all its steps exceeds a few units, and SLOW_SHARE of its range. */
#ifndef CHECK_SLOW_H
#define CHECK_SLOW_H

#include <stdio.h>

#include "host/engine/engine.h"

#define SLOW_SHARE 1e-3
#define SLOW_LEAST_RAD 3e-9  /* in float, smaller round-off is ignored: two units of 2^-32 turn */
#define SLOW_LEAST_UNITS 4.0 /* in fixed point, smaller round-off is ignored: four units */

/* Does component i move so slowly that its round-off shows? Angles come first. */
bool slow_component(const engine_kind *kind, const void *run, int i);

/* Returns the number of slow components. *share: their largest ratio of round-off to range; 0 if none is slow. */
int slow_count(const engine_kind *kind, const image *im, const void *run, double *share);

/* slow_say(): prints a note for each slow component, and remedies. slow_message(): only the text of the first note. */
void slow_say(FILE *out, const image *im, const engine_kind *kind, const void *run);
void slow_message(FILE *out, const image *im, const engine_kind *kind, const void *run);

#endif

/* apart.h: warnings about holds that a run's start violates, and hints with better start values. A hold keeps its
 * initial error during the run. An impulse at t = 0 sets a hold's initial rate to zero, and removes energy. */
#ifndef CHECK_APART_H
#define CHECK_APART_H

#include <stdio.h>

#include "host/image/image.h"

/* apart_say() ignores errors and rates up to this relative size as round-off. */
#define APART_LEAST 1e-6

/* Returns the largest error or rate of a hold, relative to the sum of |term| of the hold's expression. Prints nothing
 * if `out` is NULL. `who` begins each warning, as in "whirl run". If `who` is NULL, prints only the first message. */
double apart_say(FILE *out, const char *who, const image *im);

#endif

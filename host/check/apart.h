/* apart.h: warnings about holds that a run's start violates, and hints with better start values. The run keeps the
 * initial error of a hold's expression. An impulse at t = 0 stops its initial rate, and removes energy. */
#ifndef CHECK_APART_H
#define CHECK_APART_H

#include <stdio.h>

#include "host/image/image.h"

/* A hold's error or rate is round-off if it is at most APART_LEAST times the sum of its terms' magnitudes. */
#define APART_LEAST 1e-6

/* Returns the largest error or rate of a hold, relative to the sum of its terms' magnitudes. Prints nothing if
 * `out` is NULL. `who` begins each warning, as in "whirl run". If it is NULL, only the text of the first is printed. */
double apart_say(FILE *out, const char *who, const image *im);

#endif

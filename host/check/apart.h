/* apart.h: warnings about holds that a run's start violates. The run keeps the initial error of a hold's expression. An
 * impulse at t = 0 stops an initial rate and removes its energy. The warning suggests start values. */
#ifndef CHECK_APART_H
#define CHECK_APART_H

#include <stdio.h>

#include "host/image/image.h"

/* An error or rate of a hold up to this part of the sum of its terms' magnitudes is round-off. */
#define APART_LEAST 1e-6

/* Returns the largest error or rate of a hold, relative to the sum of its terms' magnitudes. Warnings to `out` (may be
 * NULL) begin with `who`, such as "whirl run"; if `who` is NULL, prints only the text of the first. */
double apart_say(FILE *out, const char *who, const image *im);

#endif

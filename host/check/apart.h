/* apart.h: holds that the start of a run does not satisfy. An expression of a hold keeps the value with which it starts.
 * If the expression starts with a rate, an impulse stops it and takes energy. The warning gives the error, and start
 * values that satisfy the holds. */
#ifndef CHECK_APART_H
#define CHECK_APART_H

#include <stdio.h>

#include "host/image/image.h"

/* An error or rate above this part of the sum of its terms' sizes is more than round-off. */
#define APART_LEAST 1e-6

/* The largest error or rate of a hold, divided by the sum of its terms' sizes; 0: the start satisfies all holds. Warnings
 * to `out` (may be NULL) begin with `who`, such as "whirl run". If `who` is NULL, prints only the first warning's text. */
double apart_say(FILE *out, const char *who, const image *im);

#endif

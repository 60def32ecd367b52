/* apart.h: holds that are true where a run starts and do not fit there: an expression that is a little off zero keeps that for
 * ever, and one that moves is stopped by an impulse, which takes energy. Warned of with the number, and with values of start that
 * fit. */
#ifndef CHECK_APART_H
#define CHECK_APART_H

#include <stdio.h>

#include "host/image/image.h"

/* Off zero, or moving, by more than this share of its terms is more than rounding. */
#define APART_LEAST 1e-6

/* By which part of its terms a hold is off zero or moves, at most; 0: all fit. That is said on `out`, if not NULL;
 * `who`: "whirl run". */
double apart_say(FILE *out, const char *who, const image *im);

#endif

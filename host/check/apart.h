/* apart.h: holds that do not fit the start of a run. If a held expression is slightly off zero, it stays so. If it moves, an
 * impulse stops it and takes energy. The warning has the error, and start values that fit. */
#ifndef CHECK_APART_H
#define CHECK_APART_H

#include <stdio.h>

#include "host/image/image.h"

/* An error or rate above this share of the hold's terms is more than round-off. */
#define APART_LEAST 1e-6

/* The largest error or rate of a hold, as a part of its terms; 0: all holds fit the start. Warns on `out`, if not NULL, as
 * `who`, such as "whirl run". */
double apart_say(FILE *out, const char *who, const image *im);

#endif

/* apart.h: holds that the start of a run does not satisfy. An expression of a hold that starts slightly away from zero stays
 * there. If it has a rate, an impulse stops it and takes energy. The warning gives the error, and start values that
 * satisfy the holds. */
#ifndef CHECK_APART_H
#define CHECK_APART_H

#include <stdio.h>

#include "host/image/image.h"

/* An error or rate above this share of the hold's terms is more than round-off. */
#define APART_LEAST 1e-6

/* The largest error or rate of a hold, as a part of its terms; 0: the start satisfies all holds. Warns on `out`, if not
 * NULL, as `who`, such as "whirl run"; if `who` is NULL, prints only the text of the first warning. */
double apart_say(FILE *out, const char *who, const image *im);

#endif

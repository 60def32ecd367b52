/* apart.h: holds that do not fit the start of a run. An expression that is slightly off zero stays so for ever. A moving one is
 * stopped by an impulse, which takes energy. The warning has the number, and start values that fit. */
#ifndef CHECK_APART_H
#define CHECK_APART_H

#include <stdio.h>

#include "host/image/image.h"

/* Off zero, or moving, by more than this share of its terms is more than rounding. */
#define APART_LEAST 1e-6

/* The largest error or rate of a hold, as a part of its terms; 0: all fit. Warns on `out`, if not NULL; `who`:
 * "whirl run". */
double apart_say(FILE *out, const char *who, const image *im);

#endif

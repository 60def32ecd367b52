/* growth.c: see growth.h. */
#include "growth.h"

#include <math.h>

#include "host/number/functions.h"

/* Each time, at least, a pole grows 1.71 times; one over the distance to the 9/10 grows 1.62 times. No power of two: numbers with
 * the same digits are rounded alike, and what that leaves would grow as evenly. */
#define GROWS 1.64
/* What goes on evenly changes as much each time, but for this. */
#define EVEN 1.1

growth growth_of(const double *value, int stride) {
    double least = (double)INFINITY;
    double most = 0.0;
    for (int k = 1; k < GROWTH_POINTS; k++) {
        const double before = value[(k - 1) * stride];
        const double now = value[k * stride];
        const double by = before == now ? 1.0 : now / before; /* both may be nothing */
        if (isinf(now) && isfinite(before) && fabs(before) > GROWTH_BEYOND) {
            return GROWTH_POLE;
        }
        if (!(by > 0.0) || isinf(now)) { /* or no number, or another sign */
            return GROWTH_ROUGH;
        }
        least = number_least(least, by);
        most = number_most(most, by);
    }
    if (!(most < EVEN * least)) {
        return GROWTH_ROUGH;
    }
    return least > GROWS ? GROWTH_POLE : GROWTH_NONE;
}

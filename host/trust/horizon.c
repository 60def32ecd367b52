/* horizon.c: see horizon.h. */
#include "horizon.h"

#include <math.h>
#include <stdlib.h>

#include "host/base/room.h"
#include "host/number/functions.h"

/* What the bound of rounding leaves out: roundings of a step's own sums, the library's functions. */
#define ROUNDING_ROOM 8.0
/* What hardly varies is measured by this part of its size: of a rate that stays at 34.56 rad/s within 0.007 float keeps no
 * thousandth. */
#define LEAST_RANGE 1e-3

static horizon_column judge(const twins *t, int k, double tolerance) {
    const twins_column *c = &t->column[k];
    const double range = c->high - c->low;
    const double least = LEAST_RANGE * number_most(fabs(c->low), fabs(c->high));
    const double level = tolerance * number_most(range, least) / t->left_out;
    horizon_column made = {.range = number_most(range, least),
                           .off = c->off.most * t->left_out,
                           .until_s = passages_until_s(&c->off, level)};
    if (!isfinite(made.until_s)) {
        made.verdict = range > 0.0 || made.off > 0.0 ? HORIZON_TO_THE_END : HORIZON_STILL;
        made.until_s = t->end_s;
    } else if (range <= ROUNDING_ROOM * c->rounding && isfinite(made.off)) {
        made.verdict = HORIZON_ROUNDING;
        made.until_s = t->end_s;
    } else {
        made.verdict = HORIZON_UNTIL;
    }
    return made;
}

horizon horizon_of(const twins *t, double tolerance) {
    horizon h = {.of = t,
                 .tolerance = tolerance,
                 .column = room(t->columns, sizeof *h.column),
                 .to_the_end = true,
                 .first = -1,
                 .until_s = t->end_s};
    for (int k = 1; k < t->columns; k++) {
        h.column[k] = judge(t, k, tolerance);
        if (h.column[k].verdict == HORIZON_UNTIL) {
            h.to_the_end = false;
            if (h.first < 0 || h.column[k].until_s < h.until_s) {
                h.first = k;
                h.until_s = h.column[k].until_s;
            }
        }
    }
    return h;
}

void horizon_free(horizon *h) {
    free(h->column);
    h->column = NULL;
}

/* horizon.c: see horizon.h. */
#include "horizon.h"

#include <math.h>
#include <stdlib.h>

#include "host/base/room.h"
#include "host/number/functions.h"

/* What the bound of rounding leaves out: roundings of a step's own sums, the library's functions. */
#define ROUNDING_ROOM 8.0
/* A rate that hardly varies is measured by this part of its size: of one that stays at 34.56 rad/s within 0.007 float keeps
 * no thousandth. */
#define LEAST_RANGE 1e-3

/* What has a rate of its own has its origin anywhere: how far from it that moves says nothing of how much. */
static bool is_place(const twins *t, int k) {
    const record_column *c = &t->shape->column[k];
    return image_find_component(&t->finer, c->unknown, c->primes + 1) >= 0;
}

static double measured_by(const twins *t, int k) {
    const twins_column *c = &t->column[k];
    const double least = LEAST_RANGE * number_most(fabs(c->low), fabs(c->high));
    return number_most(c->high - c->low, is_place(t, k) ? 0.0 : least);
}

static horizon_column judge(const twins *t, int k, double tolerance) {
    const twins_column *c = &t->column[k];
    const double range = c->high - c->low;
    const double by = measured_by(t, k);
    const double level = tolerance * by / t->left_out;
    horizon_column made = {
        .range = by, .off = c->off.most * t->left_out, .until_s = passages_until_s(&c->off, level)};
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

/* horizon.c: see horizon.h. */
#include "horizon.h"

#include <math.h>
#include <stdlib.h>

#include "host/base/room.h"
#include "host/number/functions.h"

/* What the bound of rounding leaves out: roundings of a step's own sums, the library's functions. */
#define ROUNDING_ROOM 8.0
/* A rate that hardly varies is measured by this part of its size: of one that stays at 34.56 rad/s within 0.007 float keeps
 * no thousandth. A place is not, for its origin may be anywhere. */
#define LEAST_RANGE 1e-3
#define LEAST_RANGE_DOUBLE 1e-9
/* A place that stays where it is but for rounding moves by less than this part of its distance from the origin, or of one
 * metre or radian; or by less than that part of what others of its unit move. */
#define STAYS 1e-9
/* In float, a place that moves by less than this part of its distance stands still. */
#define FLOAT_STAYS 3e-7
#define BESIDE_OTHERS 1e-3
/* A place whose start is computed by sums and is this part of a metre or radian, or less, is there by rounding; else by the scene. */
#define STARTS 1e-12
/* The bound of rounding is some twenty times what rounding does, eight times where it is alike at all states, as of a root of what
 * hardly changes. Where it does so much in the finer run, that shares it. */
#define BOUND_OVER 8.0

static double size_of(const twins_column *c) { return number_most(fabs(c->low), fabs(c->high)); }

static bool stays(const twins *t, int k) {
    const twins_column *c = &t->column[t->column[k].place];
    const double range = c->high - c->low;
    return range <= STAYS * number_most(size_of(c), c->one) || range <= BESIDE_OTHERS * c->alike;
}

bool horizon_moves(const twins *t, int k) {
    const twins_column *c = &t->column[t->column[k].place];
    const double moved = number_most(c->high - c->low, c->off.most);
    if (t->shape->kind == &engine_float && moved <= FLOAT_STAYS * size_of(c)) {
        return false;
    }
    return !stays(t, k) || fabs(c->start) > (c->written ? 0.0 : STARTS * c->one);
}

/* What its size is known to be at least: it stays where the scene puts it, and not by chance at one metre from nothing. */
static double least_size(const twins_column *c) {
    const double least = c->written ? 0.0 : STARTS * c->one;
    return fabs(c->start) > least ? size_of(c) : number_most(size_of(c), c->one);
}

/* Do both runs share what rounding does? What stays has no range to measure that by: it may stand for want of digits where
 * rounding might move it by more than its size, or one metre or radian where it starts at none. */
static bool has_few_digits(const twins *t, int k, double least) {
    const twins_column *c = &t->column[k];
    return c->rounding > BOUND_OVER * least && (!stays(t, k) || c->rounding > least_size(c));
}

/* A double has digits left for what hardly varies. */
static double least_range(const twins *t) {
    return t->shape->kind == &engine_double ? LEAST_RANGE_DOUBLE : LEAST_RANGE;
}

static horizon_column judge(const twins *t, int k, double tolerance) {
    const twins_column *c = &t->column[k];
    const double range = c->high - c->low;
    const double by = number_most(range, c->has_rate ? 0.0 : least_range(t) * size_of(c));
    const double level = tolerance * by / t->left_out;
    horizon_column made = {.range = by,
                           .off = c->off.most * t->left_out,
                           .rounding = c->rounding,
                           .until_s = passages_until_s(&c->off, level)};
    if (t->aliased.column > 0) { /* puts off both alike, nobody knows from when on */
        made.verdict = HORIZON_UNTIL;
        made.until_s = 0.0;
        return made;
    }
    const bool passed = isfinite(made.until_s);
    const bool few = has_few_digits(t, k, tolerance * by);
    if (passed && !(few && c->rounding > least_size(c)) &&
        (!t->otherwise || made.off <= ROUNDING_ROOM * c->rounding) &&
        range <= ROUNDING_ROOM * c->rounding && isfinite(made.off) && stays(t, k)) {
        made.verdict = HORIZON_ROUNDING;
        made.until_s = t->end_s;
    } else if (passed && t->unwrapped && made.until_s >= t->cut_s) {
        made.verdict = HORIZON_NOT_TOLD;
    } else if (passed) {
        made.verdict = HORIZON_UNTIL;
    } else if (few) {
        made.verdict = HORIZON_NOT_TOLD;
        made.until_s = 0.0;
    } else {
        made.verdict = range > 0.0 || made.off > 0.0 ? HORIZON_TO_THE_END : HORIZON_STILL;
        made.until_s = t->end_s;
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
        if (h.column[k].verdict == HORIZON_UNTIL || h.column[k].verdict == HORIZON_NOT_TOLD) {
            h.to_the_end = false;
            if (h.first < 0 || h.column[k].until_s < h.until_s) {
                h.first = k;
                h.until_s = h.column[k].until_s;
            }
        }
    }
    return h;
}

double horizon_trusted_s(const horizon *h) {
    const bool untold = !h->to_the_end && (h->column[h->first].verdict == HORIZON_NOT_TOLD ||
                                           h->of->aliased.column > 0);
    return untold ? -1.0 : h->until_s;
}

void horizon_free(horizon *h) {
    free(h->column);
    h->column = NULL;
}

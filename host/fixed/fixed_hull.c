/* fixed_hull.c: what the values of a list can be: interval arithmetic, cell by cell of the turn angles. A whole turn at once
 * would know no denominator from zero. */
#include <stdlib.h>

#include "fixed_list.h"
#include "host/base/room.h"
#include "host/number/functions.h"

/* Cells a turn, and of all turn angles together. */
enum {
    CELLS_LEAST = 4,
    CELLS = 64,
    CELLS_MOST = 1024,
    CELLS_ALL = 1 << 18,
    CELLS_ALL_MOST = 1 << 20
};

#define TURN 6.283185307179586477
/* What the core's sines are off, and its reciprocals of themselves (tests/core/test_fixed.c), and some. */
#define SINE_OFF 5e-8
#define QUOTIENT_OFF 8e-9

typedef struct hull {
    fixed_list *list;
    const fixed_leaves *leaves;
    bool bits_known;
    interval *now;   /* [count] in this cell */
    interval *angle; /* [angles] */
    int *cell;       /* [angles] */
    bool *cut;       /* [angles] is any phase made of it? */
    int cells;       /* a turn */
    bool at_middles; /* leaves stay in the middle of what they can be */
    bool divides_zero;
    bool unbounded;
} hull;

static interval phase_of(const hull *h, const fixed_op *o) {
    interval sum = {o->offset_rad, o->offset_rad};
    for (int k = 0; k < h->list->angles && o->turns != NULL; k++) {
        const double turns = o->turns[k];
        if (turns != 0.0) {
            sum = interval_add(sum, interval_mul((interval){turns, turns}, h->angle[k]));
        }
    }
    return sum;
}

static interval leaf_of(const hull *h, interval range) {
    const double middle = 0.5 * (range.low + range.high);
    return h->at_middles ? (interval){middle, middle} : range;
}

static interval value_of(hull *h, const fixed_op *o) {
    const interval none = {0.0, 0.0};
    const interval a = o->a.op >= 0 ? h->now[o->a.op] : none;
    const interval b = o->b.op >= 0 ? h->now[o->b.op] : none;
    switch (o->code) {
    case FIXED_CONSTANT: return (interval){o->value, o->value};
    case FIXED_LINEAR: return leaf_of(h, h->leaves->linear[o->index]);
    case FIXED_RATE: return leaf_of(h, h->leaves->rate[o->index]);
    case FIXED_INPUT: return leaf_of(h, h->leaves->input[o->index]);
    case FIXED_PHASE: return phase_of(h, o);
    case FIXED_SINE: return interval_widen(interval_sin(a), SINE_OFF);
    case FIXED_COSINE: return interval_widen(interval_cos(a), SINE_OFF);
    case FIXED_SUM: return interval_add(a, b);
    case FIXED_DIFFERENCE: return interval_sub(a, b);
    case FIXED_PRODUCT: return o->a.op == o->b.op ? interval_square(a) : interval_mul(a, b);
    case FIXED_SAME: return interval_mul(a, (interval){o->value, o->value});
    case FIXED_ABS: return interval_abs(a);
    case FIXED_SIGN: return (interval){a.low > 0.0 ? 1.0 : -1.0, a.high < 0.0 ? -1.0 : 1.0};
    case FIXED_LEAST: return interval_min(a, b);
    case FIXED_MOST: return interval_max(a, b);
    case FIXED_QUOTIENT:
        if (interval_holds_zero(b)) {
            h->divides_zero = true;
            return none;
        }
        const interval q = interval_div(a, b);
        return interval_widen(q, QUOTIENT_OFF * interval_size(q));
    }
    return none;
}

/* Rounding is half a unit of the result, and of what is shifted. */
static double rounding_of(const hull *h, const fixed_op *o) {
    const bool rounds = o->code > FIXED_PHASE;
    return h->bits_known && rounds ? number_scaled(4.0, -o->bits) : 0.0;
}

static bool is_bounded(interval a) {
    return a.low >= -FIXED_SIZE_MOST && a.high <= FIXED_SIZE_MOST;
}

static bool goes_on(const hull *h) { return !h->divides_zero && !h->unbounded; }

static bool stops(const hull *h) { return fixed_watch_stops(h->list->watch); }

static void enclose(hull *h, bool first) {
    fixed_list *l = h->list;
    for (int k = 0; k < l->angles; k++) {
        const double width = TURN / h->cells;
        h->angle[k] = (interval){h->cell[k] * width, (h->cell[k] + 1) * width};
    }
    for (int i = 0; i < l->count && goes_on(h); i++) {
        fixed_op *o = &l->op[i];
        if (o->used) {
            h->now[i] = interval_widen(value_of(h, o), rounding_of(h, o));
            h->unbounded = !is_bounded(h->now[i]);
            o->range = first ? h->now[i] : interval_hull(o->range, h->now[i]);
        }
    }
}

/* The next cell; false when all were. */
static bool next(hull *h) {
    for (int k = 0; k < h->list->angles; k++) {
        if (h->cut[k]) {
            h->cell[k]++;
            if (h->cell[k] < h->cells) {
                return true;
            }
            h->cell[k] = 0;
        }
    }
    return false;
}

static int count_cut(hull *h) {
    int cut = 0;
    for (int i = 0; i < h->list->count; i++) {
        const fixed_op *o = &h->list->op[i];
        for (int k = 0; k < h->list->angles && o->used && o->turns != NULL; k++) {
            h->cut[k] = h->cut[k] || o->turns[k] != 0;
        }
    }
    for (int k = 0; k < h->list->angles; k++) {
        cut += h->cut[k];
    }
    return cut;
}

static double all_cells(int cells, int cut) { return number_power(cells, cut); }

static bool enclose_all(hull *h) {
    for (int k = 0; k < h->list->angles; k++) {
        h->cell[k] = 0;
    }
    h->divides_zero = false;
    bool first = true;
    do {
        enclose(h, first);
        first = false;
    } while (goes_on(h) && !stops(h) && next(h));
    return !h->divides_zero;
}

/* Is it zero somewhere in the turn, wherever in their ranges the others are? Then no range keeps it from that. */
static bool divides_zero_anyway(hull *h) {
    h->at_middles = true;
    return !enclose_all(h);
}

static void say_zero(hull *h, const image *im, diags *errors) {
    diag_error(errors, im->at,
               divides_zero_anyway(h)
                   ? "turn angles go all the way round and have no range that could keep it from "
                     "that: choose --number float"
                   : "declare narrower ranges: range NAME = A .. B; or choose --number float",
               "a denominator of the equations of '%s' may be zero within the ranges", im->name);
}

int fixed_hull(fixed_list *list, const image *im, const fixed_leaves *leaves, bool bits_known,
               diags *errors) {
    hull h = {.list = list, .leaves = leaves, .bits_known = bits_known, .cells = CELLS};
    h.now = room(list->count, sizeof *h.now);
    h.angle = room(list->angles, sizeof *h.angle);
    h.cell = room(list->angles, sizeof *h.cell);
    h.cut = room(list->angles, sizeof *h.cut);
    const int cut = count_cut(&h);
    while (h.cells > CELLS_LEAST && all_cells(h.cells, cut) > CELLS_ALL) {
        h.cells /= 2;
    }
    bool good = enclose_all(&h);
    while (!good && !h.unbounded && cut > 0 && h.cells < CELLS_MOST &&
           all_cells(2 * h.cells, cut) <= CELLS_ALL_MOST) {
        h.cells *= 2;
        good = enclose_all(&h);
    }
    if (!good && !stops(&h)) {
        say_zero(&h, im, errors);
    }
    free(h.now);
    free(h.angle);
    free(h.cell);
    free(h.cut);
    return stops(&h)     ? FIXED_HULL_STOPPED
           : h.unbounded ? FIXED_HULL_UNBOUNDED
           : good        ? h.cells
                         : FIXED_HULL_ZERO;
}

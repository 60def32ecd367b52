/* fixed_list.c: the fixed-point copy of an image's list: ranges, binary points and shifts of its values. */
#include "host/fixed/fixed_list.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "host/base/alloc.h"
#include "host/engine/loop.h"
#include "host/number/functions.h"
#include "host/number/phase.h"
#include "host/os/system.h"

static enclosure twice(enclosure seen) {
    if (enclosure_is_zero(seen)) {
        return (enclosure){-1.0, 1.0};
    }
    if (seen.low == 0.0 || seen.high == 0.0) {
        /* the quantity began at zero, and may move in either direction */
        return (enclosure){-2.0 * enclosure_size(seen), 2.0 * enclosure_size(seen)};
    }
    return (enclosure){seen.low < 0.0 ? 2.0 * seen.low : 0.5 * seen.low,
                       seen.high > 0.0 ? 2.0 * seen.high : 0.5 * seen.high};
}

typedef struct looking {
    const image *image;
    void *run;
    enclosure *seen;
    bool progress;
} looking;

static bool see(void *of, uint64_t step) {
    const looking *at = of;
    double angle_rad[IMAGE_COMPONENTS_MAX];
    double real[2 * IMAGE_COMPONENTS_MAX];
    if (at->progress && (step & 0x3fffU) == 0x3fffU) {
        fprintf(stderr, "\rmeasuring ranges in double: %5.1f %%",
                100.0 * (double)step / (double)at->image->steps);
    }
    engine_double.state(at->run, angle_rad, real);
    for (int i = 0; i < at->image->reals; i++) {
        const enclosure now = enclosure_of(real[i]);
        at->seen[i] = step == 0 ? now : enclosure_hull(at->seen[i], now);
    }
    return true;
}

static bool look(const image *im, enclosure *seen, bool progress, diags *errors) {
    void *run = engine_double.start(im);
    looking at = {im, run, seen, progress};
    const loop l = {.kind = &engine_double, .run = run, .steps = im->steps, .see = see, .of = &at};
    wh_status status;
    (void)loop_run(&l, &status);
    if (progress) {
        fputs("\r                                      \r", stderr);
    }
    engine_double.stop(run);
    if (status != WH_OK) {
        diag_error(errors, im->at, "declare the ranges: range NAME = A .. B",
                   "the run of '%s' in double, from which ranges are taken, diverged", im->name);
    }
    return status == WH_OK && !interrupted;
}

bool fixed_ranges(const image *im, enclosure *range, bool progress, diags *errors) {
    bool all = true;
    for (int i = 0; i < im->reals; i++) {
        all = all && im->range[i].declared;
    }
    if (!all && !look(im, range, progress, errors)) {
        return false;
    }
    for (int i = 0; i < im->reals + im->inputs; i++) {
        const image_range *r = &im->range[i];
        range[i] = r->declared     ? (enclosure){r->low, r->high}
                   : i < im->reals ? twice(range[i])
                                   : twice(enclosure_of(im->input[i - im->reals].value));
    }
    return true;
}

/* === binary points and shifts ================================================================= */

enum { BITS_LEAST = -60, BITS_MOST = 90 }; /* limits that no binary point reaches in practice */
#define ROUNDED (1.0 - 0x1p-40)            /* a size just above 2^n counts as less than 2^n */

int fixed_point_of(double size, int digits) {
    int exponent;
    if (number_split(ROUNDED * size, &exponent) == 0.0) {
        return digits;
    }
    const int bits = digits - exponent;
    return bits > BITS_MOST ? BITS_MOST : bits < BITS_LEAST ? BITS_LEAST : bits;
}

/* Returns the largest absolute value of an operation's integer. */
static double units(const fixed_op *o) { return number_scaled(enclosure_size(o->range), o->bits); }

static int exponent_of(double value) {
    int exponent;
    (void)number_split(value, &exponent);
    return exponent;
}

static int least(int a, int b) { return a < b ? a : b; }
static int most(int a, int b) { return a > b ? a : b; }

static int product_bits(const fixed_list *l, const fixed_op *o) {
    const double size = enclosure_size(l->op[o->a.op].range) * enclosure_size(l->op[o->b.op].range);
    return fixed_point_of(size, FIXED_DIGITS);
}

/* Returns the digits after the point of a sum or comparison: at most `bits`, and no more than the finer operand has. */
static int sum_bits(const fixed_list *l, const fixed_op *o, int bits) {
    const fixed_op *part[] = {&l->op[o->a.op], &l->op[o->b.op]};
    const bool compares = o->code == FIXED_LEAST || o->code == FIXED_MOST;
    int finest = BITS_LEAST;
    for (int k = 0; k < 2; k++) {
        const bool constant = part[k]->code == FIXED_CONSTANT;
        if (constant || compares) {
            bits = least(bits, fixed_point_of(enclosure_size(part[k]->range), FIXED_DIGITS));
        }
        finest = constant ? finest : most(finest, part[k]->bits);
    }
    return finest == BITS_LEAST ? bits : least(bits, finest);
}

static void choose(const fixed_list *l, fixed_op *o, int digits) {
    const int bits = fixed_point_of(enclosure_size(o->range), digits);
    switch (o->code) {
    case FIXED_LINEAR:
    case FIXED_RATE:
    case FIXED_INPUT: return; /* the caller has set the bits of leaves */
    case FIXED_PHASE: o->bits = 0; return;
    case FIXED_SINE:
    case FIXED_COSINE: o->bits = 30; return;
    case FIXED_PRODUCT: o->bits = least(bits, product_bits(l, o)); return;
    case FIXED_SUM:
    case FIXED_DIFFERENCE:
    case FIXED_LEAST:
    case FIXED_MOST: o->bits = sum_bits(l, o, bits); return;
    case FIXED_SAME:
        o->bits = least(bits, l->op[o->a.op].bits - (exponent_of(o->value) - 1));
        return;
    case FIXED_ABS: o->bits = least(bits, l->op[o->a.op].bits); return;
    case FIXED_SIGN: o->bits = FIXED_DIGITS - 1; return;
    case FIXED_CONSTANT:
    case FIXED_QUOTIENT: o->bits = bits; return;
    }
}

/* Raises wanted[i] to the digits of operand i that `o` uses: a sum or comparison uses at most o->bits. */
static void request(int *wanted, int i, const fixed_op *o) {
    const bool adds = o->code == FIXED_SUM || o->code == FIXED_DIFFERENCE ||
                      o->code == FIXED_LEAST || o->code == FIXED_MOST;
    const int bits = adds ? o->bits : BITS_MOST;
    wanted[i] = most(wanted[i], bits);
}

/* Removes digits that no later operation uses, so that a value is rounded once, not twice. */
static void lower(fixed_list *l) {
    int *wanted = alloc(l->count, sizeof *wanted);
    for (int i = 0; i < l->count; i++) {
        wanted[i] = BITS_LEAST;
    }
    for (int i = 0; i < l->results; i++) {
        wanted[l->result[i]] = BITS_MOST;
    }
    for (int i = l->count - 1; i >= 0; i--) {
        fixed_op *o = &l->op[i];
        if (!o->used) {
            continue;
        }
        if (o->code == FIXED_PRODUCT || o->code == FIXED_QUOTIENT || o->code == FIXED_SUM ||
            o->code == FIXED_DIFFERENCE) {
            o->bits = least(o->bits, wanted[i]);
        }
        if (o->a.op >= 0) {
            request(wanted, o->a.op, o);
        }
        if (o->b.op >= 0) {
            request(wanted, o->b.op, o);
        }
    }
    free(wanted);
}

static int32_t whole(double value, int bits) {
    return (int32_t)number_nearest(number_scaled(value, bits));
}

#define MARGIN 1e-6 /* widens a denominator's range by this share */

/* Aligns an operand to `bits` digits after the point. */
static void align(const fixed_list *l, fixed_operand *operand, int bits) {
    const fixed_op *from = &l->op[operand->op];
    if (from->code == FIXED_CONSTANT) {
        operand->number = whole(from->value, bits);
        operand->shift = 0;
    } else {
        operand->shift = from->bits - bits;
    }
}

/* Returns the largest left shift after which an integer of at most `size` fits into 31 binary digits. */
static int left_of(double size) { return 31 - exponent_of(size + 1.0); }

/* a_left and b_left limit the left shifts of the operands a and b. */
static bool shift_product(fixed_op *o, int a_bits, int a_left, int b_bits, int b_left) {
    for (; o->bits > BITS_LEAST; o->bits--) {
        const int by = a_bits + b_bits - o->bits - 32;
        const int short_of = by >= 1 ? 0 : 1 - by;
        const int more = least(short_of, most(a_left, 0));
        o->a.shift = more;
        o->b.shift = short_of - more;
        o->by = by + short_of;
        if (o->b.shift <= b_left) {
            return true;
        }
    }
    return false;
}

int fixed_factor_bits(double value) {
    const int bits = fixed_point_of(fabs(value), 31);
    return number_nearest(number_scaled(fabs(value), bits)) >= 2147483648.0 ? bits - 1 : bits;
}

static bool finish_product(const fixed_list *l, fixed_op *o) {
    const fixed_op *a = &l->op[o->a.op];
    const fixed_op *b = &l->op[o->b.op];
    const bool constant = a->code == FIXED_CONSTANT;
    const int a_bits = constant ? fixed_factor_bits(a->value) : a->bits;
    const int a_left = constant ? 0 : left_of(units(a));
    if (constant) {
        o->a.number = whole(a->value, a_bits);
    }
    return shift_product(o, a_bits, a_left, b->bits, left_of(units(b)));
}

static bool finish_quotient(const fixed_list *l, fixed_op *o) {
    const fixed_op *a = &l->op[o->a.op];
    const fixed_op *b = &l->op[o->b.op];
    const bool constant = a->code == FIXED_CONSTANT;
    const enclosure size = enclosure_call(FN_ABS, b->range, enclosure_of(0.0));
    const int smallest = exponent_of(number_scaled((1.0 - MARGIN) * size.low, b->bits));
    const int largest = exponent_of(number_scaled((1.0 + MARGIN) * size.high, b->bits));
    if (b->code == FIXED_CONSTANT || smallest < 1) {
        return false;
    }
    o->negated = b->range.high < 0.0;
    o->zeros = 32 - largest;
    o->spread = largest - smallest;
    const int room = o->spread < 15 ? o->spread : 15;
    const int a_bits = constant ? fixed_point_of(fabs(a->value), 30 - room) : a->bits;
    const int a_left = constant ? room : left_of(units(a));
    const bool good = shift_product(o, a_bits, a_left, 61 - b->bits - (32 - smallest), 0);
    o->follows = a_left >= o->spread;
    if (o->follows) {
        const int more = most(o->spread - o->a.shift, 0);
        o->a.shift += more - o->spread;
        o->by += more;
    } else {
        o->by += o->spread;
    }
    if (constant) {
        o->a.number = whole(a->value, a_bits);
    }
    return good;
}

static bool finish(const fixed_list *l, fixed_op *o) {
    switch (o->code) {
    case FIXED_CONSTANT: o->a.number = whole(o->value, o->bits); return true;
    case FIXED_SUM:
    case FIXED_DIFFERENCE:
    case FIXED_LEAST:
    case FIXED_MOST:
        align(l, &o->a, o->bits);
        align(l, &o->b, o->bits);
        return true;
    case FIXED_SAME: align(l, &o->a, o->bits + (exponent_of(o->value) - 1)); return true;
    case FIXED_ABS: align(l, &o->a, o->bits); return true;
    case FIXED_PRODUCT: return finish_product(l, o);
    case FIXED_QUOTIENT: return finish_quotient(l, o);
    case FIXED_LINEAR:
    case FIXED_RATE:
    case FIXED_INPUT:
    case FIXED_PHASE:
    case FIXED_SINE:
    case FIXED_COSINE:
    case FIXED_SIGN: break;
    }
    return true;
}

bool fixed_is_result(const fixed_list *l, int i) {
    for (int k = 0; k < l->results; k++) {
        if (l->result[k] == i) {
            return true;
        }
    }
    return false;
}

/* Has |b| as many leading zeros as the quotient assumes? */
static bool has_zeros(const fixed_op *o, const fixed_op *b) {
    const enclosure size = enclosure_call(FN_ABS, b->range, enclosure_of(0.0));
    const int smallest = exponent_of(number_scaled(size.low, b->bits));
    const int largest = exponent_of(number_scaled(size.high, b->bits));
    return largest <= 32 - o->zeros && smallest >= 32 - o->zeros - o->spread;
}

bool fixed_fits(const fixed_list *l) {
    for (int i = 0; i < l->count; i++) {
        const fixed_op *o = &l->op[i];
        const fixed_op *b = o->b.op >= 0 ? &l->op[o->b.op] : NULL;
        if (!o->used || o->code == FIXED_CONSTANT || o->code == FIXED_PHASE) {
            continue;
        }
        if (!(units(o) <= 1073741824.0 + 64.0)) {
            return false;
        }
        if (o->code == FIXED_QUOTIENT && (b == NULL || !has_zeros(o, b))) {
            return false;
        }
    }
    return true;
}

static int digits_of(const fixed_list *l, int i) {
    const bool sums = l->op[i].code == FIXED_SUM || l->op[i].code == FIXED_DIFFERENCE;
    return fixed_is_result(l, i) ? FIXED_RESULT_DIGITS : sums ? FIXED_KEPT_DIGITS : FIXED_DIGITS;
}

bool fixed_bits(fixed_list *l, const image *im, diags *errors) {
    bool good = true;
    for (int i = 0; i < l->count; i++) {
        if (l->op[i].used) {
            choose(l, &l->op[i], digits_of(l, i));
        }
    }
    lower(l);
    for (int i = 0; i < l->count && good; i++) {
        good = !l->op[i].used || finish(l, &l->op[i]);
    }
    if (!good) {
        diag_error(errors, im->at,
                   "declare ranges close to the run's values: range NAME = A .. B; or choose "
                   "--number float",
                   "within the ranges, values in the equations of '%s' do not fit into 32 bits",
                   im->name);
    }
    return good;
}

/* === ranges of values ========================================================================= */
/* The turn angles are divided into cells, because over a whole turn a denominator's interval often contains zero. */

enum {
    CELLS_LEAST = 4,
    CELLS = 64,
    CELLS_MOST = 1024,
    CELLS_ALL = 1 << 18,
    CELLS_ALL_MOST = 1 << 20
};

#define TURN 6.283185307179586477
/* Error bounds of the core's sines and reciprocals (tests/core/test_fixed.c), with a margin. */
#define SINE_OFF 5e-8
#define QUOTIENT_OFF 8e-9

typedef struct hull {
    fixed_list *list;
    const fixed_leaves *leaves;
    bool bits_known;
    enclosure *now;   /* [count] ranges in the current cell */
    enclosure *angle; /* [angles] */
    int *cell;        /* [angles] */
    bool *cut;        /* [angles] true if a phase depends on the angle */
    int cells;        /* number of cells per turn */
    bool at_middles;  /* true: linear positions, rates and inputs are at mid-range */
    bool divides_zero;
    bool unbounded;
} hull;

static enclosure phase_of(const hull *h, const fixed_op *o) {
    enclosure sum = {o->offset_rad, o->offset_rad};
    for (int k = 0; k < h->list->angles && o->turns != NULL; k++) {
        const double turns = o->turns[k];
        if (turns != 0.0) {
            sum = enclosure_add(sum, enclosure_mul((enclosure){turns, turns}, h->angle[k]));
        }
    }
    return sum;
}

static enclosure leaf_of(const hull *h, enclosure range) {
    const double middle = 0.5 * (range.low + range.high);
    return h->at_middles ? (enclosure){middle, middle} : range;
}

static enclosure sines(enclosure a, double ahead_rad) {
    a = (enclosure){a.low + ahead_rad, a.high + ahead_rad};
    const double one = number_sine(a.low);
    const double other = number_sine(a.high);
    enclosure made = {enclosure_lesser(one, other), enclosure_larger(one, other)};
    for (int side = -1; side <= 1; side += 2) { /* extremes: at +-0.25 turn plus whole turns */
        const double at = side * 0.25 * TURN;
        if (at + TURN * number_ceiling((a.low - at) / TURN) <= a.high) {
            *(side > 0 ? &made.high : &made.low) = side;
        }
    }
    return made;
}

static enclosure value_of(hull *h, const fixed_op *o) {
    const enclosure none = {0.0, 0.0};
    const enclosure a = o->a.op >= 0 ? h->now[o->a.op] : none;
    const enclosure b = o->b.op >= 0 ? h->now[o->b.op] : none;
    switch (o->code) {
    case FIXED_CONSTANT: return (enclosure){o->value, o->value};
    case FIXED_LINEAR: return leaf_of(h, h->leaves->linear[o->index]);
    case FIXED_RATE: return leaf_of(h, h->leaves->rate[o->index]);
    case FIXED_INPUT: return leaf_of(h, h->leaves->input[o->index]);
    case FIXED_PHASE: return phase_of(h, o);
    case FIXED_SINE: return enclosure_widened(sines(a, 0.0), SINE_OFF);
    case FIXED_COSINE: return enclosure_widened(sines(a, 0.25 * TURN), SINE_OFF);
    case FIXED_SUM: return enclosure_add(a, b);
    case FIXED_DIFFERENCE: return enclosure_sub(a, b);
    case FIXED_PRODUCT: return o->a.op == o->b.op ? enclosure_square(a) : enclosure_mul(a, b);
    case FIXED_SAME: return enclosure_mul(a, (enclosure){o->value, o->value});
    case FIXED_ABS: return enclosure_call(FN_ABS, a, enclosure_of(0.0));
    case FIXED_SIGN: return (enclosure){a.low > 0.0 ? 1.0 : -1.0, a.high < 0.0 ? -1.0 : 1.0};
    case FIXED_LEAST: return enclosure_call(FN_MIN, a, b);
    case FIXED_MOST: return enclosure_call(FN_MAX, a, b);
    case FIXED_QUOTIENT:
        if (enclosure_has(b, 0.0)) {
            h->divides_zero = true;
            return none;
        }
        const enclosure q = enclosure_div(a, b);
        return enclosure_widened(q, QUOTIENT_OFF * enclosure_size(q));
    }
    return none;
}

static bool goes_on(const hull *h) { return !h->divides_zero && !h->unbounded; }

static void enclose(hull *h, bool first) {
    fixed_list *l = h->list;
    for (int k = 0; k < l->angles; k++) {
        const double width = TURN / h->cells;
        h->angle[k] = (enclosure){h->cell[k] * width, (h->cell[k] + 1) * width};
    }
    for (int i = 0; i < l->count && goes_on(h); i++) {
        fixed_op *o = &l->op[i];
        if (o->used) {
            /* the margin for round-off: four units of the last digit */
            const bool rounds = h->bits_known && o->code > FIXED_PHASE;
            h->now[i] =
                enclosure_widened(value_of(h, o), rounds ? number_scaled(4.0, -o->bits) : 0.0);
            h->unbounded =
                !(h->now[i].low >= -FIXED_SIZE_MOST && h->now[i].high <= FIXED_SIZE_MOST);
            o->range = first ? h->now[i] : enclosure_hull(o->range, h->now[i]);
        }
    }
}

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
    } while (goes_on(h) && !interrupted && next(h));
    return !h->divides_zero;
}

static void say_zero(hull *h, const image *im, diags *errors) {
    h->at_middles = true;
    diag_error(
        errors, im->at,
        !enclose_all(h)
            ? "choose --number float: a turn angle takes all values, so no range can exclude "
              "zero"
            : "declare narrower ranges: range NAME = A .. B; or choose --number float",
        "a denominator of the equations of '%s' may be zero within the ranges", im->name);
}

int fixed_hull(fixed_list *list, const image *im, const fixed_leaves *leaves, bool bits_known,
               diags *errors) {
    hull h = {.list = list, .leaves = leaves, .bits_known = bits_known, .cells = CELLS};
    h.now = alloc(list->count, sizeof *h.now);
    h.angle = alloc(list->angles, sizeof *h.angle);
    h.cell = alloc(list->angles, sizeof *h.cell);
    h.cut = alloc(list->angles, sizeof *h.cut);
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
    if (!good && !interrupted) {
        say_zero(&h, im, errors);
    }
    free(h.now);
    free(h.angle);
    free(h.cell);
    free(h.cut);
    return interrupted   ? FIXED_HULL_STOPPED
           : h.unbounded ? FIXED_HULL_UNBOUNDED
           : good        ? h.cells
                         : FIXED_HULL_ZERO;
}

/* === the list ================================================================================= */

static int enter(fixed_list *l, fixed_op o) {
    l->op = alloc_more(l->op, l->count + 1, sizeof *l->op);
    l->op[l->count] = o;
    return l->count++;
}

static int enter_constant(fixed_list *l, double value) {
    return enter(l, (fixed_op){.code = FIXED_CONSTANT, .value = value});
}

static bool is_constant(const fixed_list *l, int i) { return l->op[i].code == FIXED_CONSTANT; }

static int enter_product(fixed_list *l, int a, int b) {
    if (is_constant(l, b)) { /* the constant becomes the first operand */
        const int swap = a;
        a = b;
        b = swap;
    }
    const double value = l->op[a].value;
    int exponent;
    if (is_constant(l, a) && fabs(number_split(value, &exponent)) == 0.5) { /* a power of two */
        return enter(l, (fixed_op){.code = FIXED_SAME,
                                   .a = {.op = b},
                                   .b = {.op = -1},
                                   .value = value,
                                   .negated = value < 0.0});
    }
    return enter(l, (fixed_op){.code = FIXED_PRODUCT, .a = {.op = a}, .b = {.op = b}});
}

/* If *o has no fixed-point form, sets *lacks to the operation's name. */
static fixed_op copy_of(const op *o, const int *number, const char **lacks) {
    fixed_op made = {.code = FIXED_CONSTANT, .a = {.op = -1}, .b = {.op = -1}};
    switch (o->code) {
    case OP_CONSTANT: made.value = o->value; return made;
    case OP_LINEAR: made.code = FIXED_LINEAR; break;
    case OP_RATE: made.code = FIXED_RATE; break;
    case OP_INPUT: made.code = FIXED_INPUT; break;
    case OP_PHASE:
        made.code = FIXED_PHASE;
        made.turns = o->turns;
        made.offset_rad = o->value;
        made.offset = phase_of_constant(o->value);
        *lacks =
            o->b >= 0 || o->parts != NULL ? "the sine of a quantity other than a turn angle" : NULL;
        return made;
    case OP_SIN: made.code = FIXED_SINE; break;
    case OP_COS: made.code = FIXED_COSINE; break;
    case OP_ADD: made.code = FIXED_SUM; break;
    case OP_SUB: made.code = FIXED_DIFFERENCE; break;
    case OP_DIV: made.code = FIXED_QUOTIENT; break;
    case OP_NEG:
        made.code = FIXED_SAME;
        made.value = -1.0;
        made.negated = true;
        break;
    case OP_ABS: made.code = FIXED_ABS; break;
    case OP_SIGN: made.code = FIXED_SIGN; break;
    case OP_MIN: made.code = FIXED_LEAST; break;
    case OP_MAX: made.code = FIXED_MOST; break;
    case OP_MUL: return made; /* see enter_product() */
    case OP_SQRT: *lacks = "a square root"; return made;
    case OP_POW: *lacks = "a power"; return made;
    case OP_CALL: *lacks = function_name(o->function); return made;
    case OP_CELL:
    case OP_LINE:
    case OP_CUBIC: *lacks = "a table"; return made;
    case OP_ACCEL:
    case OP_TIME:
    case OP_RADIANS:
    case OP_NOISE: *lacks = "a value that exists only in records"; return made;
    }
    made.index = op_rows[o->code].kind == OP_IS_LEAF ? o->a : 0;
    int operand[2];
    const int operands = op_list_operands(o, operand);
    made.a.op = op_rows[o->code].kind == OP_IS_WAVE ? number[o->a]
                : operands > 0                      ? number[o->a]
                                                    : -1;
    made.b.op = operands > 1 ? number[o->b] : -1;
    return made;
}

/* Enters scale * (operation i). A constant factor of operation i is merged with `scale`. */
static int enter_scaled(fixed_list *l, int i, double scale) {
    const fixed_op *o = &l->op[i];
    double factor = scale;
    int rest = i;
    if (o->code == FIXED_CONSTANT) {
        return enter_constant(l, scale * o->value);
    }
    if (o->code == FIXED_PRODUCT && is_constant(l, o->a.op)) {
        factor = scale * l->op[o->a.op].value;
        rest = o->b.op;
    } else if (o->code == FIXED_SAME) {
        factor = scale * o->value;
        rest = o->a.op;
    }
    const int constant = enter_constant(l, factor);
    return enter_product(l, constant, rest);
}

static void mark(fixed_list *l) {
    for (int i = 0; i < l->results; i++) {
        l->op[l->result[i]].used = true;
    }
    for (int i = l->count - 1; i >= 0; i--) {
        const fixed_op *o = &l->op[i];
        if (o->used && o->a.op >= 0) {
            l->op[o->a.op].used = true;
        }
        if (o->used && o->b.op >= 0) {
            l->op[o->b.op].used = true;
        }
    }
}

fixed_list *fixed_list_make(const image *im, const double *scale, diags *errors) {
    const op_list *t = im->list[IMAGE_STEP];
    const char *lacks = NULL;
    fixed_list *l = alloc(1, sizeof *l);
    int *number = alloc(t->count, sizeof *number);
    l->angles = im->angles;
    for (int i = 0; i < t->count && lacks == NULL; i++) {
        const op *o = &t->ops[i];
        number[i] = o->code == OP_MUL ? enter_product(l, number[o->a], number[o->b])
                                      : enter(l, copy_of(o, number, &lacks));
    }
    if (lacks != NULL) {
        diag_error(errors, im->at, "choose --number float",
                   "the equations of '%s' contain %s, which has no fixed-point form", im->name,
                   lacks);
        free(number);
        fixed_list_free(l);
        return NULL;
    }
    l->results = t->results;
    l->result = alloc(t->results, sizeof *l->result);
    for (int i = 0; i < t->results; i++) {
        l->result[i] = enter_scaled(l, number[t->result[i]], scale[i]);
    }
    free(number);
    mark(l);
    return l;
}

void fixed_list_free(fixed_list *list) {
    if (list != NULL) {
        free(list->op);
        free(list->result);
        free(list);
    }
}

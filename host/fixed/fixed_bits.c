/* fixed_bits.c: where the binary point of each value stands, and the shifts that follow. */
#include <math.h>

#include "fixed_list.h"
#include <stdlib.h>

#include "host/base/room.h"
#include "host/number/functions.h"

/* Points beyond these are for numbers that no mechanism has. */
enum { BITS_LEAST = -60, BITS_MOST = 90 };

int fixed_point_of(double size, int digits) {
    int exponent; /* size <= 2^exponent */
    const double part = number_split(size, &exponent);
    if (size == 0.0) {
        return digits;
    }
    exponent -= part == 0.5 ? 1 : 0;
    const int bits = digits - exponent;
    return bits > BITS_MOST ? BITS_MOST : bits < BITS_LEAST ? BITS_LEAST : bits;
}

/* The largest number that stands for it, as a double. */
static double units(const fixed_op *o) { return number_scaled(interval_size(o->range), o->bits); }

static int least(int a, int b) { return a < b ? a : b; }
static int most(int a, int b) { return a > b ? a : b; }

/* --- points ------------------------------------------------------------------------------------------*/

/* What the operands of a product can make at most has room, too: then shifts to the left do. */
static int product_bits(const fixed_list *l, const fixed_op *o) {
    const double size = interval_size(l->op[o->a.op].range) * interval_size(l->op[o->b.op].range);
    return fixed_point_of(size, FIXED_DIGITS);
}

/* No digits that neither part has; and room for a constant, and for what is compared. */
static int sum_bits(const fixed_list *l, const fixed_op *o, int bits) {
    const fixed_op *part[] = {&l->op[o->a.op], &l->op[o->b.op]};
    const bool compares = o->code == FIXED_LEAST || o->code == FIXED_MOST;
    int finest = BITS_LEAST;
    for (int k = 0; k < 2; k++) {
        const bool constant = part[k]->code == FIXED_CONSTANT;
        if (constant || compares) {
            bits = least(bits, fixed_point_of(interval_size(part[k]->range), FIXED_DIGITS));
        }
        finest = constant ? finest : most(finest, part[k]->bits);
    }
    return finest == BITS_LEAST ? bits : least(bits, finest);
}

static void choose(const fixed_list *l, fixed_op *o, int digits) {
    const int bits = fixed_point_of(interval_size(o->range), digits);
    switch (o->code) {
    case FIXED_LINEAR:
    case FIXED_RATE:
    case FIXED_INPUT: return; /* theirs */
    case FIXED_PHASE: o->bits = 0; return;
    case FIXED_SINE:
    case FIXED_COSINE: o->bits = 30; return;
    case FIXED_PRODUCT: o->bits = least(bits, product_bits(l, o)); return;
    case FIXED_SUM:
    case FIXED_DIFFERENCE:
    case FIXED_LEAST:
    case FIXED_MOST: o->bits = sum_bits(l, o, bits); return;
    case FIXED_SAME: {
        int exponent;
        (void)number_split(o->value, &exponent);
        o->bits = least(bits, l->op[o->a.op].bits - (exponent - 1));
        return;
    }
    case FIXED_ABS: o->bits = least(bits, l->op[o->a.op].bits); return;
    case FIXED_SIGN: o->bits = FIXED_DIGITS - 1; return;
    case FIXED_CONSTANT:
    case FIXED_QUOTIENT: o->bits = bits; return;
    }
}

/* Digits of operation i that user o takes no part of: a product whose sum has fewer behind the point may have these. */
static void wish(const fixed_list *l, int *wanted, int i, const fixed_op *o) {
    const bool adds = o->code == FIXED_SUM || o->code == FIXED_DIFFERENCE ||
                      o->code == FIXED_LEAST || o->code == FIXED_MOST;
    const int bits = adds ? o->bits : BITS_MOST;
    (void)l;
    wanted[i] = most(wanted[i], bits);
}

/* Products and quotients round once by themselves: straight to what their sums take. */
static void lower(fixed_list *l) {
    int *wanted = room(l->count, sizeof *wanted);
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
            wish(l, wanted, o->a.op, o);
        }
        if (o->b.op >= 0) {
            wish(l, wanted, o->b.op, o);
        }
    }
    free(wanted);
}

/* --- shifts ------------------------------------------------------------------------------------------*/

static int32_t whole(double value, int bits) {
    return (int32_t)number_nearest(number_scaled(value, bits));
}

/* Of a denominator: more than rounding changes it. */
#define MARGIN 1e-6

/* An operand that is added: a constant at the result's point, else rounded to it. */
static void align(const fixed_list *l, fixed_operand *operand, int bits) {
    const fixed_op *from = &l->op[operand->op];
    if (from->code == FIXED_CONSTANT) {
        operand->number = whole(from->value, bits);
        operand->shift = 0;
    } else {
        operand->shift = from->bits - bits;
    }
}

/* Digits that may be put behind a number of so many units, which keeps within 31. */
static int left_of(double size) {
    int exponent;
    (void)number_split(size + 1.0, &exponent);
    return 31 - exponent;
}

/* Shifts of a product whose factors have `a_bits` and `b_bits` behind the point and room for a_left and b_left more: to
 * `bits`. False: there is no room. */
static bool shift_product(fixed_op *o, int a_bits, int a_left, int b_bits, int b_left) {
    const int by = a_bits + b_bits - o->bits - 32;
    const int short_of = by >= 1 ? 0 : 1 - by;
    const int more = least(short_of, most(a_left, 0));
    o->a.shift = more;
    o->b.shift = short_of - more;
    o->by = by + short_of;
    return o->b.shift <= b_left;
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
    const int b_left = left_of(units(b));
    while (!shift_product(o, a_bits, a_left, b->bits, b_left) && o->bits > BITS_LEAST) {
        o->bits--;
    }
    if (constant) {
        o->a.number = whole(a->value, a_bits);
    }
    return o->bits > BITS_LEAST;
}

static bool finish_quotient(const fixed_list *l, fixed_op *o) {
    const fixed_op *a = &l->op[o->a.op];
    const fixed_op *b = &l->op[o->b.op];
    const bool constant = a->code == FIXED_CONSTANT;
    const interval size = interval_abs(b->range);
    int smallest;
    int largest;
    (void)number_split(number_scaled((1.0 - MARGIN) * size.low, b->bits), &smallest);
    (void)number_split(number_scaled((1.0 + MARGIN) * size.high, b->bits), &largest);
    if (b->code == FIXED_CONSTANT || smallest < 1) {
        return false;
    }
    o->negated = b->range.high < 0.0;
    o->zeros = 32 - largest;
    o->spread = largest - smallest;
    const int room = o->spread < 15 ? o->spread : 15;
    const int a_bits = constant ? fixed_point_of(fabs(a->value), 30 - room) : a->bits;
    const int a_left = constant ? room : left_of(units(a));
    while (!shift_product(o, a_bits, a_left, 61 - b->bits - (32 - smallest), 0) &&
           o->bits > BITS_LEAST) {
        o->bits--;
    }
    o->follows = a_left >= o->spread;
    if (o->follows) { /* shifts as they are where there are the least zeros */
        const int more = most(o->spread - o->a.shift, 0);
        o->a.shift += more - o->spread;
        o->by += more;
    } else {
        o->by += o->spread;
    }
    if (constant) {
        o->a.number = whole(a->value, a_bits);
    }
    return o->bits > BITS_LEAST;
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
    case FIXED_SAME: {
        int exponent;
        (void)number_split(o->value, &exponent);
        align(l, &o->a, o->bits + (exponent - 1));
        return true;
    }
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

static bool is_result(const fixed_list *l, int i) {
    for (int k = 0; k < l->results; k++) {
        if (l->result[k] == i) {
            return true;
        }
    }
    return false;
}

/* Are there as many zeros in front of |b| as the quotient takes there to be? */
static bool has_zeros(const fixed_op *o, const fixed_op *b) {
    const interval size = interval_abs(b->range);
    int smallest;
    int largest;
    (void)number_split(number_scaled(size.low, b->bits), &smallest);
    (void)number_split(number_scaled(size.high, b->bits), &largest);
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

/* Sums have room for one more than products. */
static int digits_of(const fixed_list *l, int i) {
    const bool sums = l->op[i].code == FIXED_SUM || l->op[i].code == FIXED_DIFFERENCE;
    return is_result(l, i) ? FIXED_RESULT_DIGITS : sums ? FIXED_KEPT_DIGITS : FIXED_DIGITS;
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
                   "declare others, closer in size to what the run does: range NAME = A .. B; or "
                   "choose --number float",
                   "the equations of '%s' have values with no room in 32 bits within the ranges",
                   im->name);
    }
    return good;
}

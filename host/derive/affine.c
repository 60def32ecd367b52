/* affine.c: propagation of affine coefficients through an operation list. */
#include "affine.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/number/folding.h"

/* A sum below this part of its addends counts as zero, as in host/algebra. Decimal parameters must leave no spurious
 * spring between two masses that move together. */
#define GHOST 1e-14

int affine_states(const image *im) { return im->angles + im->reals; }
int affine_columns(const image *im) { return affine_states(im) + im->inputs + 1; }

/* The column of a leaf, or -1 if it is neither state nor input. */
static int column_of(const image *im, const op *o) {
    if (o->code == OP_LINEAR) {
        return im->angles + o->a;
    }
    if (o->code == OP_RATE) { /* after all positions, those of angles included */
        return im->coordinates + o->a;
    }
    return o->code == OP_INPUT ? affine_states(im) + o->a : -1;
}

static bool is_constant(const twofold *c, int columns) {
    bool constant = true;
    for (int i = 0; i < columns - 1; i++) {
        constant = constant && double_double_is_zero(c[i]);
    }
    return constant;
}

static twofold sum(twofold a, twofold b) {
    const twofold both = double_double_add(a, b);
    return folding_cancels(both.high, fabs(a.high) + fabs(b.high), GHOST) ? double_double_of(0.0)
                                                                          : both;
}

static void add(const twofold *a, const twofold *b, double sign, int columns, twofold *to) {
    for (int i = 0; i < columns; i++) {
        to[i] = sum(a[i], double_double_scale(b[i], sign));
    }
}

static void multiply(const twofold *a, twofold factor, int columns, twofold *to) {
    for (int i = 0; i < columns; i++) {
        to[i] = double_double_mul(a[i], factor);
    }
}

/* The coefficients of operation o, from those of all earlier ones. False if it is not affine. */
static bool step(const image *im, const op *o, const twofold *all, twofold *to) {
    const int columns = affine_columns(im);
    const twofold *a = all + (ptrdiff_t)(o->a >= 0 ? o->a : 0) * columns;
    const twofold *b = all + (ptrdiff_t)(o->b >= 0 ? o->b : 0) * columns;
    const int last = columns - 1;
    switch (o->code) {
    case OP_CONSTANT: to[last] = double_double_of(o->value); return true;
    case OP_LINEAR:
    case OP_RATE:
    case OP_INPUT: to[column_of(im, o)] = double_double_of(1.0); return true;
    case OP_ADD: add(a, b, 1.0, columns, to); return true;
    case OP_SUB: add(a, b, -1.0, columns, to); return true;
    case OP_NEG: multiply(a, double_double_of(-1.0), columns, to); return true;
    case OP_MUL:
        if (is_constant(a, columns)) {
            multiply(b, a[last], columns, to);
        } else if (is_constant(b, columns)) {
            multiply(a, b[last], columns, to);
        } else {
            return false;
        }
        return true;
    case OP_DIV:
        if (!is_constant(b, columns)) {
            return false;
        }
        for (int i = 0; i < columns; i++) {
            to[i] = double_double_div(a[i], b[last]);
        }
        return true;
    case OP_PHASE:
    case OP_CELL: return true; /* operations on them are not affine */
    case OP_SIN:
    case OP_COS:
    case OP_LINE:
    case OP_CUBIC:
    case OP_SQRT:
    case OP_ABS:
    case OP_SIGN:
    case OP_MIN:
    case OP_MAX:
    case OP_CALL:
    case OP_POW:
    case OP_ACCEL:
    case OP_TIME:
    case OP_RADIANS:
    case OP_NOISE: return false;
    }
    return false;
}

int affine_rates(const image *im, twofold *rates) {
    const op_list *t = im->list[IMAGE_STEP];
    const int columns = affine_columns(im);
    const size_t row = (size_t)columns * sizeof *rates;
    twofold *all = alloc((int64_t)t->count * columns, sizeof *all);
    int bad = -1;
    for (int i = 0; i < t->count && bad < 0; i++) {
        bad = step(im, &t->ops[i], all, all + (ptrdiff_t)i * columns) ? -1 : i;
    }
    if (bad < 0) {
        const int positions = im->form == WH_SECOND_ORDER ? im->coordinates : 0;
        memset(rates, 0, (size_t)affine_states(im) * row);
        for (int i = 0; i < positions; i++) {
            rates[i * columns + im->coordinates + i] = double_double_of(1.0);
        }
        for (int i = 0; i < t->results; i++) {
            memcpy(rates + (ptrdiff_t)(positions + i) * columns,
                   all + (ptrdiff_t)t->result[i] * columns, row);
        }
    }
    free(all);
    return bad;
}

void affine_takes(const image *im, int number, bool *taking) {
    const op_list *t = im->list[IMAGE_STEP];
    bool *needed = alloc(number + 1, sizeof *needed);
    int operand[2];
    needed[number] = true;
    for (int i = number; i >= 0; i--) {
        const op *o = &t->ops[i];
        if (!needed[i]) {
            continue;
        }
        for (int k = op_list_operands(o, operand); k > 0; k--) {
            needed[operand[k - 1]] = true;
        }
        const int column = column_of(im, o);
        if (column >= 0) {
            taking[column] = true;
        }
        for (int k = 0; k < t->angles && o->turns != NULL; k++) {
            taking[k] = taking[k] || o->turns[k] != 0;
        }
    }
    free(needed);
}

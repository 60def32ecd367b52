/* fixed_list.c: the copy of an image's list, with what a step multiplies its results by. */
#include "fixed_list.h"

#include <stdlib.h>

#include "host/base/room.h"
#include "host/number/functions.h"
#include "host/number/phase.h"

/* --- what has no fixed form ------------------------------------------------------------------------*/

static const char *without_form(const op *o) {
    switch (o->code) {
    case OP_SQRT: return "a square root";
    case OP_POW: return "a power";
    case OP_CALL: return function_name(o->function);
    case OP_PHASE:
        return o->b >= 0 || o->parts != NULL ? "the sine of what is no turn angle" : NULL;
    case OP_CELL:
    case OP_LINE:
    case OP_CUBIC: return "a table";
    case OP_ACCEL:
    case OP_TIME:
    case OP_RADIANS:
    case OP_NOISE: return "what only records have";
    case OP_CONSTANT:
    case OP_LINEAR:
    case OP_RATE:
    case OP_INPUT:
    case OP_SIN:
    case OP_COS:
    case OP_ADD:
    case OP_SUB:
    case OP_MUL:
    case OP_DIV:
    case OP_NEG:
    case OP_ABS:
    case OP_SIGN:
    case OP_MIN:
    case OP_MAX: break;
    }
    return NULL;
}

static bool has_form(const image *im, const tape *t, diags *errors) {
    for (int i = 0; i < t->count; i++) {
        const char *what = without_form(&t->ops[i]);
        if (what != NULL) {
            diag_error(errors, im->at, "--number float has one",
                       "the equations of '%s' hold %s, which has no fixed-point form", im->name,
                       what);
            return false;
        }
    }
    return true;
}

/* --- the copy ----------------------------------------------------------------------------------------*/

static int enter(fixed_list *l, fixed_op o) {
    l->op = room_more(l->op, l->count + 1, sizeof *l->op);
    l->op[l->count] = o;
    return l->count++;
}

static int enter_constant(fixed_list *l, double value) {
    return enter(l, (fixed_op){.code = FIXED_CONSTANT, .value = value});
}

static bool is_constant(const fixed_list *l, int i) { return l->op[i].code == FIXED_CONSTANT; }

/* +-2^n? */
static bool is_power(double value) {
    int exponent;
    const double part = number_split(value, &exponent);
    return part == 0.5 || part == -0.5;
}

static int enter_product(fixed_list *l, int a, int b) {
    if (is_constant(l, b)) { /* in front */
        const int swap = a;
        a = b;
        b = swap;
    }
    const double value = l->op[a].value;
    if (is_constant(l, a) && is_power(value)) {
        return enter(l, (fixed_op){.code = FIXED_SAME,
                                   .a = {.op = b},
                                   .b = {.op = -1},
                                   .value = value,
                                   .negated = value < 0.0});
    }
    return enter(l, (fixed_op){.code = FIXED_PRODUCT, .a = {.op = a}, .b = {.op = b}});
}

static fixed_op copy_of(const tape *t, const op *o, const int *number) {
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
    case OP_MUL:
    case OP_SQRT:
    case OP_POW:
    case OP_CALL:
    case OP_CELL:
    case OP_LINE:
    case OP_CUBIC:
    case OP_ACCEL:
    case OP_TIME:
    case OP_RADIANS:
    case OP_NOISE: return made; /* has_form() */
    }
    made.index = op_rows[o->code].kind == OP_IS_LEAF ? o->a : 0;
    int operand[2];
    const int operands = tape_operands(o, operand);
    (void)t;
    made.a.op = op_rows[o->code].kind == OP_IS_WAVE ? number[o->a]
                : operands > 0                      ? number[o->a]
                                                    : -1;
    made.b.op = operands > 1 ? number[o->b] : -1;
    return made;
}

/* Number `value` (a constant) joined to the constant factor of what operation i computes, if it has one. */
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
    const tape *t = im->list[IMAGE_STEP];
    if (!has_form(im, t, errors)) {
        return NULL;
    }
    fixed_list *l = room(1, sizeof *l);
    int *number = room(t->count, sizeof *number);
    l->angles = im->angles;
    for (int i = 0; i < t->count; i++) {
        const op *o = &t->ops[i];
        number[i] = o->code == OP_MUL ? enter_product(l, number[o->a], number[o->b])
                                      : enter(l, copy_of(t, o, number));
    }
    l->results = t->results;
    l->result = room(t->results, sizeof *l->result);
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

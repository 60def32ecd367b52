/* tape_multiply.c: a list with its operations multiplied by numbers, and the same results. */
#include <math.h>
#include <stdlib.h>

#include "host/base/room.h"
#include "tape_gauge.h"

typedef struct multiplied {
    const tape *from;
    const double *times; /* [3 * from->count] */
    tape *to;
    int *made; /* [from->count] on `to`: times as large, but raw values as they are */
} multiplied;

bool tape_is_raw(const op *o) {
    switch (op_rows[o->code].kind) {
    case OP_IS_LEAF:
    case OP_IS_WAVE:
    case OP_IS_LOOKUP:
    case OP_IS_CALL: return true;
    case OP_IS_CONSTANT:
    case OP_IS_PHASE:
    case OP_IS_CELL:
    case OP_IS_UNARY:
    case OP_IS_BINARY: break;
    }
    return o->code == OP_SIGN || o->code == OP_POW;
}

/* A constant; where double's rounding alone keeps it from being a float, that float. */
static int constant(tape *t, double value) {
    const double nearest = (double)(float)value;
    return tape_constant(t, fabs(value - nearest) <= 1e-15 * fabs(value) ? nearest : value);
}

/* `times` operation i, for whoever takes it. */
static int taken(const multiplied *m, int i, double times) {
    const op *o = &m->from->ops[i];
    double number;
    if (o->code == OP_CONSTANT) {
        return constant(m->to, o->value * times);
    }
    if (o->code == OP_MUL && tape_is_constant(m->from, o->a, &number)) {
        return taken(m, o->b, number * times);
    }
    const double has = tape_is_raw(o) ? 1.0 : m->times[i];
    return tape_mul(m->to, constant(m->to, times / has), m->made[i]);
}

static int make_phase(const multiplied *m, const op *o) {
    double *multiple = room(m->from->angles, sizeof *multiple);
    for (int k = 0; k < m->from->angles; k++) {
        multiple[k] = (o->turns != NULL ? o->turns[k] : 0) + (o->parts != NULL ? o->parts[k] : 0.0);
    }
    const int radians = o->b >= 0 ? taken(m, o->b, 1.0) : -1;
    const int made = tape_phase(m->to, multiple, o->value, radians);
    free(multiple);
    return made;
}

/* How often an operand is taken: a raw value as that place of the operation says. */
static double times_of(const multiplied *m, int i, int which) {
    const op *o = &m->from->ops[i];
    const int operand = which == 0 ? o->a : o->b;
    return tape_is_raw(&m->from->ops[operand]) ? m->times[m->from->count + 2 * i + which]
                                               : m->times[operand];
}

/* A product or quotient of what is multiplied already, and what is left to multiply by. One call after the other, in the same
 * order everywhere. */
static int make_product(const multiplied *m, int i) {
    const op *o = &m->from->ops[i];
    const double a = times_of(m, i, 0);
    const double b = times_of(m, i, 1);
    const double wanted = m->times[i];
    if (o->code == OP_DIV && m->from->ops[o->a].code == OP_CONSTANT) {
        const int below = taken(m, o->b, b);
        return tape_div(m->to, taken(m, o->a, wanted * b), below);
    }
    const int x = taken(m, o->a, a);
    const int y = taken(m, o->b, b);
    const bool divides = o->code == OP_DIV;
    const int made = divides ? tape_div(m->to, x, y) : tape_mul(m->to, x, y);
    return tape_mul(m->to, constant(m->to, divides ? wanted * b / a : wanted / (a * b)), made);
}

/* Of two operands the second is entered first, by whatever compiler: arguments of one call have no order. */
static int make(const multiplied *m, int i) {
    const op *o = &m->from->ops[i];
    const double times = m->times[i];
    double number;
    int second;
    switch (o->code) {
    case OP_CONSTANT: return -1; /* made where it is taken */
    case OP_LINEAR:
    case OP_RATE:
    case OP_INPUT:
    case OP_ACCEL:
    case OP_TIME:
    case OP_RADIANS: return tape_leaf(m->to, o->code, o->a);
    case OP_NOISE: return tape_noise(m->to, (uint32_t)o->value);
    case OP_PHASE: return make_phase(m, o);
    case OP_SIN:
    case OP_COS: return tape_unary(m->to, o->code, m->made[o->a]);
    case OP_ADD:
        second = taken(m, o->b, times);
        return tape_add(m->to, taken(m, o->a, times), second);
    case OP_SUB:
        second = taken(m, o->b, times);
        return tape_sub(m->to, taken(m, o->a, times), second);
    case OP_MUL:
        return tape_is_constant(m->from, o->a, &number) ? -1 /* likewise */ : make_product(m, i);
    case OP_DIV: return make_product(m, i);
    case OP_NEG:
    case OP_ABS: return tape_unary(m->to, o->code, taken(m, o->a, times));
    case OP_SQRT: return tape_unary(m->to, o->code, taken(m, o->a, times * times));
    case OP_SIGN: return tape_unary(m->to, o->code, taken(m, o->a, times_of(m, i, 0)));
    case OP_MIN:
    case OP_MAX:
        second = taken(m, o->b, times);
        return tape_call(m->to, o->code == OP_MIN ? FN_MIN : FN_MAX, taken(m, o->a, times), second);
    case OP_CALL:
        second = o->b >= 0 ? taken(m, o->b, 1.0) : -1;
        return tape_call(m->to, o->function, taken(m, o->a, 1.0), second);
    case OP_POW: second = taken(m, o->b, 1.0); return tape_pow(m->to, taken(m, o->a, 1.0), second);
    case OP_CELL:
    case OP_LINE:
    case OP_CUBIC: break; /* a list with tables keeps its constants */
    }
    abort();
}

tape *tape_multiplied(const tape *t, const double *times) {
    multiplied m = {t, times, tape_new(t->angles, t->results), room(t->count, sizeof(int))};
    for (int i = 0; i < t->count; i++) {
        m.made[i] = make(&m, i);
    }
    for (int i = 0; i < t->results; i++) {
        m.to->result[i] = taken(&m, t->result[i], 1.0);
    }
    free(m.made);
    tape_prune(m.to);
    tape_order(m.to);
    return m.to;
}

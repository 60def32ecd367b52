/* long_list.c: see long_list.h. */
#include "long_list.h"

#include <math.h>
#include <stdlib.h>

#include "host/base/room.h"
#include "host/number/functions.h"
#include "long_functions.h"

struct long_list {
    const tape *tape;
    long double *value;
    long double *sine;
    long double *cosine;
};

long_list *long_list_new(const tape *t) {
    long_list *l = room(1, sizeof *l);
    *l = (long_list){t, room(t->count, sizeof(long double)), room(t->count, sizeof(long double)),
                     room(t->count, sizeof(long double))};
    return l;
}

void long_list_free(long_list *l) {
    if (l != NULL) {
        free(l->value);
        free(l->sine);
        free(l->cosine);
        free(l);
    }
}

static long double phase_of(const tape *t, const op *o, const long_leaves *in) {
    long double sum = (long double)o->value;
    for (int i = 0; i < t->angles && o->turns != NULL; i++) {
        sum += (long double)o->turns[i] * in->angle_rad[i];
    }
    for (int i = 0; i < t->angles && o->parts != NULL; i++) {
        sum += (long double)o->parts[i] * in->angle_rad[i];
    }
    return sum;
}

/* Where the numbers of the cell stand that a phase lies in. References are made of the exact list, which has none: the
 * middle of the cell will do. */
static long double cell_of(const tape *t, long double phase_rad) {
    const long double turns = phase_rad / 6.28318530717958647692528676655900577L;
    const double cells = (double)(1U << (unsigned)t->tables.bits);
    const long double whole = (long double)number_floor((double)turns);
    const double at = number_floor((double)(turns - whole) * cells + 0.5);
    return (long double)((at < cells ? at : 0.0) * t->tables.count * t->tables.terms);
}

/* The operands of operation o, where these are values. */
#define A (l->value[o->a])
#define B (l->value[o->b])

static long double value_of(long_list *l, int i, const long_leaves *in) {
    const op *o = &l->tape->ops[i];
    switch (o->code) {
    case OP_CONSTANT: return (long double)o->value;
    case OP_LINEAR: return in->linear[o->a];
    case OP_RATE: return in->rate[o->a];
    case OP_INPUT: return (long double)in->input[o->a];
    case OP_ACCEL:
    case OP_NOISE: return 0.0L;
    case OP_TIME: return in->time_s;
    case OP_RADIANS: return in->angle_rad[o->a];
    case OP_PHASE:
        long_sincos(phase_of(l->tape, o, in) + (o->b >= 0 ? B : 0.0L), &l->sine[i], &l->cosine[i]);
        return 0.0L;
    case OP_SIN: return l->sine[o->a];
    case OP_COS: return l->cosine[o->a];
    case OP_ADD: return A + B;
    case OP_SUB: return A - B;
    case OP_MUL: return A * B;
    case OP_DIV: return A / B;
    case OP_NEG: return -A;
    case OP_SQRT: return long_call(FN_SQRT, A, 0.0L);
    case OP_ABS: return long_call(FN_ABS, A, 0.0L);
    case OP_SIGN: return long_call(FN_SIGN, A, 0.0L);
    case OP_MIN: return long_call(FN_MIN, A, B);
    case OP_MAX: return long_call(FN_MAX, A, B);
    case OP_CALL: return long_call(o->function, A, o->b >= 0 ? B : 0.0L);
    case OP_POW: return long_power(A, B);
    case OP_CELL: return cell_of(l->tape, phase_of(l->tape, o, in));
    case OP_LINE:
    case OP_CUBIC: return (long double)l->tape->tables.number[(size_t)A + (size_t)o->value];
    }
    return 0.0L;
}

#undef A
#undef B

void long_list_run(long_list *l, const long_leaves *in, long double *result) {
    const tape *t = l->tape;
    for (int i = 0; i < t->count; i++) {
        l->value[i] = value_of(l, i, in);
    }
    for (int i = 0; i < t->results; i++) {
        result[i] = l->value[t->result[i]];
    }
}

bool long_list_asks(const tape *t, int result, op_code code) {
    bool *needed = room(t->count, sizeof *needed);
    bool found = false;
    needed[t->result[result]] = true;
    for (int i = t->result[result]; i >= 0; i--) {
        int operand[2];
        const int operands = needed[i] ? tape_operands(&t->ops[i], operand) : 0;
        found = found || (needed[i] && t->ops[i].code == code);
        for (int k = 0; k < operands; k++) {
            needed[operand[k]] = true;
        }
    }
    free(needed);
    return found;
}

/* cost_list.c: see cost_list.h. */
#include "cost_list.h"

#include <stdlib.h>

#include "host/base/room.h"

/* Angles of a wave beyond the first, and multiples of one. */
static int wave_terms(const tape *t, const op *o) {
    int terms = o->value != 0.0;
    int angles = 0;
    for (int k = 0; k < t->angles && o->turns != NULL; k++) {
        angles += o->turns[k] != 0;
        terms += o->turns[k] != 0 && o->turns[k] != 1;
    }
    return terms + (angles > 1 ? angles - 1 : 0);
}

static void add_look_up(const tape *t, const op *o, cost_list *l) {
    l->lines += o->code == OP_LINE;
    l->cubics += o->code == OP_CUBIC;
    l->mirrored += t->tables.folds && t->tables.odd[(int)o->value / t->tables.terms];
}

void cost_list_add(const tape *t, const op *o, cost_list *l) {
    switch (o->code) {
    case OP_CONSTANT: l->constants++; break;
    case OP_LINEAR:
    case OP_RATE:
    case OP_INPUT:
    case OP_ACCEL:
    case OP_TIME:
    case OP_RADIANS:
    case OP_NOISE: l->leaves++; break;
    case OP_PHASE:
        l->pairs += o->b < 0;
        l->radians += o->b >= 0;
        l->terms += wave_terms(t, o);
        break;
    case OP_SIN:
    case OP_COS: break;
    case OP_ADD:
    case OP_SUB: l->sums++; break;
    case OP_MUL: l->products++; break;
    case OP_DIV: l->quotients++; break;
    case OP_SQRT: l->roots++; break;
    case OP_NEG:
    case OP_ABS: l->sizes++; break;
    case OP_SIGN: l->signs++; break;
    case OP_MIN:
    case OP_MAX: l->choices++; break;
    case OP_CALL: l->calls[o->function]++; break;
    case OP_POW: l->powers++; break;
    case OP_CELL: l->cells++; break;
    case OP_LINE:
    case OP_CUBIC: add_look_up(t, o, l); break;
    }
}

void cost_list_add_operands(const op *o, const operand_share *given, cost_list *l) {
    if (o->code == OP_MUL) {
        l->zero_products += given->zero;
    } else {
        l->zero_sums += given->zero; /* nothing is told of what is no sum */
        l->opposed += given->opposed;
        l->bits += given->bits;
    }
}

void cost_list_add_pair(const tape *t, const op *o, const operands *given, cost_list *l) {
    double still = 1.0;
    double zero = o->value == 0.0 ? 1.0 : 0.0;
    for (int k = 0; k < t->angles && o->turns != NULL; k++) {
        if (o->turns[k] != 0) {
            still = given->still[k] < still ? given->still[k] : still;
            zero = given->at_zero[k] < zero ? given->at_zero[k] : zero;
        }
    }
    l->still_pairs += still;
    l->zero_pairs += zero;
}

/* Do operations of two lists take the same? Of operation i of the one, same[i] of the other is it, or -1. */
static bool takes_same(const tape *t, const op *o, const op *other, const int *same) {
    int operand[2];
    int others[2];
    bool is = o->code == other->code && o->function == other->function && o->value == other->value;
    const int count = is ? tape_operands(o, operand) : 0;
    if (is && count == 0) { /* leaves and cells; pairs of turn angles by their multiples */
        is = o->a == other->a && o->b == other->b;
        for (int k = 0; k < t->angles && is; k++) {
            is = (o->turns != NULL ? o->turns[k] : 0) ==
                 (other->turns != NULL ? other->turns[k] : 0);
        }
        return is;
    }
    is = is && tape_operands(other, others) == count;
    for (int k = 0; k < count && is; k++) {
        is = same[operand[k]] == others[k];
    }
    return is;
}

void cost_list_add_unshared(const tape *t, const tape *step, bool turned, cost_list *l) {
    int *same = room(t->count, sizeof *same);
    for (int i = 0; i < t->count; i++) {
        same[i] = -1;
        for (int k = 0; k < step->count && same[i] < 0; k++) {
            const bool is_pair = step->ops[k].code == OP_PHASE && step->ops[k].b < 0;
            same[i] =
                !(turned && is_pair) && takes_same(t, &t->ops[i], &step->ops[k], same) ? k : -1;
        }
        if (same[i] < 0) {
            cost_list_add(t, &t->ops[i], l);
        }
    }
    free(same);
    l->results = t->results;
    l->carried = tape_carried(t);
    l->operations = tape_operations(t);
}

void cost_list_add_all(const tape *t, cost_list *l) {
    for (int i = 0; t != NULL && i < t->count; i++) {
        cost_list_add(t, &t->ops[i], l);
    }
    if (t != NULL) {
        l->results += t->results;
        l->carried += tape_carried(t);
        l->operations += tape_operations(t);
    }
}

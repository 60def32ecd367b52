/* tape_sums.c: a + 2 b where a + b is there already is (a + b) + b: a product less.
 *
 * Such pairs come with kinetic energies: a chain of two arms moves with sin x + sin y, and its forces have
 * sin x + 2 sin y. */
#include <stdlib.h>

#include "host/base/room.h"
#include "tape.h"

/* b, where operation i is 2 b and nobody but one takes it; else -1. */
static int doubled(const tape *t, const int *uses, int i) {
    const op *o = &t->ops[i];
    double two;
    if (o->code != OP_MUL || uses[i] != 1) {
        return -1;
    }
    if (tape_is_constant(t, o->a, &two) && two == 2.0) {
        return o->b;
    }
    return tape_is_constant(t, o->b, &two) && two == 2.0 ? o->a : -1;
}

/* Half of what sum i adds, the twice taken part once, and that part; false if the list has no such half. */
static bool half_of(const tape *t, const int *uses, int i, int *half, int *part) {
    const op *o = &t->ops[i];
    const int twice_a = doubled(t, uses, o->a);
    const int twice_b = doubled(t, uses, o->b);
    *half = -1;
    if (twice_b >= 0) {
        *part = twice_b;
        *half = tape_find_binary(t, o->code, o->a, twice_b);
    }
    if (*half < 0 && twice_a >= 0) {
        *part = twice_a;
        *half = tape_find_binary(t, o->code, twice_a, o->b);
    }
    return *half >= 0;
}

static int *uses_of(const tape *t) {
    int *uses = room(t->count, sizeof *uses);
    int operand[2];
    for (int i = 0; i < t->count; i++) {
        for (int k = tape_operands(&t->ops[i], operand); k > 0; k--) {
            uses[operand[k - 1]]++;
        }
    }
    for (int i = 0; i < t->results; i++) {
        uses[t->result[i]]++;
    }
    return uses;
}

typedef struct walk {
    const tape *t;
    int *order;
    int *number; /* -1: not there yet */
    int count;
} walk;

/* Operation i behind all that it takes: most of that stands there already. */
static void put(walk *w, int i) {
    int operand[2];
    if (w->number[i] >= 0) {
        return;
    }
    const int count = tape_operands(&w->t->ops[i], operand);
    for (int k = 0; k < count; k++) {
        put(w, operand[k]);
    }
    w->number[i] = w->count;
    w->order[w->count++] = i;
}

/* A half may stand behind what takes it now. */
static void put_in_order(tape *t) {
    walk w = {t, room(t->count, sizeof *w.order), room(t->count, sizeof *w.number), 0};
    for (int i = 0; i < t->count; i++) {
        w.number[i] = -1;
    }
    for (int i = 0; i < t->count; i++) {
        put(&w, i);
    }
    tape_renumber(t, w.order, w.number);
    free(w.order);
    free(w.number);
}

void tape_share_sums(tape *t) {
    int *uses = uses_of(t);
    bool shared = false;
    for (int i = 0; i < t->count; i++) {
        op *o = &t->ops[i];
        int half;
        int part;
        if ((o->code == OP_ADD || o->code == OP_SUB) && half_of(t, uses, i, &half, &part)) {
            /* 2 b - a = (b - a) + b */
            const op_code code = o->code == OP_SUB && t->ops[half].b == part ? OP_SUB : OP_ADD;
            *o = (op){.code = code, .function = FUNCTION_NONE, .a = half, .b = part};
            uses[part] += 1;
            uses[half] += 1;
            shared = true;
        }
    }
    free(uses);
    if (shared) {
        put_in_order(t);
        tape_prune(t);
    }
}

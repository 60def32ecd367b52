/* tape_use.c: looking at a finished list: what is needed, what it costs. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/hashing.h"
#include "host/base/room.h"
#include "tape.h"

int tape_operands(const op *o, int operand[static 2]) {
    const bool values = op_rows[o->code].values > 0;
    int count = 0;
    if (values && o->a >= 0) {
        operand[count++] = o->a;
    }
    if ((values || o->code == OP_PHASE) && o->b >= 0) {
        operand[count++] = o->b;
    }
    return count;
}

/* The same, to be changed. */
static void renumber(op *o, const int *number) {
    const bool values = op_rows[o->code].values > 0;
    o->a = values && o->a >= 0 ? number[o->a] : o->a;
    o->b = (values || o->code == OP_PHASE) && o->b >= 0 ? number[o->b] : o->b;
}

/* x * (1/y) where nothing else wants 1/y is x/y: one rounding and one operation less. */
static void fuse_reciprocals(tape *t) {
    int *uses = room(t->count, sizeof *uses);
    int operand[2];
    double one;
    for (int i = 0; i < t->count; i++) {
        for (int k = tape_operands(&t->ops[i], operand); k > 0; k--) {
            uses[operand[k - 1]]++;
        }
    }
    for (int i = 0; i < t->results; i++) {
        uses[t->result[i]]++;
    }
    for (int i = 0; i < t->count; i++) {
        op *o = &t->ops[i];
        for (int k = 0; k < 2 && o->code == OP_MUL; k++) {
            const int inverse = k == 0 ? o->a : o->b;
            const int other = k == 0 ? o->b : o->a;
            if (t->ops[inverse].code == OP_DIV && tape_is_constant(t, t->ops[inverse].a, &one) &&
                one == 1.0 && uses[inverse] == 1) {
                *o = (op){
                    .code = OP_DIV, .function = FUNCTION_NONE, .a = other, .b = t->ops[inverse].b};
            }
        }
    }
    free(uses);
}

static void drop_unused(tape *t) {
    int *number = room_more(NULL, t->count, sizeof *number);
    memset(number, -1, (size_t)t->count * sizeof *number);
    for (int i = 0; i < t->results; i++) {
        number[t->result[i]] = 0;
    }
    int operand[2];
    for (int i = t->count - 1; i >= 0; i--) {
        if (number[i] == 0) {
            const int count = tape_operands(&t->ops[i], operand);
            for (int k = 0; k < count; k++) {
                number[operand[k]] = 0;
            }
        }
    }
    int kept = 0;
    for (int i = 0; i < t->count; i++) {
        if (number[i] < 0) {
            continue;
        }
        op o = t->ops[i];
        renumber(&o, number);
        number[i] = kept;
        t->ops[kept++] = o;
    }
    t->count = kept;
    for (int i = 0; i < t->results; i++) {
        t->result[i] = number[t->result[i]];
    }
    free(number);
    if (t->room > 0) {
        tape_reindex(t);
    }
}

void tape_prune(tape *t) {
    drop_unused(t);
    fuse_reciprocals(t);
    drop_unused(t);
}

bool tape_reads_turns(const tape *t) {
    for (int i = 0; i < t->count; i++) {
        if (t->ops[i].code == OP_RADIANS || t->ops[i].parts != NULL) {
            return true;
        }
    }
    return false;
}

int tape_waves(const tape *t) {
    int count = 0;
    for (int i = 0; i < t->count; i++) {
        count += tape_is_wave(&t->ops[i]);
    }
    return count;
}

bool tape_takes_waves(const tape *t) {
    for (int i = 0; i < t->count; i++) {
        const op *o = &t->ops[i];
        if (o->code == OP_PHASE && (o->parts != NULL || (o->turns != NULL && o->b >= 0))) {
            return false;
        }
    }
    return true;
}

static bool has_finite_numbers(const tape *t, const op *o) {
    bool finite = isfinite(o->value);
    for (int i = 0; i < t->angles && o->parts != NULL; i++) {
        finite = finite && isfinite(o->parts[i]);
    }
    return finite;
}

int tape_not_finite(const tape *t) {
    bool *tainted = room(t->count, sizeof *tainted);
    int operand[2];
    for (int i = 0; i < t->count; i++) {
        tainted[i] = !has_finite_numbers(t, &t->ops[i]);
        for (int k = tape_operands(&t->ops[i], operand); k > 0; k--) {
            tainted[i] = tainted[i] || tainted[operand[k - 1]];
        }
    }
    int found = -1;
    for (int i = t->results - 1; i >= 0; i--) {
        found = tainted[t->result[i]] ? i : found;
    }
    free(tainted);
    return found;
}

bool fits_float(double value) {
    const double size = fabs(value);
    return size == 0.0 || (size >= 0x1p-126 && size < 0x1.ffffffp127);
}

double tape_out_of_float(const tape *t) {
    for (int i = 0; i < t->count; i++) {
        if (t->ops[i].code == OP_CONSTANT && !fits_float(t->ops[i].value)) {
            return t->ops[i].value;
        }
    }
    return 0.0;
}

tape_cost tape_count(const tape *t) {
    tape_cost cost = {0};
    for (int i = 0; i < t->count; i++) {
        switch (op_rows[t->ops[i].code].cost) {
        case OP_COSTS_NOTHING: break;
        case OP_COSTS_ARITHMETIC: cost.arithmetic++; break;
        case OP_COSTS_DIVISION: cost.divisions++; break;
        case OP_COSTS_ROOT: cost.roots++; break;
        case OP_COSTS_WAVE: cost.waves++; break;
        case OP_COSTS_CALL: cost.calls++; break;
        case OP_COSTS_LINE:
            cost.look_ups++;
            cost.arithmetic += 2;
            break;
        case OP_COSTS_CUBIC:
            cost.look_ups++;
            cost.arithmetic += 6;
            break;
        }
    }
    return cost;
}

int tape_weight(const tape *t) {
    const tape_cost c = tape_count(t);
    return c.arithmetic + 14 * (c.divisions + c.roots) + 36 * c.waves + 100 * c.calls;
}

int tape_operations(const tape *t) {
    int operations = 0;
    for (int i = 0; i < t->count; i++) {
        operations += op_rows[t->ops[i].code].values > 0;
    }
    return operations;
}

void tape_renumber(tape *t, const int *order, const int *number) {
    op *ops = room_more(NULL, t->room, sizeof *ops);
    for (int i = 0; i < t->count; i++) {
        ops[i] = t->ops[order[i]];
        renumber(&ops[i], number);
    }
    free(t->ops);
    t->ops = ops;
    for (int i = 0; i < t->results; i++) {
        t->result[i] = number[t->result[i]];
    }
    tape_reindex(t);
}

uint64_t tape_hash(const tape *t) {
    uint64_t hash = WH_HASH_START;
    for (int i = 0; i < t->count; i++) {
        hash = hash_of_hashes(hash, tape_op_hash(t, &t->ops[i]));
    }
    for (int i = 0; i < t->results; i++) {
        hash = hash_of_hashes(hash, (uint64_t)t->result[i]);
    }
    const size_t numbers = (size_t)t->tables.count * (size_t)t->tables.terms;
    for (size_t i = 0; i < numbers << (unsigned)t->tables.bits; i++) {
        uint64_t bits;
        memcpy(&bits, &t->tables.number[i], sizeof bits);
        hash = hash_of_hashes(hash, bits);
    }
    return hash;
}

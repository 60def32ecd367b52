/* tape.c: entering operations once, folded and with signs pulled outwards. */
#include "tape.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/lang/arena.h"

tape *tape_new(int angles, int results) {
    tape *t = calloc(1, sizeof *t);
    int *result = calloc((size_t)(results > 0 ? results : 1), sizeof *result);
    if (t == NULL || result == NULL) {
        abort();
    }
    t->angles = angles;
    t->results = results;
    t->result = result;
    t->arena = arena_new();
    return t;
}

void tape_free(tape *t) {
    if (t == NULL) {
        return;
    }
    free(t->ops);
    free(t->index);
    free(t->result);
    arena_free(t->arena);
    free(t);
}

/* --- entering ------------------------------------------------------------------------------------*/

static uint64_t mix(uint64_t hash, uint64_t word) {
    return (hash ^ word) * UINT64_C(0x9e3779b97f4a7c15) + (hash >> 29);
}

static uint64_t op_hash(const tape *t, const op *o) {
    uint64_t bits;
    memcpy(&bits, &o->value, sizeof bits);
    uint64_t hash = mix(mix((uint64_t)o->code, (uint64_t)o->function), bits);
    hash = mix(mix(hash, (uint64_t)(unsigned)o->a), (uint64_t)(unsigned)o->b);
    for (int i = 0; i < t->angles && o->turns != NULL; i++) {
        hash = mix(hash, (uint64_t)(unsigned)o->turns[i]);
    }
    return hash ^ (hash >> 31);
}

static bool op_equal(const tape *t, const op *x, const op *y) {
    if (x->code != y->code || x->function != y->function || x->a != y->a || x->b != y->b ||
        memcmp(&x->value, &y->value, sizeof x->value) != 0 ||
        (x->turns == NULL) != (y->turns == NULL)) {
        return false;
    }
    return x->turns == NULL ||
           memcmp(x->turns, y->turns, (size_t)t->angles * sizeof *x->turns) == 0;
}

static void index_rebuild(tape *t) {
    free(t->index);
    t->index_size = t->room * 2;
    t->index = malloc((size_t)t->index_size * sizeof *t->index);
    if (t->index == NULL) {
        abort();
    }
    memset(t->index, -1, (size_t)t->index_size * sizeof *t->index);
    for (int i = 0; i < t->count; i++) {
        size_t at = op_hash(t, &t->ops[i]) % (uint64_t)t->index_size;
        while (t->index[at] >= 0) {
            at = (at + 1) % (size_t)t->index_size;
        }
        t->index[at] = i;
    }
}

static int enter(tape *t, op o) {
    if (t->count == t->room) {
        t->room = t->room == 0 ? 128 : t->room * 2;
        t->ops = realloc(t->ops, (size_t)t->room * sizeof *t->ops);
        if (t->ops == NULL) {
            abort();
        }
        index_rebuild(t);
    }
    size_t at = op_hash(t, &o) % (uint64_t)t->index_size;
    while (t->index[at] >= 0) {
        if (op_equal(t, &t->ops[t->index[at]], &o)) {
            return t->index[at];
        }
        at = (at + 1) % (size_t)t->index_size;
    }
    t->index[at] = t->count;
    t->ops[t->count] = o;
    return t->count++;
}

static int enter_op(tape *t, op_code code, int a, int b) {
    return enter(t, (op){.code = code, .function = FN_COUNT, .a = a, .b = b});
}

bool tape_is_constant(const tape *t, int a, double *value) {
    if (t->ops[a].code != OP_CONSTANT) {
        return false;
    }
    *value = t->ops[a].value;
    return true;
}

static bool is_value(const tape *t, int a, double value) {
    return t->ops[a].code == OP_CONSTANT && t->ops[a].value == value;
}

int tape_constant(tape *t, double value) {
    return enter(t, (op){.code = OP_CONSTANT,
                         .function = FN_COUNT,
                         .a = -1,
                         .b = -1,
                         .value = value == 0.0 ? 0.0 : value}); /* one zero */
}

int tape_leaf(tape *t, op_code code, int which) { return enter_op(t, code, which, -1); }

int tape_phase(tape *t, const int *turns, double offset_rad, int radians) {
    int *copy = NULL;
    if (turns != NULL && t->angles > 0) {
        copy = arena_alloc(t->arena, (size_t)t->angles * sizeof *copy);
        memcpy(copy, turns, (size_t)t->angles * sizeof *copy);
    }
    return enter(t, (op){.code = OP_PHASE,
                         .function = FN_COUNT,
                         .a = -1,
                         .b = radians,
                         .value = offset_rad,
                         .turns = copy});
}

static int negate(tape *t, int a) {
    const op *o = &t->ops[a];
    if (o->code == OP_CONSTANT) {
        return tape_constant(t, -o->value);
    }
    if (o->code == OP_NEG) {
        return o->a;
    }
    if (o->code == OP_SUB) {
        return tape_sub(t, o->b, o->a);
    }
    return enter_op(t, OP_NEG, a, -1);
}

int tape_unary(tape *t, op_code code, int a) {
    double x;
    if (code == OP_NEG) {
        return negate(t, a);
    }
    if (tape_is_constant(t, a, &x)) {
        switch (code) {
        case OP_SQRT: return tape_constant(t, sqrt(x));
        case OP_ABS: return tape_constant(t, fabs(x));
        case OP_SIGN: return tape_constant(t, (double)((x > 0.0) - (x < 0.0)));
        default: break;
        }
    }
    return enter_op(t, code, a, -1);
}

int tape_add(tape *t, int a, int b) {
    double x;
    double y;
    const bool fixed_a = tape_is_constant(t, a, &x);
    const bool fixed_b = tape_is_constant(t, b, &y);
    if (fixed_a && fixed_b) {
        return tape_constant(t, x + y);
    }
    if (fixed_a && x == 0.0) {
        return b;
    }
    if (fixed_b && y == 0.0) {
        return a;
    }
    if (t->ops[b].code == OP_NEG) {
        return tape_sub(t, a, t->ops[b].a);
    }
    if (t->ops[a].code == OP_NEG) {
        return tape_sub(t, b, t->ops[a].a);
    }
    return a < b ? enter_op(t, OP_ADD, a, b) : enter_op(t, OP_ADD, b, a);
}

int tape_sub(tape *t, int a, int b) {
    double x;
    double y;
    const bool fixed_a = tape_is_constant(t, a, &x);
    const bool fixed_b = tape_is_constant(t, b, &y);
    if (fixed_a && fixed_b) {
        return tape_constant(t, x - y);
    }
    if (a == b) {
        return tape_constant(t, 0.0);
    }
    if (fixed_a && x == 0.0) {
        return negate(t, b);
    }
    if (fixed_b && y == 0.0) {
        return a;
    }
    if (t->ops[b].code == OP_NEG) {
        return tape_add(t, a, t->ops[b].a);
    }
    if (t->ops[a].code == OP_NEG) {
        return negate(t, tape_add(t, t->ops[a].a, b));
    }
    return enter_op(t, OP_SUB, a, b);
}

int tape_mul(tape *t, int a, int b) {
    double x;
    double y;
    const bool fixed_a = tape_is_constant(t, a, &x);
    const bool fixed_b = tape_is_constant(t, b, &y);
    if (fixed_a && fixed_b) {
        return tape_constant(t, x * y);
    }
    if (fixed_b) {
        return tape_mul(t, b, a);
    }
    if (fixed_a) {
        if (x == 0.0) {
            return a;
        }
        if (x == 1.0) {
            return b;
        }
        if (x == -1.0) {
            return negate(t, b);
        }
        if (t->ops[b].code == OP_NEG) {
            return tape_mul(t, tape_constant(t, -x), t->ops[b].a);
        }
        if (t->ops[b].code == OP_MUL && tape_is_constant(t, t->ops[b].a, &y)) {
            return tape_mul(t, tape_constant(t, x * y), t->ops[b].b);
        }
        return enter_op(t, OP_MUL, a, b);
    }
    if (t->ops[a].code == OP_NEG) {
        return negate(t, tape_mul(t, t->ops[a].a, b));
    }
    if (t->ops[b].code == OP_NEG) {
        return negate(t, tape_mul(t, a, t->ops[b].a));
    }
    return a < b ? enter_op(t, OP_MUL, a, b) : enter_op(t, OP_MUL, b, a);
}

int tape_div(tape *t, int a, int b) {
    double x;
    double y;
    if (tape_is_constant(t, b, &y)) {
        return tape_is_constant(t, a, &x) ? tape_constant(t, x / y)
                                          : tape_mul(t, tape_constant(t, 1.0 / y), a);
    }
    if (is_value(t, a, 0.0)) {
        return a;
    }
    if (t->ops[b].code == OP_NEG) {
        return negate(t, tape_div(t, a, t->ops[b].a));
    }
    return enter_op(t, OP_DIV, a, b);
}

int tape_call(tape *t, function_id function, int a, int b) {
    if (function == FN_MIN || function == FN_MAX) {
        return enter_op(t, function == FN_MIN ? OP_MIN : OP_MAX, a, b);
    }
    if (function == FN_ABS || function == FN_SIGN) {
        return tape_unary(t, function == FN_ABS ? OP_ABS : OP_SIGN, a);
    }
    return enter(t, (op){.code = OP_CALL, .function = function, .a = a, .b = b});
}

int tape_pow(tape *t, int base, int exponent) {
    double e;
    if (tape_is_constant(t, exponent, &e)) {
        return tape_power(t, base, e);
    }
    return enter_op(t, OP_POW, base, exponent);
}

int tape_power(tape *t, int base, double exponent) {
    if (exponent < 0.0) {
        return tape_div(t, tape_constant(t, 1.0), tape_power(t, base, -exponent));
    }
    if (exponent == floor(exponent) && exponent <= 64.0) {
        int result = tape_constant(t, 1.0);
        int square = base;
        for (unsigned left = (unsigned)exponent; left != 0; left >>= 1U) {
            if (left & 1U) {
                result = tape_mul(t, result, square);
            }
            square = left > 1 ? tape_mul(t, square, square) : square;
        }
        return result;
    }
    if (2.0 * exponent == floor(2.0 * exponent) && exponent <= 32.0) {
        const int root = tape_unary(t, OP_SQRT, base);
        return tape_mul(t, tape_power(t, base, floor(exponent)), root);
    }
    return enter_op(t, OP_POW, base, tape_constant(t, exponent));
}

/* --- looking at a finished list ------------------------------------------------------------------*/

static int operands(const op *o, int operand[2]) {
    int count = 0;
    if (o->code == OP_PHASE || o->code >= OP_SIN) {
        if (o->a >= 0) {
            operand[count++] = o->a;
        }
        if (o->b >= 0) {
            operand[count++] = o->b;
        }
    }
    return count;
}

/* x * (1/y) where nothing else wants 1/y is x/y: one rounding and one operation less. */
static void fuse_reciprocals(tape *t) {
    int *uses = calloc((size_t)(t->count > 0 ? t->count : 1), sizeof *uses);
    if (uses == NULL) {
        abort();
    }
    int operand[2];
    for (int i = 0; i < t->count; i++) {
        for (int k = operands(&t->ops[i], operand); k > 0; k--) {
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
            if (t->ops[inverse].code == OP_DIV && is_value(t, t->ops[inverse].a, 1.0) &&
                uses[inverse] == 1) {
                *o = (op){.code = OP_DIV, .function = FN_COUNT, .a = other, .b = t->ops[inverse].b};
            }
        }
    }
    free(uses);
}

static void drop_unused(tape *t) {
    int *number = malloc((size_t)(t->count > 0 ? t->count : 1) * sizeof *number);
    if (number == NULL) {
        abort();
    }
    memset(number, -1, (size_t)t->count * sizeof *number);
    for (int i = 0; i < t->results; i++) {
        number[t->result[i]] = 0;
    }
    int operand[2];
    for (int i = t->count - 1; i >= 0; i--) {
        if (number[i] == 0) {
            const int count = operands(&t->ops[i], operand);
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
        if (o.code == OP_PHASE || o.code >= OP_SIN) {
            o.a = o.a >= 0 ? number[o.a] : o.a;
            o.b = o.b >= 0 ? number[o.b] : o.b;
        }
        number[i] = kept;
        t->ops[kept++] = o;
    }
    t->count = kept;
    for (int i = 0; i < t->results; i++) {
        t->result[i] = number[t->result[i]];
    }
    free(number);
    if (t->room > 0) {
        index_rebuild(t);
    }
}

void tape_prune(tape *t) {
    drop_unused(t);
    fuse_reciprocals(t);
    drop_unused(t);
}

tape_cost tape_count(const tape *t) {
    tape_cost cost = {0};
    for (int i = 0; i < t->count; i++) {
        switch (t->ops[i].code) {
        case OP_ADD:
        case OP_SUB:
        case OP_MUL:
        case OP_NEG:
        case OP_ABS:
        case OP_SIGN:
        case OP_MIN:
        case OP_MAX: cost.arithmetic++; break;
        case OP_DIV: cost.divisions++; break;
        case OP_SQRT: cost.roots++; break;
        case OP_PHASE: cost.waves++; break;
        case OP_CALL:
        case OP_POW: cost.calls++; break;
        default: break;
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
        operations += t->ops[i].code >= OP_SIN;
    }
    return operations;
}

uint64_t tape_hash(const tape *t) {
    uint64_t hash = UINT64_C(0xcbf29ce484222325);
    for (int i = 0; i < t->count; i++) {
        hash = mix(hash, op_hash(t, &t->ops[i]));
    }
    for (int i = 0; i < t->results; i++) {
        hash = mix(hash, (uint64_t)t->result[i]);
    }
    return hash;
}

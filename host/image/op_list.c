/* op_list.c: entry of operations into a list. Equal operations are shared, constants folded, signs moved outwards. */
#include "host/image/op_list.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/step/table.h"
#include "host/base/alloc.h"
#include "host/number/folding.h"

/* === the list ================================================================================= */

op_list *op_list_new(int angles, int results) {
    op_list *t = alloc(1, sizeof *t);
    t->angles = angles;
    t->results = results;
    t->result = alloc(results, sizeof *t->result);
    t->arena = arena_new();
    return t;
}

void op_list_free(op_list *t) {
    if (t == NULL) {
        return;
    }
    free(t->ops);
    free(t->index);
    free(t->result);
    arena_free(t->arena);
    free(t);
}

/* The value of op_row.values for each op_kind. */
enum { VALUES_CONSTANT = 0, VALUES_LEAF = 0, VALUES_PHASE = 0, VALUES_CELL = 0 };
enum { VALUES_WAVE = 1, VALUES_UNARY = 1, VALUES_LOOKUP = 1 };
enum { VALUES_BINARY = 2, VALUES_CALL = 2 };

const op_row op_rows[OPS] = {
#define ROW(id, kind, cost, c, octave, ...) \
    [OP_##id] = {OP_IS_##kind, OP_COSTS_##cost, VALUES_##kind, c, octave},
    OP_ROWS(ROW)
#undef ROW
};

static const op_code operation_of[FUNCTIONS] = {
#define FUNCTION_CORE(value) OP_CALL
#define FUNCTION_OWN(operation, value) OP_##operation
#define ROW(id, word, arguments, dimensions, range, latex, value, ...) [FN_##id] = value,
    FUNCTION_ROWS(ROW)
#undef ROW
};

function_id op_list_function(const op *o) {
    int f = 0;
    while (f < FUNCTIONS && operation_of[f] != o->code) {
        f++;
    }
    return o->code == OP_CALL ? o->function : (function_id)f;
}

static uint64_t mix(uint64_t hash, uint64_t word) {
    return (hash ^ word) * UINT64_C(0x9e3779b97f4a7c15) + (hash >> 29);
}

/* Model hashes depend on this number, so it must not change. */
#define HASHED_NO_FUNCTION UINT64_C(14)

uint64_t op_list_op_hash(const op_list *t, const op *o) {
    const uint64_t function = o->code == OP_CALL ? (uint64_t)o->function : HASHED_NO_FUNCTION;
    uint64_t hash = mix(mix((uint64_t)o->code, function), number_bits(o->value));
    hash = mix(mix(hash, (uint64_t)(unsigned)o->a), (uint64_t)(unsigned)o->b);
    for (int i = 0; i < t->angles && o->turns != NULL; i++) {
        hash = mix(hash, (uint64_t)(unsigned)o->turns[i]);
    }
    for (int i = 0; i < t->angles && o->parts != NULL; i++) {
        hash = mix(hash, number_bits(o->parts[i]));
    }
    return hash ^ (hash >> 31);
}

/* Compares two arrays [t->angles], either of which may be NULL. */
static bool same_array(const op_list *t, const void *x, const void *y, size_t size) {
    return x == y || (x != NULL && y != NULL && memcmp(x, y, (size_t)t->angles * size) == 0);
}

static bool op_equal(const op_list *t, const op *x, const op *y) {
    return x->code == y->code && x->function == y->function && x->a == y->a && x->b == y->b &&
           number_bits(x->value) == number_bits(y->value) &&
           same_array(t, x->turns, y->turns, sizeof *x->turns) &&
           same_array(t, x->parts, y->parts, sizeof *x->parts);
}

void op_list_reindex(op_list *t) {
    free(t->index);
    t->index_size = t->room * 2;
    t->index = alloc_more(NULL, t->index_size, sizeof *t->index);
    memset(t->index, -1, (size_t)t->index_size * sizeof *t->index);
    for (int i = 0; i < t->count; i++) {
        size_t at = (size_t)(op_list_op_hash(t, &t->ops[i]) % (uint64_t)t->index_size);
        while (t->index[at] >= 0) {
            at = (at + 1) % (size_t)t->index_size;
        }
        t->index[at] = i;
    }
}

/* Returns the place in index[] of an equal operation, or the free place for a new one. */
static size_t place_of(const op_list *t, const op *o) {
    size_t at = (size_t)(op_list_op_hash(t, o) % (uint64_t)t->index_size);
    while (t->index[at] >= 0 && !op_equal(t, &t->ops[t->index[at]], o)) {
        at = (at + 1) % (size_t)t->index_size;
    }
    return at;
}

static int enter(op_list *t, op o) {
    if (t->count == t->room) {
        t->room = t->room == 0 ? 128 : t->room * 2;
        t->ops = alloc_more(t->ops, t->room, sizeof *t->ops);
        op_list_reindex(t);
    }
    int *number = &t->index[place_of(t, &o)];
    if (*number < 0) {
        t->ops[t->count] = o;
        *number = t->count++;
    }
    return *number;
}

int op_list_find_binary(const op_list *t, op_code code, int a, int b) {
    /* the constant of a product is always the first operand */
    const bool fixed_a = code == OP_MUL && t->ops[a].code == OP_CONSTANT;
    const bool fixed_b = code == OP_MUL && t->ops[b].code == OP_CONSTANT;
    const bool swapped = fixed_a != fixed_b ? fixed_b : (code == OP_ADD || code == OP_MUL) && a > b;
    const op o = {
        .code = code, .function = FUNCTION_NONE, .a = swapped ? b : a, .b = swapped ? a : b};
    return t->index[place_of(t, &o)];
}

static int enter_op(op_list *t, op_code code, int a, int b) {
    return enter(t, (op){.code = code, .function = FUNCTION_NONE, .a = a, .b = b});
}

static int enter_value(op_list *t, op_code code, int a, double value) {
    return enter(t, (op){.code = code, .function = FUNCTION_NONE, .a = a, .b = -1, .value = value});
}

bool op_list_is_constant(const op_list *t, int a, double *value) {
    if (t->ops[a].code != OP_CONSTANT) {
        return false;
    }
    *value = t->ops[a].value;
    return true;
}

int op_list_constant(op_list *t, double value) {
    return enter_value(t, OP_CONSTANT, -1, value == 0.0 ? 0.0 : value); /* no negative zero */
}

int op_list_leaf(op_list *t, op_code code, int which) { return enter_op(t, code, which, -1); }

int op_list_noise(op_list *t, uint32_t seed) { return enter_value(t, OP_NOISE, -1, seed); }

bool op_list_is_whole(double multiple) {
    return multiple == number_floor(multiple) && fabs(multiple) <= 2147483647.0;
}

/* Multiples that are not whole numbers are stored in `parts`. */
int op_list_phase(op_list *t, const double *multiple, double offset_rad, int radians) {
    const size_t angles = (size_t)t->angles;
    int *turns = NULL;
    double *parts = NULL;
    for (int i = 0; i < t->angles && multiple != NULL; i++) {
        if (multiple[i] == 0.0) {
            continue;
        }
        if (op_list_is_whole(multiple[i])) {
            turns = turns != NULL ? turns : arena_alloc(t->arena, angles * sizeof *turns);
            turns[i] = (int)multiple[i];
        } else {
            parts = parts != NULL ? parts : arena_alloc(t->arena, angles * sizeof *parts);
            parts[i] = multiple[i];
        }
    }
    return enter(t, (op){.code = OP_PHASE,
                         .function = FUNCTION_NONE,
                         .a = -1,
                         .b = radians,
                         .value = offset_rad,
                         .turns = turns,
                         .parts = parts});
}

void op_list_tables_new(op_list *t, int count, int bits, int terms) {
    const size_t numbers = ((size_t)count << (unsigned)bits) * (size_t)terms;
    t->tables = (op_list_tables){.count = count,
                                 .bits = bits,
                                 .terms = terms,
                                 .number = arena_alloc(t->arena, numbers * sizeof(double)),
                                 .size = arena_alloc(t->arena, (size_t)count * sizeof(double)),
                                 .off = arena_alloc(t->arena, (size_t)count * sizeof(double)),
                                 .odd = arena_alloc(t->arena, (size_t)count * sizeof(bool))};
}

int op_list_cell(op_list *t, const int *turns) {
    int *kept = arena_alloc(t->arena, (size_t)t->angles * sizeof *kept);
    memcpy(kept, turns, (size_t)t->angles * sizeof *kept);
    return enter(t,
                 (op){.code = OP_CELL, .function = FUNCTION_NONE, .a = -1, .b = -1, .turns = kept});
}

int op_list_look_up(op_list *t, int cell, int which) {
    return enter_value(t, t->tables.terms == WH_TABLE_LINEAR ? OP_LINE : OP_CUBIC, cell,
                       which * t->tables.terms);
}

static int negate(op_list *t, int a) {
    const op *o = &t->ops[a];
    if (o->code == OP_CONSTANT) {
        return op_list_constant(t, -o->value);
    }
    if (o->code == OP_NEG) {
        return o->a;
    }
    if (o->code == OP_SUB) {
        return op_list_sub(t, o->b, o->a);
    }
    return enter_op(t, OP_NEG, a, -1);
}

int op_list_unary(op_list *t, op_code code, int a) {
    double x;
    if (code == OP_NEG) {
        return negate(t, a);
    }
    const function_id function = op_list_function(&(op){.code = code});
    if (function != FUNCTION_NONE && op_list_is_constant(t, a, &x)) {
        return op_list_constant(t, folding_call(t->folding, function, x, 0.0));
    }
    return enter_op(t, code, a, -1);
}

int op_list_add(op_list *t, int a, int b) {
    double x;
    double y;
    const bool fixed_a = op_list_is_constant(t, a, &x);
    const bool fixed_b = op_list_is_constant(t, b, &y);
    if (fixed_a && fixed_b) {
        return op_list_constant(t, folding_sum(t->folding, x, y));
    }
    if (fixed_a && x == 0.0) {
        return b;
    }
    if (fixed_b && y == 0.0) {
        return a;
    }
    if (t->ops[b].code == OP_NEG) {
        return op_list_sub(t, a, t->ops[b].a);
    }
    if (t->ops[a].code == OP_NEG) {
        return op_list_sub(t, b, t->ops[a].a);
    }
    return a < b ? enter_op(t, OP_ADD, a, b) : enter_op(t, OP_ADD, b, a);
}

int op_list_sub(op_list *t, int a, int b) {
    double x;
    double y;
    const bool fixed_a = op_list_is_constant(t, a, &x);
    const bool fixed_b = op_list_is_constant(t, b, &y);
    if (fixed_a && fixed_b) {
        return op_list_constant(t, folding_sum(t->folding, x, -y));
    }
    if (a == b) {
        return op_list_constant(t, 0.0);
    }
    if (fixed_a && x == 0.0) {
        return negate(t, b);
    }
    if (fixed_b && y == 0.0) {
        return a;
    }
    if (t->ops[b].code == OP_NEG) {
        return op_list_add(t, a, t->ops[b].a);
    }
    if (t->ops[a].code == OP_NEG) {
        return negate(t, op_list_add(t, t->ops[a].a, b));
    }
    return enter_op(t, OP_SUB, a, b);
}

int op_list_mul(op_list *t, int a, int b) {
    double x;
    double y;
    const bool fixed_a = op_list_is_constant(t, a, &x);
    const bool fixed_b = op_list_is_constant(t, b, &y);
    if (fixed_a && fixed_b) {
        return op_list_constant(t, folding_product(t->folding, x, y));
    }
    if (fixed_b) {
        return op_list_mul(t, b, a);
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
            return op_list_mul(t, op_list_constant(t, -x), t->ops[b].a);
        }
        if (t->ops[b].code == OP_MUL && op_list_is_constant(t, t->ops[b].a, &y)) {
            return op_list_mul(t, op_list_constant(t, folding_product(t->folding, x, y)),
                               t->ops[b].b);
        }
        return enter_op(t, OP_MUL, a, b);
    }
    if (t->ops[a].code == OP_NEG) {
        return negate(t, op_list_mul(t, t->ops[a].a, b));
    }
    if (t->ops[b].code == OP_NEG) {
        return negate(t, op_list_mul(t, a, t->ops[b].a));
    }
    return a < b ? enter_op(t, OP_MUL, a, b) : enter_op(t, OP_MUL, b, a);
}

int op_list_div(op_list *t, int a, int b) {
    double x;
    double y;
    if (op_list_is_constant(t, b, &y)) {
        return op_list_is_constant(t, a, &x) ? op_list_constant(t, x / y)
                                             : op_list_mul(t, op_list_constant(t, 1.0 / y), a);
    }
    if (op_list_is_constant(t, a, &x) && x == 0.0) {
        return a;
    }
    if (t->ops[b].code == OP_NEG) {
        return negate(t, op_list_div(t, a, t->ops[b].a));
    }
    return enter_op(t, OP_DIV, a, b);
}

int op_list_call(op_list *t, function_id function, int a, int b) {
    const op_code code = operation_of[function];
    switch (op_rows[code].kind) {
    case OP_IS_WAVE: return enter_op(t, code, op_list_phase(t, NULL, 0.0, a), -1);
    case OP_IS_UNARY: return op_list_unary(t, code, a);
    case OP_IS_BINARY: return enter_op(t, code, a, b);
    case OP_IS_CALL: return enter(t, (op){.code = code, .function = function, .a = a, .b = b});
    case OP_IS_CONSTANT: /* these kinds compute no function */
    case OP_IS_LEAF:
    case OP_IS_CELL:
    case OP_IS_LOOKUP:
    case OP_IS_PHASE: break;
    }
    abort();
}

int op_list_pow(op_list *t, int base, int exponent) {
    double e;
    if (op_list_is_constant(t, exponent, &e)) {
        return op_list_power(t, base, e);
    }
    return enter_op(t, OP_POW, base, exponent);
}

int op_list_power(op_list *t, int base, double exponent) {
    if (exponent < 0.0) {
        const int inverse = op_list_power(t, base, -exponent);
        return op_list_div(t, op_list_constant(t, 1.0), inverse);
    }
    if (exponent == number_floor(exponent) && exponent <= 64.0) {
        int result = op_list_constant(t, 1.0);
        int square = base;
        for (unsigned left = (unsigned)exponent; left != 0; left >>= 1U) {
            if (left & 1U) {
                result = op_list_mul(t, result, square);
            }
            square = left > 1 ? op_list_mul(t, square, square) : square;
        }
        return result;
    }
    if (2.0 * exponent == number_floor(2.0 * exponent) && exponent <= 32.0) {
        const int root = op_list_unary(t, OP_SQRT, base);
        return op_list_mul(t, op_list_power(t, base, number_floor(exponent)), root);
    }
    return enter_op(t, OP_POW, base, op_list_constant(t, exponent));
}

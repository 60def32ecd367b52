/* products.c: see products.h. Operation by operation, from the first on: sums are added, multiplied out and divided by
 * what depends on the angles alone. */
#include "products.h"

#include <stdlib.h>
#include <string.h>

#include "host/base/arena.h"
#include "host/base/room.h"

typedef struct collecting {
    products *made;
    const tape *list;
    product_sum *sum; /* [list->count] */
    int *number;      /* [list->count] symbol, or -1 */
    refusal *why;
} collecting;

static void refuse(collecting *c, const char *reason, const char *hint) {
    if (c->why->reason == NULL) {
        *c->why = (refusal){reason, hint, -1};
    }
}

static void find_symbols(collecting *c) {
    products *p = c->made;
    p->symbol = room(c->list->count, sizeof *p->symbol);
    for (int i = 0; i < c->list->count; i++) {
        const op_code code = c->list->ops[i].code;
        const bool is_symbol = code == OP_LINEAR || code == OP_RATE || code == OP_INPUT;
        c->number[i] = is_symbol ? p->symbols : -1;
        if (is_symbol) {
            p->symbol[p->symbols++] = i;
        }
    }
}

/* A byte at least, so that every product has an address of its own. */
static unsigned char *powers_new(const products *p) {
    return arena_alloc(p->memory, (size_t)p->symbols + 1U);
}

static bool is_zero(const tape *t, int a) {
    double value;
    return tape_is_constant(t, a, &value) && value == 0.0;
}

/* sum += coefficient * powers. What cancels leaves. */
static void enter(collecting *c, product_sum *sum, const unsigned char *power, int coefficient) {
    products *p = c->made;
    for (int i = 0; i < sum->count; i++) {
        term_product *same = &sum->product[i];
        if (memcmp(same->power, power, (size_t)p->symbols) == 0) {
            same->coefficient = tape_add(p->coefficients, same->coefficient, coefficient);
            if (is_zero(p->coefficients, same->coefficient)) {
                *same = sum->product[--sum->count];
            }
            return;
        }
    }
    if (is_zero(p->coefficients, coefficient)) {
        return;
    }
    if (sum->count == PRODUCTS_MOST) {
        refuse(c, "are sums of too many products of rates, inputs and reals",
               "leave --tables out: as they stand they take fewer operations");
        return;
    }
    sum->product = arena_room(p->memory, sum->product, sum->count, sizeof *sum->product);
    sum->product[sum->count++] = (term_product){power, coefficient};
}

static product_sum of_angles(collecting *c, int coefficient) {
    product_sum sum = {NULL, 0};
    enter(c, &sum, powers_new(c->made), coefficient);
    return sum;
}

/* Does it depend on the angles alone? Then *coefficient is what it is. */
static bool is_of_angles(collecting *c, product_sum sum, int *coefficient) {
    bool alone = sum.count <= 1;
    for (int i = 0; i < c->made->symbols && sum.count == 1; i++) {
        alone = alone && sum.product[0].power[i] == 0;
    }
    *coefficient = !alone          ? -1
                   : sum.count > 0 ? sum.product[0].coefficient
                                   : tape_constant(c->made->coefficients, 0.0);
    return alone;
}

static product_sum symbol_of(collecting *c, int i) {
    product_sum sum = {NULL, 0};
    unsigned char *power = powers_new(c->made);
    power[c->number[i]] = 1;
    enter(c, &sum, power, tape_constant(c->made->coefficients, 1.0));
    return sum;
}

/* x + sign * y */
static product_sum added(collecting *c, product_sum x, product_sum y, int sign) {
    tape *t = c->made->coefficients;
    product_sum sum = {NULL, 0};
    for (int i = 0; i < x.count; i++) {
        enter(c, &sum, x.product[i].power, x.product[i].coefficient);
    }
    for (int i = 0; i < y.count; i++) {
        const int with = y.product[i].coefficient;
        enter(c, &sum, y.product[i].power, sign < 0 ? tape_unary(t, OP_NEG, with) : with);
    }
    return sum;
}

static product_sum multiplied(collecting *c, product_sum x, product_sum y) {
    products *p = c->made;
    product_sum sum = {NULL, 0};
    for (int i = 0; i < x.count; i++) {
        for (int k = 0; k < y.count && c->why->reason == NULL; k++) {
            unsigned char *power = powers_new(p);
            for (int s = 0; s < p->symbols; s++) {
                const int both = x.product[i].power[s] + y.product[k].power[s];
                power[s] = (unsigned char)both;
                if (both > 64) {
                    refuse(c, "take a rate, an input or a real to more than its 64th power", NULL);
                }
            }
            enter(c, &sum, power,
                  tape_mul(p->coefficients, x.product[i].coefficient, y.product[k].coefficient));
        }
    }
    return sum;
}

static product_sum divided(collecting *c, product_sum x, product_sum y) {
    product_sum sum = {NULL, 0};
    int by;
    if (!is_of_angles(c, y, &by)) {
        refuse(c, "are divided by what depends on a rate, an input or a real",
               "tables take what is divided by the one turn angle's functions only");
        return sum;
    }
    for (int i = 0; i < x.count; i++) {
        enter(c, &sum, x.product[i].power,
              tape_div(c->made->coefficients, x.product[i].coefficient, by));
    }
    return sum;
}

/* A function of one or two operands, of the angles alone. */
static product_sum function_of(collecting *c, const op *o) {
    tape *t = c->made->coefficients;
    int a;
    int b = -1;
    if (!is_of_angles(c, c->sum[o->a], &a) ||
        (op_rows[o->code].values > 1 && o->b >= 0 && !is_of_angles(c, c->sum[o->b], &b))) {
        refuse(c, "hold a function (a root, a size, a sign, ...) of a rate, an input or a real",
               "tables take products of these, no functions of them");
        return (product_sum){NULL, 0};
    }
    if (o->code == OP_ABS || o->code == OP_SIGN || o->code == OP_MIN || o->code == OP_MAX) {
        refuse(c, "have a bend or a jump at some angle (a size, a sign, a least or a largest)",
               "between the entries of a table it would be smoothed out: leave --tables out");
        return (product_sum){NULL, 0};
    }
    return of_angles(c, o->code == OP_CALL  ? tape_call(t, o->function, a, b)
                        : o->code == OP_POW ? tape_pow(t, a, b)
                                            : tape_unary(t, o->code, a));
}

static product_sum wave_of(collecting *c, const op *o) {
    tape *t = c->made->coefficients;
    const op *phase = &c->list->ops[o->a];
    double *multiple = NULL;
    if (phase->b >= 0 || phase->parts != NULL) {
        refuse(c, "hold a sine or cosine of what is no turn angle",
               "an angle that stands outside sines, too, is kept in radians: leave --tables out");
        return (product_sum){NULL, 0};
    }
    if (phase->turns != NULL) {
        multiple = room(t->angles, sizeof *multiple);
        for (int k = 0; k < t->angles; k++) {
            multiple[k] = phase->turns[k];
        }
    }
    const int copy = tape_phase(t, multiple, phase->value, -1);
    free(multiple);
    return of_angles(c, tape_leaf(t, o->code, copy));
}

static product_sum sum_of(collecting *c, int i) {
    const op *o = &c->list->ops[i];
    const product_sum none = {NULL, 0};
    switch (o->code) {
    case OP_CONSTANT: return of_angles(c, tape_constant(c->made->coefficients, o->value));
    case OP_LINEAR:
    case OP_RATE:
    case OP_INPUT: return symbol_of(c, i);
    case OP_PHASE: return none;
    case OP_SIN:
    case OP_COS: return wave_of(c, o);
    case OP_ADD: return added(c, c->sum[o->a], c->sum[o->b], 1);
    case OP_SUB: return added(c, c->sum[o->a], c->sum[o->b], -1);
    case OP_NEG: return added(c, none, c->sum[o->a], -1);
    case OP_MUL: return multiplied(c, c->sum[o->a], c->sum[o->b]);
    case OP_DIV: return divided(c, c->sum[o->a], c->sum[o->b]);
    case OP_SQRT:
    case OP_ABS:
    case OP_SIGN:
    case OP_MIN:
    case OP_MAX:
    case OP_CALL:
    case OP_POW: return function_of(c, o);
    case OP_ACCEL: /* in no step */
    case OP_TIME:
    case OP_RADIANS:
    case OP_NOISE:
    case OP_CELL:
    case OP_LINE:
    case OP_CUBIC: break;
    }
    abort();
}

products products_of(const tape *list, refusal *why) {
    products p = {.coefficients = tape_new(list->angles, 0),
                  .result = room(list->results, sizeof *p.result),
                  .results = list->results,
                  .memory = arena_new()};
    collecting c = {&p, list, room(list->count, sizeof *c.sum), room(list->count, sizeof *c.number),
                    why};
    *why = (refusal){NULL, NULL, -1};
    find_symbols(&c);
    for (int i = 0; i < list->count && why->reason == NULL; i++) {
        c.sum[i] = sum_of(&c, i);
    }
    for (int i = 0; i < list->results; i++) {
        p.result[i] = c.sum[list->result[i]];
    }
    free(c.sum);
    free(c.number);
    return p;
}

void products_free(products *p) {
    tape_free(p->coefficients);
    free(p->symbol);
    free(p->result);
    arena_free(p->memory);
}

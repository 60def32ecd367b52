/* tables.c: a step's list as sums of products of rates, inputs and reals, with functions of angles as coefficients. */
#include "host/image/tables.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/step/table.h"
#include "host/base/alloc.h"
#include "host/image/lower.h"
#include "host/number/ratio.h"

/* === functions of one angle and their slopes, at any angle ==================================== */

/* The value of an operation at an angle. */
typedef struct turn_value {
    double value;
    double slope; /* derivative by the angle in turns */
    double size;  /* sum of the sizes of all addends; the round-off of `value` is 1e-16 of it */
} turn_value;

#define TURN_RAD 6.283185307179586477

/* Sine and cosine, exact at quarter turns and with exact symmetries. */
static void turn_wave_of(double turns, double *sine, double *cosine) {
    const double quarters = number_even(4.0 * turns);
    const double rest_rad = (turns - 0.25 * quarters) * TURN_RAD;
    const double s = number_sine(rest_rad);
    const double c = number_cosine(rest_rad);
    const int quarter = (int)(quarters - 4.0 * number_floor(0.25 * quarters));
    *sine = quarter == 0 ? s : quarter == 1 ? c : quarter == 2 ? -s : -c;
    *cosine = quarter == 0 ? c : quarter == 1 ? -s : quarter == 2 ? -c : s;
}

static turn_value turn_product_of(turn_value x, turn_value y) {
    return (turn_value){x.value * y.value, x.slope * y.value + x.value * y.slope, x.size * y.size};
}

static turn_value quotient_of(turn_value x, turn_value y) {
    const double value = x.value / y.value;
    return (turn_value){value, (x.slope - value * y.slope) / y.value,
                        (x.size + fabs(value) * y.size) / fabs(y.value)};
}

static turn_value turn_function_of(function_id function, turn_value x, turn_value y) {
    const bool two = function_arguments(function) > 1;
    const double value = number_call(function, x.value, y.value);
    const double slope = number_slope(function, 0, x.value, y.value) * x.slope +
                         (two ? number_slope(function, 1, x.value, y.value) * y.slope : 0.0);
    return (turn_value){value, slope, fabs(value)};
}

static turn_value power_of(turn_value x, turn_value y) {
    const double value = number_power(x.value, y.value);
    const double by_exponent =
        y.slope == 0.0 ? 0.0 : value * number_call(FN_LOG, x.value, 0.0) * y.slope;
    const double by_base =
        x.value != 0.0 ? y.value * value / x.value : y.value * number_power(0.0, y.value - 1.0);
    return (turn_value){value, by_base * x.slope + by_exponent, fabs(value)};
}

static turn_value of_wave(op_code code, double turns, int multiple) {
    double sine;
    double cosine;
    turn_wave_of(turns, &sine, &cosine);
    return code == OP_SIN
               ? (turn_value){sine, TURN_RAD * multiple * cosine, multiple != 0 ? 1.0 : fabs(sine)}
               : (turn_value){cosine, -TURN_RAD * multiple * sine,
                              multiple != 0 ? 1.0 : fabs(cosine)};
}

/* Writes the values of all operations at the angle `turns` to value[t->count]. The list must not depend on other
 * variables. If operation i is a phase, it is multiple[i] * turns plus a constant. */
static void turn_evaluate(const op_list *t, const int *multiple, double turns, turn_value *value) {
    for (int i = 0; i < t->count; i++) {
        const op *o = &t->ops[i];
        const int values = op_rows[o->code].values;
        const turn_value none = {0.0, 0.0, 0.0};
        const turn_value x = values > 0 ? value[o->a] : none;
        const turn_value y = values > 1 && o->b >= 0 ? value[o->b] : none;
        switch (o->code) {
        case OP_CONSTANT: value[i] = (turn_value){o->value, 0.0, fabs(o->value)}; break;
        case OP_SIN:
        case OP_COS: {
            const double way = multiple[o->a] * turns;
            const double within = way - number_floor(way);
            value[i] = of_wave(o->code, within + t->ops[o->a].value / TURN_RAD, multiple[o->a]);
            break;
        }
        case OP_ADD:
            value[i] = (turn_value){x.value + y.value, x.slope + y.slope, x.size + y.size};
            break;
        case OP_SUB:
            value[i] = (turn_value){x.value - y.value, x.slope - y.slope, x.size + y.size};
            break;
        case OP_NEG: value[i] = (turn_value){-x.value, -x.slope, x.size}; break;
        case OP_MUL: value[i] = turn_product_of(x, y); break;
        case OP_DIV: value[i] = quotient_of(x, y); break;
        case OP_SQRT: value[i] = turn_function_of(FN_SQRT, x, y); break;
        case OP_CALL: value[i] = turn_function_of(o->function, x, y); break;
        case OP_POW: value[i] = power_of(x, y); break;
        case OP_PHASE:  /* a phase has no value */
        case OP_LINEAR: /* OP_LINEAR ... OP_CUBIC are never in a list of functions of one angle */
        case OP_RATE:
        case OP_INPUT:
        case OP_ACCEL:
        case OP_TIME:
        case OP_RADIANS:
        case OP_NOISE:
        case OP_ABS:
        case OP_SIGN:
        case OP_MIN:
        case OP_MAX:
        case OP_CELL:
        case OP_LINE:
        case OP_CUBIC: value[i] = none; break;
        }
    }
}

/* === the numbers in the cells of tables ======================================================= */
/* The pieces of a table meet at knots, h apart. A straight piece of the function f has the largest error h^2/8 f'' and
 * the average error h^2/12 f''. A cubic piece has the largest error h^4/384 f'''' and the average error h^4/720 f''''.
 * A rotating mechanism accumulates the average error, so corrected() subtracts an estimate of this error. */

typedef struct table_functions {
    const op_list *list;
    const int *multiple; /* [list->count] as in turn_evaluate() */
    const int *function; /* [tables] index of each table's function in the list */
} table_functions;

/* `cells` must be a power of two. */
static double corrected(const double *of, int cells, int at, int terms) {
    const int last = cells - 1;
    const double here = of[at & last];
    const double beside = of[(at - 1) & last] + of[(at + 1) & last];
    return terms == WH_TABLE_LINEAR
               ? here - (beside - 2.0 * here) / 12.0
               : here + ((of[(at - 2) & last] + of[(at + 2) & last]) - 4.0 * beside + 6.0 * here) /
                            720.0;
}

/* Writes cell i, between knots i and i + 1. */
static void write_cell(const double *value, const double *slope, int cells, int i, int terms,
                       double *number) {
    const double left = corrected(value, cells, i, terms);
    const double right = corrected(value, cells, i + 1, terms);
    number[0] = 0.5 * (left + right);
    number[1] = right - left;
    if (terms == WH_TABLE_CUBIC) {
        const double slope_left = corrected(slope, cells, i, terms);
        const double slope_right = corrected(slope, cells, i + 1, terms);
        number[2] = 0.5 * (slope_right - slope_left);
        number[3] = (slope_left + slope_right) - 2.0 * number[1];
        number[0] -= 0.25 * number[2];
        number[1] -= 0.25 * number[3];
    }
}

/* Is table k, to the last bit, an even function of the angle? If `odd`: an odd function? */
static bool mirrors(const op_list_tables *of, int k, bool odd) {
    const int n = 1 << of->bits;
    for (int i = 0; i <= n / 2; i++) {
        const double *here = &of->number[(i * of->count + k) * of->terms];
        const double *there = &of->number[(((n - i) & (n - 1)) * of->count + k) * of->terms];
        for (int c = 0; c < of->terms; c++) {
            const bool opposite = (c % 2 != 0) != odd;
            if (here[c] != (opposite ? -there[c] : there[c])) {
                return false;
            }
        }
    }
    return true;
}

/* Finds the largest errors at TRIED points of each cell, including the middle and the knots. */
static void set_errors(const table_functions *f, op_list_tables *of) {
    enum { TRIED = 16 };
    const op_list *c = f->list;
    const int n = 1 << of->bits;
    turn_value *all = alloc(c->count, sizeof *all);
    for (int i = 0; i < n * TRIED; i++) {
        const double y = (double)(i % TRIED) / TRIED - 0.5;
        const int cell = i / TRIED;
        turn_evaluate(c, f->multiple, (cell + y) / n, all);
        for (int k = 0; k < of->count; k++) {
            const double *number = &of->number[(cell * of->count + k) * of->terms];
            double value = 0.0;
            for (int power = of->terms - 1; power >= 0; power--) {
                value = number[power] + y * value;
            }
            const double exact = all[f->function[k]].value;
            of->size[k] = number_most(of->size[k], fabs(exact));
            of->off[k] = number_most(of->off[k], fabs(value - exact));
        }
    }
    free(all);
}

static void table_numbers(const table_functions *f, op_list_tables *into) {
    const op_list *c = f->list;
    const int n = 1 << into->bits;
    turn_value *all = alloc(c->count, sizeof *all);
    double *value = alloc((int64_t)into->count * n, sizeof *value);
    double *slope = alloc((int64_t)into->count * n, sizeof *slope);
    for (int i = 0; i < n; i++) {
        turn_evaluate(c, f->multiple, (i - 0.5) / n, all);
        for (int k = 0; k < into->count; k++) {
            value[k * n + i] = all[f->function[k]].value;
            slope[k * n + i] = all[f->function[k]].slope / n;
        }
    }
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < into->count; k++) {
            double *number = &into->number[(i * into->count + k) * into->terms];
            write_cell(&value[k * n], &slope[k * n], n, i, into->terms, number);
            for (int power = 0; power < into->terms; power++) {
                number[power] =
                    number[power] == 0.0 ? 0.0 : number[power]; /* never a negative zero */
            }
        }
    }
    into->folds = true;
    for (int k = 0; k < into->count; k++) {
        into->odd[k] = mirrors(into, k, true);
        into->folds = into->folds && (into->odd[k] || mirrors(into, k, false));
    }
    set_errors(f, into);
    free(all);
    free(value);
    free(slope);
}

/* === a list as sums of products =============================================================== */
enum { PRODUCTS_MOST = 128 }; /* products in a sum */

/* coefficient * symbol[0]^power[0] * symbol[1]^power[1] ... */
typedef struct term_product {
    const unsigned char *power; /* [symbols] */
    int coefficient;            /* index of its operation in the list products.coefficients */
} term_product;

typedef struct product_sum {
    term_product *product; /* [count], all with different powers */
    int count;
} product_sum;

typedef struct products {
    op_list *coefficients; /* they depend on turn angles only */
    int *symbol; /* [symbols] index of an OP_LINEAR, OP_RATE or OP_INPUT in the step's list */
    int symbols;
    product_sum *result; /* [results of the list] */
    int results;
    struct arena *memory;
} products;

/* The conversion adds sums, multiplies them out, and divides them by functions of the angles. This is its state. */
typedef struct collecting {
    products *made;
    const op_list *list;
    product_sum *sum; /* [list->count] */
    int *number;      /* [list->count] index in made->symbol, or -1 if the operation is no symbol */
    refusal *why;
} collecting;

static void refuse(refusal *why, const char *reason, const char *hint, int angle) {
    if (why->reason == NULL) {
        *why = (refusal){reason, hint, angle};
    }
}

static void find_symbols(collecting *c) {
    products *p = c->made;
    p->symbol = alloc(c->list->count, sizeof *p->symbol);
    for (int i = 0; i < c->list->count; i++) {
        const op_code code = c->list->ops[i].code;
        const bool is_symbol = code == OP_LINEAR || code == OP_RATE || code == OP_INPUT;
        c->number[i] = is_symbol ? p->symbols : -1;
        if (is_symbol) {
            p->symbol[p->symbols++] = i;
        }
    }
}

/* Allocates at least one byte, so that every product has its own address. */
static unsigned char *powers_new(const products *p) {
    return arena_alloc(p->memory, (size_t)p->symbols + 1U);
}

static bool is_zero(const op_list *t, int a) {
    double value;
    return op_list_is_constant(t, a, &value) && value == 0.0;
}

/* Adds a product to the sum. Removes products whose coefficient becomes zero. */
static void enter(collecting *c, product_sum *sum, const unsigned char *power, int coefficient) {
    products *p = c->made;
    for (int i = 0; i < sum->count; i++) {
        term_product *same = &sum->product[i];
        if (memcmp(same->power, power, (size_t)p->symbols) == 0) {
            same->coefficient = op_list_add(p->coefficients, same->coefficient, coefficient);
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
        refuse(c->why, "are sums of too many products of rates, inputs and coordinates",
               "leave out --tables: without tables these equations take fewer operations", -1);
        return;
    }
    sum->product = arena_room(p->memory, sum->product, sum->count, sizeof *sum->product);
    sum->product[sum->count++] = (term_product){power, coefficient};
}

/* The product of a coefficient and symbol number `of` (-1: none). */
static product_sum single(collecting *c, int of, int coefficient) {
    product_sum sum = {NULL, 0};
    unsigned char *power = powers_new(c->made);
    if (of >= 0) {
        power[of] = 1;
    }
    enter(c, &sum, power, coefficient);
    return sum;
}

/* Does the sum depend only on the angles? If so, *coefficient becomes the index of an operation with its value. */
static bool is_of_angles(collecting *c, product_sum sum, int *coefficient) {
    bool alone = sum.count <= 1;
    for (int i = 0; i < c->made->symbols && sum.count == 1; i++) {
        alone = alone && sum.product[0].power[i] == 0;
    }
    *coefficient = !alone          ? -1
                   : sum.count > 0 ? sum.product[0].coefficient
                                   : op_list_constant(c->made->coefficients, 0.0);
    return alone;
}

static product_sum added(collecting *c, product_sum x, product_sum y, int sign) {
    op_list *t = c->made->coefficients;
    product_sum sum = {NULL, 0};
    for (int i = 0; i < x.count; i++) {
        enter(c, &sum, x.product[i].power, x.product[i].coefficient);
    }
    for (int i = 0; i < y.count; i++) {
        const int with = y.product[i].coefficient;
        enter(c, &sum, y.product[i].power, sign < 0 ? op_list_unary(t, OP_NEG, with) : with);
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
                    refuse(c->why, "raise a rate, an input or a coordinate to a power above 64",
                           NULL, -1);
                }
            }
            enter(c, &sum, power,
                  op_list_mul(p->coefficients, x.product[i].coefficient, y.product[k].coefficient));
        }
    }
    return sum;
}

static product_sum divided(collecting *c, product_sum x, product_sum y) {
    product_sum sum = {NULL, 0};
    int by;
    if (!is_of_angles(c, y, &by)) {
        refuse(c->why,
               "have a denominator with a rate, an input, or a coordinate other than a turn angle",
               "leave out --tables: with tables, a denominator may depend only on the turn angle",
               -1);
        return sum;
    }
    for (int i = 0; i < x.count; i++) {
        enter(c, &sum, x.product[i].power,
              op_list_div(c->made->coefficients, x.product[i].coefficient, by));
    }
    return sum;
}

/* Enters a function whose one or two operands depend only on the angles. */
static product_sum function_of(collecting *c, const op *o) {
    op_list *t = c->made->coefficients;
    int a;
    int b = -1;
    if (!is_of_angles(c, c->sum[o->a], &a) ||
        (op_rows[o->code].values > 1 && o->b >= 0 && !is_of_angles(c, c->sum[o->b], &b))) {
        refuse(
            c->why,
            "contain a function (a root, abs, sign, ...) of a rate, an input, or a coordinate other than a turn angle",
            "leave out --tables: with tables, such quantities may occur only in sums and products",
            -1);
        return (product_sum){NULL, 0};
    }
    if (o->code == OP_ABS || o->code == OP_SIGN || o->code == OP_MIN || o->code == OP_MAX) {
        refuse(c->why, "have a kink or a jump at some angle (abs, sign, min or max)",
               "leave out --tables: a table would smooth the kink", -1);
        return (product_sum){NULL, 0};
    }
    return single(c, -1,
                  o->code == OP_CALL  ? op_list_call(t, o->function, a, b)
                  : o->code == OP_POW ? op_list_pow(t, a, b)
                                      : op_list_unary(t, o->code, a));
}

static product_sum wave_of(collecting *c, const op *o) {
    op_list *t = c->made->coefficients;
    const op *phase = &c->list->ops[o->a];
    double *multiple = NULL;
    if (phase->b >= 0 || phase->parts != NULL) {
        refuse(
            c->why, "contain a sine or cosine of a quantity other than a turn angle",
            "leave out --tables: an angle that also occurs outside sines and cosines is stored in radians, not as a turn angle",
            -1);
        return (product_sum){NULL, 0};
    }
    if (phase->turns != NULL) {
        multiple = alloc(t->angles, sizeof *multiple);
        for (int k = 0; k < t->angles; k++) {
            multiple[k] = phase->turns[k];
        }
    }
    const int copy = op_list_phase(t, multiple, phase->value, -1);
    free(multiple);
    return single(c, -1, op_list_leaf(t, o->code, copy));
}

static product_sum sum_of(collecting *c, int i) {
    const op *o = &c->list->ops[i];
    const product_sum none = {NULL, 0};
    switch (o->code) {
    case OP_CONSTANT: return single(c, -1, op_list_constant(c->made->coefficients, o->value));
    case OP_LINEAR:
    case OP_RATE:
    case OP_INPUT: return single(c, c->number[i], op_list_constant(c->made->coefficients, 1.0));
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
    case OP_ACCEL:
    case OP_TIME:
    case OP_RADIANS:
    case OP_NOISE:
    case OP_CELL:
    case OP_LINE:
    case OP_CUBIC: break;
    }
    abort();
}

static products products_of(const op_list *list, refusal *why) {
    products p = {.coefficients = op_list_new(list->angles, 0),
                  .result = alloc(list->results, sizeof *p.result),
                  .results = list->results,
                  .memory = arena_new()};
    p.coefficients->folding = list->folding;
    collecting c = {&p, list, alloc(list->count, sizeof *c.sum),
                    alloc(list->count, sizeof *c.number), why};
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

static void products_free(products *p) {
    op_list_free(p->coefficients);
    free(p->symbol);
    free(p->result);
    arena_free(p->memory);
}

/* === tables in the place of sines and divisions =============================================== */

enum { TRIES = 4096 }; /* angles at which coefficients are compared */

/* Values closer than this, relative to the sum of absolute addends, are equal. */
#define ALIKE 1e-13

/* A denominator counts as reaching zero if its size falls below this part of its maximum. */
#define POLE 1e-6

typedef enum coefficient_kind { IS_NOTHING, IS_CONSTANT, IS_TABLE } coefficient_kind;

typedef struct coefficient {
    int of; /* index of its operation in products.coefficients */
    coefficient_kind kind;
    int table;
    double factor; /* factor of the table, or the constant itself */
    double *value; /* [TRIES] */
    double size;   /* largest turn_value.size at the tried angles */
} coefficient;

typedef struct tabling {
    products *from;
    refusal *why;
    int *turns;    /* [angles] the tables' phase is the sum of turns[i] * (turn angle i) */
    int *multiple; /* [coefficients->count] argument of turn_evaluate() for the tables' phase */
    coefficient *coefficient; /* [count] first all of result 0, then all of result 1, ... */
    int count;
    int *table; /* [tables] index of each table's function in products.coefficients */
    int tables;
} tabling;

int tables_cells(image_tables form) {
    return form == TABLES_CUBIC ? TABLES_CELLS_CUBIC : TABLES_CELLS_LINEAR;
}

static int leading(const int *turns, int angles) {
    int k = 0;
    while (k < angles - 1 && turns[k] == 0) {
        k++;
    }
    return k;
}

/* Are `turns` and `other` multiples of one phase? *turns becomes the largest such phase. */
static bool shares(int *turns, const int *other, int angles) {
    const int k = leading(turns, angles);
    const int common = (int)ratio_divisor((uint64_t)abs(turns[k]), (uint64_t)abs(other[k]));
    for (int i = 0; i < angles; i++) {
        if ((int64_t)turns[i] * other[k] != (int64_t)other[i] * turns[k]) {
            return false;
        }
    }
    const int before = turns[k];
    for (int i = 0; i < angles; i++) {
        turns[i] = (int)((int64_t)turns[i] * common / abs(before));
    }
    return true;
}

static void find_phase(tabling *t) {
    const op_list *c = t->from->coefficients;
    bool found = false;
    for (int i = 0; i < c->count && t->why->reason == NULL; i++) {
        const int *turns = c->ops[i].turns;
        if (!op_list_is_wave(&c->ops[i])) {
            continue;
        }
        if (!found) {
            memcpy(t->turns, turns, (size_t)c->angles * sizeof *turns);
            found = true;
        } else if (!shares(t->turns, turns, c->angles)) {
            refuse(t->why, "depend on the sines of more than one turn angle",
                   "leave out --tables: a table depends on one angle, or on one sum of angles",
                   leading(turns, c->angles));
        }
    }
    const int k = leading(t->turns, c->angles);
    for (int i = 0; i < c->count; i++) {
        t->multiple[i] = op_list_is_wave(&c->ops[i]) ? c->ops[i].turns[k] / t->turns[k] : 0;
    }
}

typedef struct span_of {
    double least;
    double most;
} span_of;

static void try_angles(tabling *t) {
    const op_list *c = t->from->coefficients;
    turn_value *value = alloc(c->count, sizeof *value);
    span_of *span = alloc(c->count, sizeof *span);
    bool finite = true;
    for (int s = 0; s < TRIES; s++) {
        turn_evaluate(c, t->multiple, (double)s / TRIES, value);
        for (int i = 0; i < c->count; i++) {
            span[i].least = s > 0 ? number_least(span[i].least, value[i].value) : value[i].value;
            span[i].most = s > 0 ? number_most(span[i].most, value[i].value) : value[i].value;
        }
        for (int k = 0; k < t->count; k++) {
            coefficient *of = &t->coefficient[k];
            of->value[s] = value[of->of].value;
            of->size = number_most(of->size, value[of->of].size);
            finite = finite && isfinite(of->value[s]) && isfinite(value[of->of].slope);
        }
    }
    for (int i = 0; i < c->count; i++) {
        const span_of by = c->ops[i].code == OP_DIV ? span[c->ops[i].b] : (span_of){1.0, 1.0};
        const double nearest = number_least(fabs(by.least), fabs(by.most));
        const double farthest = number_most(fabs(by.least), fabs(by.most));
        if (!(by.least * by.most > 0.0 && nearest > POLE * farthest)) {
            finite = false;
        }
    }
    if (!finite) {
        refuse(t->why,
               "have no finite value or slope at some angle (a division by zero, a root of zero)",
               "leave out --tables: a table holds only finite numbers", -1);
    }
    free(value);
    free(span);
}

static bool is_constant(const coefficient *c) {
    for (int s = 0; s < TRIES; s++) {
        if (!(fabs(c->value[s] - c->value[0]) <= ALIKE * c->size)) {
            return false;
        }
    }
    return true;
}

/* Is `c`, which is largest at `peak`, a multiple of `of`? */
static bool is_multiple(const coefficient *c, int peak, const coefficient *of, double *factor) {
    *factor = of->value[peak] != 0.0 ? c->value[peak] / of->value[peak] : 0.0;
    const double size = c->size + fabs(*factor) * of->size;
    for (int s = 0; s < TRIES; s++) {
        if (!(fabs(c->value[s] - *factor * of->value[s]) <= ALIKE * size)) {
            return false;
        }
    }
    if (fabs(fabs(*factor) - 1.0) <= ALIKE) {
        *factor = *factor < 0.0 ? -1.0 : 1.0;
    }
    return *factor != 0.0;
}

static void sort_out(tabling *t) {
    int *first = alloc(t->count, sizeof *first); /* index of the first coefficient of each table */
    for (int k = 0; k < t->count; k++) {
        coefficient *c = &t->coefficient[k];
        int peak = 0;
        for (int s = 1; s < TRIES; s++) {
            peak = fabs(c->value[s]) > fabs(c->value[peak]) ? s : peak;
        }
        c->kind = IS_TABLE;
        c->table = -1;
        if (fabs(c->value[peak]) <= ALIKE * c->size) {
            c->kind = IS_NOTHING;
        } else if (is_constant(c)) {
            c->kind = IS_CONSTANT;
            c->factor = c->value[0];
        }
        for (int i = 0; i < t->tables && c->kind == IS_TABLE && c->table < 0; i++) {
            if (is_multiple(c, peak, &t->coefficient[first[i]], &c->factor)) {
                c->table = i;
            }
        }
        if (c->kind == IS_TABLE && c->table < 0) {
            c->factor = 1.0;
            c->table = t->tables;
            first[t->tables] = k;
            t->table[t->tables++] = c->of;
        }
    }
    free(first);
}

/* Returns the operation of a result. The result's coefficients begin at t->coefficient[at]. */
static int write_result(const tabling *t, const op_list *list, lowering *l, int cell, int result,
                        int at) {
    const product_sum *sum = &t->from->result[result];
    node_product *all = alloc(sum->count, sizeof *all);
    int count = 0;
    for (int i = 0; i < sum->count; i++) {
        const coefficient *c = &t->coefficient[at + i];
        if (c->kind == IS_NOTHING) {
            continue;
        }
        node_product *p = &all[count++];
        p->coefficient = c->factor;
        if (c->kind == IS_TABLE) {
            lower_multiply(l, p, op_list_look_up(l->list, cell, c->table), 1);
        }
        for (int s = 0; s < t->from->symbols; s++) {
            const op *o = &list->ops[t->from->symbol[s]];
            if (sum->product[i].power[s] > 0) {
                lower_multiply(l, p, op_list_leaf(l->list, o->code, o->a),
                               sum->product[i].power[s]);
            }
        }
    }
    const int made = lower_sum(l, all, count);
    free(all);
    return made;
}

static op_list *write_list(const tabling *t, const op_list *list, image_tables form, int bits) {
    op_list *made = op_list_new(list->angles, list->results);
    made->folding = list->folding;
    lowering l = {.list = made};
    const table_functions functions = {t->from->coefficients, t->multiple, t->table};
    op_list_tables_new(made, t->tables, bits,
                       (int)(form == TABLES_CUBIC ? WH_TABLE_CUBIC : WH_TABLE_LINEAR));
    const int cell = op_list_cell(made, t->turns);
    int at = 0;
    for (int i = 0; i < list->results; i++) {
        made->result[i] = write_result(t, list, &l, cell, i, at);
        at += t->from->result[i].count;
    }
    lower_done(&l);
    op_list_prune(made);
    table_numbers(&functions, &made->tables);
    op_list_order(made);
    return made;
}

static void take_coefficients(tabling *t) {
    for (int i = 0; i < t->from->results; i++) {
        t->count += t->from->result[i].count;
    }
    t->coefficient = alloc(t->count, sizeof *t->coefficient);
    t->table = alloc(t->count, sizeof *t->table);
    for (int i = 0, at = 0; i < t->from->results; i++) {
        for (int k = 0; k < t->from->result[i].count; k++, at++) {
            t->coefficient[at].of = t->from->result[i].product[k].coefficient;
            t->coefficient[at].value = alloc(TRIES, sizeof *t->coefficient[at].value);
        }
    }
}

/* Returns the list with tables, or NULL if it is refused (t->why). */
static op_list *make(tabling *t, const op_list *list, image_tables form, int bits,
                     op_list **exact) {
    find_phase(t);
    if (t->why->reason != NULL) {
        return NULL;
    }
    take_coefficients(t);
    try_angles(t);
    if (t->why->reason != NULL) {
        return NULL;
    }
    sort_out(t);
    if (t->tables == 0) {
        refuse(t->why, "depend on no turn angle: there is nothing to look up", "leave out --tables",
               -1);
        return NULL;
    }
    op_list *made = write_list(t, list, form, bits);
    *exact = t->from->coefficients;
    t->from->coefficients = NULL;
    free((*exact)->result);
    (*exact)->result = t->table;
    (*exact)->results = t->tables;
    t->table = NULL;
    op_list_prune(*exact);
    return made;
}

op_list *tables_make(const op_list *list, image_tables form, int cells, op_list **exact,
                     refusal *why) {
    products p = products_of(list, why);
    tabling t = {.from = &p,
                 .why = why,
                 .turns = alloc(list->angles, sizeof *t.turns),
                 .multiple = alloc(p.coefficients->count, sizeof *t.multiple)};
    int bits = 0;
    while ((1 << bits) < cells) {
        bits++;
    }
    op_list *made = why->reason == NULL ? make(&t, list, form, bits, exact) : NULL;
    for (int k = 0; k < t.count; k++) {
        free(t.coefficient[k].value);
    }
    free(t.coefficient);
    free(t.table);
    free(t.turns);
    free(t.multiple);
    products_free(&p);
    return made;
}

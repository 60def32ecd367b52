#include "rounding.h"

#include <math.h>
#include <stdlib.h>

#include "host/base/alloc.h"

#define FLOAT_MOST 0x1.fffffep127 /* larger values are infinite in float */
#define ALL_LOST 0x1p24           /* in unit round-offs of float; a relative error of 1 */

static bool is_beyond(const rounding_values *at, double value) {
    return at->least > 0.0 && fabs(value) > FLOAT_MOST;
}

/* The error of an OP_PHASE. Each of its terms is rounded. `more`: error of operand b. */
static double of_phase(const op_list *t, const op *o, const rounding_values *at, double more) {
    double size = fabs(o->value);
    for (int i = 0; i < t->angles; i++) {
        if (o->turns != NULL) {
            size += fabs(o->turns[i] * at->phase_rad[i]);
        }
        if (o->parts != NULL) {
            size += fabs(o->parts[i] * at->angle_rad[i]);
        }
    }
    return size + (o->b >= 0 ? fabs(at->value[o->b]) + more : 0.0);
}

/* The error of a function of (x, y), by its slopes, if x and y have the errors `a` and `b`. */
static double of_call(function_id function, double x, double y, double a, double b) {
    const double by_x = fabs(number_slope(function, 0, x, y)) * a;
    return function_arguments(function) == 1 ? by_x
                                             : by_x + fabs(number_slope(function, 1, x, y)) * b;
}

/* The error that the operands' errors cause. *rounds: the result is rounded, too. */
static double carried(const op_list *t, const op *o, const rounding_values *at, const double *error,
                      double v, bool *rounds) {
    const int values = op_rows[o->code].values;
    const double x = values > 0 ? at->value[o->a] : 0.0;
    const double y = values > 1 && o->b >= 0 ? at->value[o->b] : 0.0;
    const double a = values > 0 ? error[o->a] : 0.0;
    const double b = values > 1 && o->b >= 0 ? error[o->b] : 0.0;
    *rounds = false;
    switch (o->code) {
    case OP_CONSTANT: /* if float represents it exactly, it has no round-off in either number type */
        return (double)(float)o->value == o->value ? 0.0 : fabs(o->value);
    case OP_LINEAR:
    case OP_RATE:
    case OP_INPUT:
    case OP_ACCEL:
    case OP_TIME:
    case OP_RADIANS:
    case OP_NOISE:
    case OP_CELL:
    case OP_SIGN: return 0.0;
    case OP_PHASE: return of_phase(t, o, at, o->b >= 0 ? error[o->b] : 0.0);
    /* The interpolation error is not included. */
    case OP_LINE:
    case OP_CUBIC: *rounds = true; return fabs(v);
    case OP_SIN: return 1.0 + a * fabs(at->cosine[o->a]);
    case OP_COS: return 1.0 + a * fabs(at->sine[o->a]);
    case OP_NEG:
    case OP_ABS: return a;
    case OP_MIN:
    case OP_MAX: return v == x ? a : b;
    case OP_ADD:
    case OP_SUB: *rounds = true; return a + b;
    case OP_MUL: *rounds = true; return fabs(y) * a + fabs(x) * b;
    case OP_DIV:
        *rounds = true;
        return is_beyond(at, y) ? fabs(v) * ALL_LOST : (a + fabs(v) * b) / fabs(y);
    case OP_SQRT: *rounds = true; return a == 0.0 ? 0.0 : a / (2.0 * v);
    case OP_CALL: *rounds = true; return of_call(o->function, x, y, a, b);
    case OP_POW:
        *rounds = true;
        return fabs(v) * ((a == 0.0 ? 0.0 : fabs(y) * a / fabs(x)) +
                          (b == 0.0 ? 0.0 : fabs(number_call(FN_LOG, fabs(x), 0.0)) * b));
    }
    return 0.0;
}

void rounding_of(const op_list *t, const rounding_values *at, double *error) {
    double *each = alloc(t->count, sizeof *each);
    for (int i = 0; i < t->count; i++) {
        bool rounds;
        each[i] = carried(t, &t->ops[i], at, each, at->value[i], &rounds);
        const double size = fabs(at->value[i]);
        each[i] += !rounds ? 0.0 : size < at->least ? at->least : size;
        if (is_beyond(at, size)) {
            each[i] = (double)INFINITY;
        }
    }
    for (int i = 0; i < t->results; i++) {
        error[i] = each[t->result[i]];
    }
    free(each);
}

/* tape_bias.c: what a list's constants, rounded to float, do to what it computes. */
#include <math.h>
#include <stdlib.h>

#include "host/base/room.h"
#include "tape_gauge.h"

enum { SIZES = 3, STATES = 6 };

/* Of rates and of whatever else is no position: at rest forces and torques count, fast the rates alone. */
static const double size_of_rates[SIZES] = {0.0, 1.0, 10.0};

/* A number between -1 and 1 for this leaf in this state. */
static double drawn(op_code code, int which, int state) {
    uint64_t x = (uint64_t)code * 7919U + (uint64_t)which * 131U + (uint64_t)state * 1000003U + 1U;
    for (int i = 0; i < 3; i++) {
        x = (x ^ (x >> 31)) * UINT64_C(0x9e3779b97f4a7c15);
    }
    return (double)(x >> 11) * 0x1p-52 - 1.0;
}

static double phase_at(const tape *t, const op *o, int state, double radians) {
    double sum = o->value + radians;
    for (int k = 0; k < t->angles; k++) {
        const double turns = o->turns != NULL ? o->turns[k] : 0.0;
        const double parts = o->parts != NULL ? o->parts[k] : 0.0;
        sum += (turns + parts) * 3.2 * drawn(OP_PHASE, k, state);
    }
    return sum;
}

static double value_at(const tape *t, const op *o, int state, double rates, bool as_float,
                       const double *v) {
    const double a = op_rows[o->code].values > 0 ? v[o->a] : 0.0;
    const double b =
        (op_rows[o->code].values > 1 || o->code == OP_PHASE) && o->b >= 0 ? v[o->b] : 0.0;
    switch (o->code) {
    case OP_CONSTANT: return as_float ? (double)(float)o->value : o->value;
    case OP_LINEAR: return drawn(o->code, o->a, state);
    case OP_RATE: return rates * drawn(o->code, o->a, state);
    case OP_INPUT:
    case OP_ACCEL:
    case OP_TIME:
    case OP_RADIANS:
    case OP_CELL:
    case OP_LINE:
    case OP_CUBIC:
    case OP_NOISE: return 2.0 + drawn(o->code, o->a, state);
    case OP_PHASE: return phase_at(t, o, state, b);
    case OP_SIN: return number_sine(a);
    case OP_COS: return number_cosine(a);
    case OP_ADD: return a + b;
    case OP_SUB: return a - b;
    case OP_MUL: return a * b;
    case OP_DIV: return a / b;
    case OP_NEG: return -a;
    case OP_SQRT: return number_root(a);
    case OP_ABS: return fabs(a);
    case OP_SIGN: return number_call(FN_SIGN, a, 0.0);
    case OP_MIN: return number_least(a, b);
    case OP_MAX: return number_most(a, b);
    case OP_CALL: return number_call(o->function, a, b);
    case OP_POW: return number_power(a, b);
    }
    abort();
}

/* The results of a list in a state: result[t->results]. */
static void results_at(const tape *t, int state, double rates, bool as_float, double *v,
                       double *result) {
    for (int i = 0; i < t->count; i++) {
        v[i] = value_at(t, &t->ops[i], state, rates, as_float, v);
    }
    for (int i = 0; i < t->results; i++) {
        result[i] = v[t->result[i]];
    }
}

/* What counts of an error in a result that no list reads again: a carriage's acceleration that nothing depends on ends as
 * much off as it is; another one's error grows with the motion. */
#define UNREAD (1.0 / 64.0)

/* Of each result, does the list depend on the component that it moves? Both orders: angles, then reals. */
static void weigh_results(const tape *t, double *weight) {
    for (int i = 0; i < t->results; i++) {
        weight[i] = UNREAD;
    }
    for (int i = 0; i < t->count; i++) {
        const op *o = &t->ops[i];
        const int component = o->code == OP_RATE     ? o->a
                              : o->code == OP_LINEAR ? t->angles + o->a
                                                     : t->results;
        if (component < t->results) {
            weight[component] = 1.0;
        }
        for (int k = 0; k < t->angles && k < t->results && o->turns != NULL; k++) {
            weight[k] = o->turns[k] != 0 ? 1.0 : weight[k];
        }
    }
}

double tape_bias(const tape *t, const tape *like) {
    const int n = t->results;
    double *v = room((int64_t)t->count + like->count, sizeof *v);
    double *off = room(5 * (int64_t)n, sizeof *off);
    double *size = off + n;
    double *now = off + 2 * n;
    double *meant = off + 3 * n;
    double *weight = off + 4 * n;
    double squares = 0.0;
    double entries = 0.0;
    weigh_results(like, weight);
    for (int s = 0; s < SIZES; s++) {
        for (int i = 0; i < n; i++) {
            off[i] = size[i] = 0.0;
        }
        for (int state = 0; state < STATES; state++) {
            results_at(t, state, size_of_rates[s], true, v, now);
            results_at(like, state, size_of_rates[s], false, v, meant);
            for (int i = 0; i < n; i++) {
                /* at a state where there is no such value, as below a root's zero, nothing is told */
                const bool told = isfinite(now[i]) && isfinite(meant[i]);
                off[i] += told ? fabs(now[i] - meant[i]) : 0.0;
                size[i] += told ? fabs(meant[i]) : 0.0;
            }
        }
        for (int i = 0; i < n; i++) {
            if (size[i] > 0.0) {
                const double relative = weight[i] * off[i] / size[i];
                squares += relative * relative;
                entries += weight[i] * weight[i];
            }
        }
    }
    free(v);
    free(off);
    return entries > 0.0 ? number_root(squares / entries) : (double)NAN;
}

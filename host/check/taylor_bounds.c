/* taylor_bounds.c: Taylor forms, with slopes by the share of the way. */
#include "taylor_bounds.h"

#include <math.h>
#include <stdlib.h>

#include "host/base/alloc.h"
#include "host/engine/engine.h"
#include "host/number/functions.h"

/* A value on a part of the way. NaN: not known. */
typedef struct form {
    enclosure middle;       /* at the middle of the part */
    enclosure middle_slope; /* its slope */
    enclosure value;        /* on the part, */
    enclosure slope;
    enclosure curve;
} form;

/* A function and its first two derivatives. */
typedef struct slopes {
    enclosure f[3];
} slopes;

struct taylor_bounds_bounds {
    const image *image;
    const op_list *list;
    double *input;      /* [inputs] */
    double (*cubic)[4]; /* [coordinates] the way's coefficients */
    double span_s;
    form *place;        /* [coordinates] */
    form *rate;         /* [coordinates] */
    form *of;           /* [operations] */
    bool *needs;        /* [results * operations] */
    enclosure *natural; /* [operations] bounds on the whole way, */
    bool glanced;       /* if they are known */
    double half;        /* of the part's width */
};

static const enclosure unknown = {(double)NAN, (double)NAN};
static const enclosure zero = {0.0, 0.0};
static const form no_form = {{(double)NAN, (double)NAN},
                             {(double)NAN, (double)NAN},
                             {(double)NAN, (double)NAN},
                             {(double)NAN, (double)NAN},
                             {(double)NAN, (double)NAN}};

taylor_bounds_bounds *taylor_bounds_open(const image *im, const op_list *t) {
    taylor_bounds_bounds *a = alloc(1, sizeof *a);
    const int n = im->coordinates;
    a->image = im;
    a->list = t;
    a->input = alloc(im->inputs, sizeof *a->input);
    image_inputs(im, a->input);
    a->cubic = alloc(n, sizeof *a->cubic);
    a->place = alloc(2 * (int64_t)n + t->count, sizeof *a->place);
    a->rate = a->place + n;
    a->of = a->rate + n;
    a->needs = alloc((int64_t)t->results * t->count, sizeof *a->needs);
    a->natural = alloc(t->count, sizeof *a->natural);
    for (int r = 0; r < t->results; r++) {
        bool *needs = a->needs + (ptrdiff_t)r * t->count;
        needs[t->result[r]] = true;
        for (int i = t->result[r]; i >= 0; i--) {
            int operand[2];
            for (int k = needs[i] ? op_list_operands(&t->ops[i], operand) : 0; k > 0; k--) {
                needs[operand[k - 1]] = true;
            }
        }
    }
    return a;
}

void taylor_bounds_close(taylor_bounds_bounds *a) {
    if (a != NULL) {
        free(a->input);
        free(a->cubic);
        free(a->place);
        free(a->needs);
        free(a->natural);
        free(a);
    }
}

/* --- forms ----------------------------------------------------------------------------------------------*/

/* The intersection, or the known one. Round-off may make it empty: then the first. */
static enclosure both(enclosure a, enclosure b) {
    if (!enclosure_is_finite(a) || !enclosure_is_finite(b)) {
        return enclosure_is_finite(a) ? a : b;
    }
    const enclosure c = {enclosure_larger(a.low, b.low), enclosure_lesser(a.high, b.high)};
    return c.low <= c.high ? c : a;
}

static enclosure twice(enclosure a) { return (enclosure){2.0 * a.low, 2.0 * a.high}; }

static form constant(double value) {
    const enclosure v = enclosure_of(value);
    return (form){v, zero, v, zero, zero};
}

static form plus(const form *a, const form *b) {
    return (form){enclosure_add(a->middle, b->middle),
                  enclosure_add(a->middle_slope, b->middle_slope),
                  enclosure_add(a->value, b->value), enclosure_add(a->slope, b->slope),
                  enclosure_add(a->curve, b->curve)};
}

static form times_number(const form *a, double x) {
    return (form){enclosure_times(a->middle, x), enclosure_times(a->middle_slope, x),
                  enclosure_times(a->value, x), enclosure_times(a->slope, x),
                  enclosure_times(a->curve, x)};
}

static form times(const form *a, const form *b) {
    if (a == b) {
        return (form){
            enclosure_square(a->middle), twice(enclosure_mul(a->middle, a->middle_slope)),
            enclosure_square(a->value), twice(enclosure_mul(a->value, a->slope)),
            twice(enclosure_add(enclosure_square(a->slope), enclosure_mul(a->value, a->curve)))};
    }
    const enclosure across = twice(enclosure_mul(a->slope, b->slope));
    return (form){
        enclosure_mul(a->middle, b->middle),
        enclosure_add(enclosure_mul(a->middle_slope, b->middle),
                      enclosure_mul(a->middle, b->middle_slope)),
        enclosure_mul(a->value, b->value),
        enclosure_add(enclosure_mul(a->slope, b->value), enclosure_mul(a->value, b->slope)),
        enclosure_add(across, enclosure_add(enclosure_mul(a->curve, b->value),
                                            enclosure_mul(a->value, b->curve)))};
}

/* q = a / b: q' = (a' - q b') / b, q'' = (a'' - 2 q' b' - q b'') / b. */
static form over(const form *a, const form *b) {
    form q;
    q.middle = enclosure_div(a->middle, b->middle);
    q.middle_slope = enclosure_div(
        enclosure_sub(a->middle_slope, enclosure_mul(q.middle, b->middle_slope)), b->middle);
    q.value = enclosure_div(a->value, b->value);
    q.slope = enclosure_div(enclosure_sub(a->slope, enclosure_mul(q.value, b->slope)), b->value);
    q.curve = enclosure_div(enclosure_sub(enclosure_sub(a->curve, enclosure_mul(q.value, b->curve)),
                                          twice(enclosure_mul(q.slope, b->slope))),
                            b->value);
    return q;
}

/* A function of u, given it at the middle and on the part. */
static form chain(const form *u, slopes at, slopes on) {
    return (form){at.f[0], enclosure_mul(at.f[1], u->middle_slope), on.f[0],
                  enclosure_mul(on.f[1], u->slope),
                  enclosure_add(enclosure_mul(on.f[2], enclosure_square(u->slope)),
                                enclosure_mul(on.f[1], u->curve))};
}

/* One of two, or either: a kink has slopes between those at its sides, and no curvature. */
static form either(form a, form b, enclosure middle, enclosure value) {
    return (form){middle, enclosure_hull(a.middle_slope, b.middle_slope), value,
                  enclosure_is_finite(a.slope) && enclosure_is_finite(b.slope)
                      ? enclosure_hull(a.slope, b.slope)
                      : unknown,
                  unknown};
}

static form lesser(const form *a, const form *b) {
    if (a->value.high <= b->value.low || b->value.high <= a->value.low) {
        return a->value.high <= b->value.low ? *a : *b;
    }
    return either(*a, *b, enclosure_call(FN_MIN, a->middle, b->middle),
                  enclosure_call(FN_MIN, a->value, b->value));
}

static form larger(const form *a, const form *b) {
    const form x = times_number(a, -1.0);
    const form y = times_number(b, -1.0);
    const form least = lesser(&x, &y);
    return times_number(&least, -1.0);
}

static form size_of(const form *a) {
    const form other = times_number(a, -1.0);
    if (a->value.low >= 0.0 || a->value.high <= 0.0) {
        return a->value.low >= 0.0 ? *a : other;
    }
    return either(*a, other, enclosure_call(FN_ABS, a->middle, zero),
                  enclosure_call(FN_ABS, a->value, zero));
}

static form sign_of(const form *a) {
    const enclosure value = enclosure_call(FN_SIGN, a->value, zero);
    const enclosure slope = enclosure_is_point(value) ? zero : unknown;
    return (form){enclosure_call(FN_SIGN, a->middle, zero), slope, value, slope, slope};
}

/* --- functions -------------------------------------------------------------------------------------------*/

static enclosure inverse(enclosure a) { return enclosure_div(enclosure_of(1.0), a); }

/* u^e, for u > 0 if e is not a whole number. */
static enclosure power(enclosure u, double e) {
    const bool whole = number_nearest(e) == e;
    return enclosure_power(whole || !(u.low < 0.0) ? u : (enclosure){0.0, u.high}, enclosure_of(e));
}

static slopes power_slopes(enclosure u, double e) {
    return (slopes){{power(u, e), enclosure_times(power(u, e - 1.0), e),
                     enclosure_times(power(u, e - 2.0), e * (e - 1.0))}};
}

static slopes slopes_of(function_id function, enclosure u) {
    const enclosure one = enclosure_of(1.0);
    const enclosure f = enclosure_call(function, u, zero);
    const enclosure square = enclosure_square(u);
    enclosure x;
    switch (function) {
    case FN_SIN:
    case FN_COS:
        x = function == FN_SIN ? enclosure_cosine(u) : enclosure_neg(enclosure_sine(u));
        return (slopes){{f, x, enclosure_neg(f)}};
    case FN_EXP: return (slopes){{f, f, f}};
    case FN_LOG: return (slopes){{f, inverse(u), enclosure_neg(inverse(square))}};
    case FN_TAN:
        x = enclosure_add(one, enclosure_square(f));
        return (slopes){{f, x, twice(enclosure_mul(f, x))}};
    case FN_SINH:
    case FN_COSH:
        x = enclosure_call(function == FN_SINH ? FN_COSH : FN_SINH, u, zero);
        return (slopes){{f, x, f}};
    case FN_TANH:
        x = enclosure_sub(one, enclosure_square(f));
        return (slopes){{f, x, enclosure_neg(twice(enclosure_mul(f, x)))}};
    case FN_ATAN:
        x = inverse(enclosure_add(one, square));
        return (slopes){{f, x, enclosure_neg(twice(enclosure_mul(u, enclosure_square(x))))}};
    case FN_ASIN:
    case FN_ACOS: {
        const enclosure rest = enclosure_sub(one, square);
        const double sign = function == FN_ASIN ? 1.0 : -1.0;
        x = enclosure_times(power(rest, -0.5), sign);
        return (slopes){{f, x, enclosure_div(enclosure_mul(u, x), rest)}};
    }
    case FN_SQRT:
        x = enclosure_times(inverse(f), 0.5);
        return (slopes){{f, x, enclosure_neg(enclosure_times(enclosure_div(x, u), 0.5))}};
    case FN_ATAN2:
    case FN_ABS:
    case FN_SIGN:
    case FN_MIN:
    case FN_MAX: break;
    }
    return (slopes){{unknown, unknown, unknown}};
}

static form call(function_id function, const form *u) {
    return chain(u, slopes_of(function, u->middle), slopes_of(function, u->value));
}

/* With n = x y' - y x' and q = x^2 + y^2 the slope is n / q. At the jump from -pi to pi it has no slope. */
static form angle_of(const form *y, const form *x) {
    const form n = {
        enclosure_sub(enclosure_mul(x->middle, y->middle_slope),
                      enclosure_mul(y->middle, x->middle_slope)),
        unknown,
        enclosure_sub(enclosure_mul(x->value, y->slope), enclosure_mul(y->value, x->slope)),
        enclosure_sub(enclosure_mul(x->value, y->curve), enclosure_mul(y->value, x->curve)),
        unknown};
    const form xx = times(x, x);
    const form yy = times(y, y);
    const form q = plus(&xx, &yy);
    const form slope = over(&n, &q);
    const bool jumps = x->value.low < 0.0 && y->value.low <= 0.0 && y->value.high >= 0.0;
    return (form){enclosure_call(FN_ATAN2, y->middle, x->middle), slope.middle,
                  enclosure_call(FN_ATAN2, y->value, x->value), jumps ? unknown : slope.value,
                  jumps ? unknown : slope.slope};
}

static form raised(const form *a, const form *b) {
    if (enclosure_is_point(b->value) && fabs(b->value.low) < 1e6) {
        const double e = b->value.low;
        return chain(a, power_slopes(a->middle, e), power_slopes(a->value, e));
    }
    const form log = call(FN_LOG, a);
    const form product = times(b, &log);
    return call(FN_EXP, &product);
}

/* --- the list -----------------------------------------------------------------------------------------------*/

static form phase_of(const taylor_bounds_bounds *a, const op *o) {
    form sum = constant(o->value);
    for (int i = 0; i < a->list->angles && o->turns != NULL; i++) {
        if (o->turns[i] != 0) {
            const form part = times_number(&a->place[i], o->turns[i]);
            sum = plus(&sum, &part);
        }
    }
    return o->b >= 0 ? plus(&sum, &a->of[o->b]) : sum;
}

static form value_of(const taylor_bounds_bounds *a, const op *o) {
    const int values = op_rows[o->code].values;
    const form *x = values > 0 && o->a >= 0 ? &a->of[o->a] : &no_form;
    const form *y = values > 1 && o->b >= 0 ? &a->of[o->b] : &no_form;
    switch (o->code) {
    case OP_CONSTANT: return constant(o->value);
    case OP_LINEAR: return a->place[a->image->angles + o->a];
    case OP_RATE: return a->rate[o->a];
    case OP_INPUT: return constant(a->input[o->a]);
    case OP_PHASE: return phase_of(a, o);
    case OP_SIN: return call(FN_SIN, &a->of[o->a]);
    case OP_COS: return call(FN_COS, &a->of[o->a]);
    case OP_ADD: return plus(x, y);
    case OP_NEG: return times_number(x, -1.0);
    case OP_MUL: return times(x, y);
    case OP_DIV: return over(x, y);
    case OP_SQRT: return call(FN_SQRT, x);
    case OP_ABS: return size_of(x);
    case OP_SIGN: return sign_of(x);
    case OP_MIN: return lesser(x, y);
    case OP_MAX: return larger(x, y);
    case OP_POW: return raised(x, y);
    case OP_CALL: return o->function == FN_ATAN2 ? angle_of(x, y) : call(o->function, x);
    case OP_SUB: {
        const form other = times_number(y, -1.0);
        return plus(x, &other);
    }
    case OP_ACCEL:
    case OP_TIME:
    case OP_RADIANS:
    case OP_NOISE:
    case OP_CELL:
    case OP_LINE:
    case OP_CUBIC: break; /* not in such a list */
    }
    return no_form;
}

static enclosure natural_phase(const taylor_bounds_bounds *a, const op *o) {
    enclosure sum = enclosure_of(o->value);
    for (int i = 0; i < a->list->angles && o->turns != NULL; i++) {
        sum = enclosure_add(sum, enclosure_times(a->place[i].value, o->turns[i]));
    }
    return o->b >= 0 ? enclosure_add(sum, a->natural[o->b]) : sum;
}

static enclosure natural_of(const taylor_bounds_bounds *a, const op *o) {
    const int values = op_rows[o->code].values;
    const enclosure x = values > 0 && o->a >= 0 ? a->natural[o->a] : zero;
    const enclosure y = values > 1 && o->b >= 0 ? a->natural[o->b] : zero;
    switch (o->code) {
    case OP_CONSTANT: return enclosure_of(o->value);
    case OP_LINEAR: return a->place[a->image->angles + o->a].value;
    case OP_RATE: return a->rate[o->a].value;
    case OP_INPUT: return enclosure_of(a->input[o->a]);
    case OP_PHASE: return natural_phase(a, o);
    case OP_SIN: return enclosure_sine(a->natural[o->a]);
    case OP_COS: return enclosure_cosine(a->natural[o->a]);
    case OP_ADD: return enclosure_add(x, y);
    case OP_SUB: return enclosure_sub(x, y);
    case OP_NEG: return enclosure_neg(x);
    case OP_MUL: return o->a == o->b ? enclosure_square(x) : enclosure_mul(x, y);
    case OP_DIV: return enclosure_div(x, y);
    case OP_SQRT: return enclosure_call(FN_SQRT, x, zero);
    case OP_ABS: return enclosure_call(FN_ABS, x, zero);
    case OP_SIGN: return enclosure_call(FN_SIGN, x, zero);
    case OP_MIN: return enclosure_call(FN_MIN, x, y);
    case OP_MAX: return enclosure_call(FN_MAX, x, y);
    case OP_POW: return enclosure_power(x, y);
    case OP_CALL: return enclosure_call(o->function, x, y);
    case OP_ACCEL:
    case OP_TIME:
    case OP_RADIANS:
    case OP_NOISE:
    case OP_CELL:
    case OP_LINE:
    case OP_CUBIC: break; /* not in such a list */
    }
    return unknown;
}

/* The bounds of the middle and of the slopes bound the value. */
static void cut(form *f, double half) {
    const enclosure way = {-half, half};
    const enclosure bend = {0.0, enclosure_above(0.5 * half * half)};
    f->slope = both(f->slope, enclosure_add(f->middle_slope, enclosure_mul(f->curve, way)));
    f->value = both(f->value, enclosure_add(f->middle, enclosure_mul(f->slope, way)));
    f->value =
        both(f->value, enclosure_add(enclosure_add(f->middle, enclosure_mul(f->middle_slope, way)),
                                     enclosure_mul(f->curve, bend)));
}

/* --- the way ------------------------------------------------------------------------------------------------*/

void taylor_bounds_way(taylor_bounds_bounds *a, const double *from, const double *to,
                       double span_s) {
    const int n = a->image->coordinates;
    a->span_s = span_s;
    for (int i = 0; i < n; i++) {
        const double gone = to[i] - from[i];
        const double way = i < a->image->angles ? number_centred(gone, 6.283185307179586) : gone;
        const double lead = span_s * from[n + i];
        const double end = span_s * to[n + i];
        double *c = a->cubic[i];
        c[0] = from[i];
        c[1] = lead;
        c[2] = 3.0 * way - 2.0 * lead - end;
        c[3] = lead + end - 2.0 * way;
    }
    a->glanced = false;
}

/* Between two numbers, and bent by no more than that. */
static enclosure between(double a, double b, double bend) {
    return (enclosure){enclosure_below(number_least(a, b) - bend),
                       enclosure_above(number_most(a, b) + bend)};
}

/* Places and rates on the part. */
static void go(taylor_bounds_bounds *a, double low, double high) {
    const double share[3] = {low, 0.5 * low + 0.5 * high, high};
    const double h = a->span_s;
    a->half = 0.5 * (high - low);
    for (int i = 0; i < a->image->coordinates; i++) {
        const double *c = a->cubic[i];
        const double third = 6.0 * c[3];
        double at[3];
        double slope[3];
        double curve[3];
        for (int k = 0; k < 3; k++) {
            const double s = share[k];
            at[k] = c[0] + s * (c[1] + s * (c[2] + s * c[3]));
            slope[k] = c[1] + s * (2.0 * c[2] + s * 3.0 * c[3]);
            curve[k] = 2.0 * c[2] + s * third;
        }
        const double bend = 0.5 * a->half * a->half;
        const double most = number_most(fabs(curve[0]), fabs(curve[2]));
        const enclosure slopes_on = between(slope[0], slope[2], bend * fabs(third));
        const enclosure curves = between(curve[0], curve[2], 0.0);
        /* the state is known to its rounding */
        a->place[i] = (form){enclosure_about(at[1], 0), enclosure_of(slope[1]),
                             between(at[0], at[2], bend * most), slopes_on, curves};
        const form rate = {enclosure_of(slope[1]), enclosure_of(curve[1]), slopes_on, curves,
                           enclosure_of(third)};
        a->rate[i] = times_number(&rate, 1.0 / h);
    }
}

/* Costs in operations: of an operation's bounds, a coordinate's way, a form, and a function's form. */
enum { BOUNDS = 6, WAY = 10, FORM = 20, CALLED = 200 };

enclosure taylor_bounds_glance(taylor_bounds_bounds *a, int result) {
    if (!a->glanced) {
        a->glanced = true;
        engine_operations += (uint64_t)(BOUNDS * a->list->count + WAY * a->image->coordinates);
        go(a, 0.0, 1.0);
        for (int i = 0; i < a->list->count; i++) {
            a->natural[i] = natural_of(a, &a->list->ops[i]);
        }
    }
    return a->natural[a->list->result[result]];
}

void taylor_bounds_look(taylor_bounds_bounds *a, int result, double low, double high) {
    const op_list *t = a->list;
    const bool *needs = result < 0 ? NULL : a->needs + (ptrdiff_t)result * t->count;
    const int last = result < 0 ? t->count - 1 : t->result[result];
    go(a, low, high);
    engine_operations += (uint64_t)(WAY * a->image->coordinates);
    for (int i = 0; i <= last; i++) {
        if (needs == NULL || needs[i]) {
            const op_code code = t->ops[i].code;
            a->of[i] = value_of(a, &t->ops[i]);
            if (op_rows[code].kind > OP_IS_LEAF) { /* those are as narrow as can be */
                engine_operations += code == OP_CALL || code == OP_POW ? CALLED : FORM;
                cut(&a->of[i], a->half);
            }
        }
    }
}

enclosure taylor_bounds_value(const taylor_bounds_bounds *a, int result) {
    return a->of[a->list->result[result]].value;
}

enclosure taylor_bounds_middle(const taylor_bounds_bounds *a, int result) {
    return a->of[a->list->result[result]].middle;
}

double taylor_bounds_change(const taylor_bounds_bounds *a, int result) {
    const form *f = &a->of[a->list->result[result]];
    const double slope = enclosure_size(f->middle_slope);
    return enclosure_is_finite(f->curve) ? slope + enclosure_size(f->curve) : slope;
}

#include "missed.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/contact.h"
#include "host/base/alloc.h"
#include "host/number/enclosure.h"
#include "host/number/functions.h"

/* === Taylor bounds =============================================================================== */
/* Bounds of an operation list on a part of a step's path, by Taylor forms of second order (Moore, Kearfott, Cloud,
 * Introduction to Interval Analysis, 2009, chapter 6).
 *
 * Natural interval bounds are wide, because they treat each occurrence of a variable as another variable. Here each
 * operation has its value and slope at the middle m of the part, and bounds on value, slope and curvature over the
 * part. Each value is intersected with f(m) + f'(m) d + f''(part) d^2/2 and with f(m) + f'(part) d, d being the
 * distance from m. */
/* A value and its first two derivatives by s, the share of the path from 0 to 1; NaN: unknown. */
typedef struct jet {
    enclosure f[3];
} jet;

/* Jets at the middle of a part of the path, or bounding jets over the part. */
typedef struct spot {
    int order;     /* number of derivatives that are computed */
    jet *position; /* [coordinates] */
    jet *rate;     /* [coordinates] */
    jet *of;       /* [operations] */
} spot;

typedef struct taylor_bounds {
    const image *image;
    const op_list *list;
    double *input;      /* [inputs] */
    double (*cubic)[4]; /* [coordinates] coefficients of the path */
    double span_s;
    spot middle;  /* order 1 */
    spot part;    /* order 2 */
    spot natural; /* order 0: natural bounds on the whole path */
    bool glanced; /* natural.of[] is set */
    bool *needs;  /* [results * operations] does the result depend on the operation? */
    double half;  /* half the part's width */
} taylor_bounds;

static const enclosure unknown = {(double)NAN, (double)NAN};
static const enclosure zero = {0.0, 0.0};
static const jet no_jet = {
    {{(double)NAN, (double)NAN}, {(double)NAN, (double)NAN}, {(double)NAN, (double)NAN}}};

static spot spot_new(const image *im, const op_list *t, int order) {
    spot p = {.order = order};
    p.position = alloc(2 * (int64_t)im->coordinates + t->count, sizeof *p.position);
    p.rate = p.position + im->coordinates;
    p.of = p.rate + im->coordinates;
    return p;
}

/* `t`: a list of the image whose operations read only positions, rates and inputs. */
static taylor_bounds *taylor_bounds_open(const image *im, const op_list *t) {
    taylor_bounds *a = alloc(1, sizeof *a);
    a->image = im;
    a->list = t;
    a->input = alloc(im->inputs, sizeof *a->input);
    image_inputs(im, a->input);
    a->cubic = alloc(im->coordinates, sizeof *a->cubic);
    a->middle = spot_new(im, t, 1);
    a->part = spot_new(im, t, 2);
    a->natural = spot_new(im, t, 0);
    a->needs = alloc((int64_t)t->results * t->count, sizeof *a->needs);
    for (int r = 0; r < t->results; r++) {
        op_list_mark_needed(t, t->result[r], a->needs + (ptrdiff_t)r * t->count);
    }
    return a;
}

static void taylor_bounds_close(taylor_bounds *a) {
    if (a != NULL) {
        free(a->input);
        free(a->cubic);
        free(a->middle.position);
        free(a->part.position);
        free(a->natural.position);
        free(a->needs);
        free(a);
    }
}

/* --- jets -----------------------------------------------------------------------------------------------*/

/* The intersection of two enclosures of the same value; one of them may be unknown. */
static enclosure both(enclosure a, enclosure b) {
    if (!enclosure_is_finite(a) || !enclosure_is_finite(b)) {
        return enclosure_is_finite(a) ? a : b;
    }
    const enclosure c = {enclosure_larger(a.low, b.low), enclosure_lesser(a.high, b.high)};
    return c.low <= c.high ? c : a;
}

static enclosure twice(enclosure a) { return (enclosure){2.0 * a.low, 2.0 * a.high}; }

static jet constant(double value) { return (jet){{enclosure_of(value), zero, zero}}; }

static jet plus(jet a, jet b) {
    for (int k = 0; k < 3; k++) {
        a.f[k] = enclosure_add(a.f[k], b.f[k]);
    }
    return a;
}

static jet times_number(jet a, double x) {
    for (int k = 0; k < 3; k++) {
        a.f[k] = enclosure_times(a.f[k], x);
    }
    return a;
}

static jet negative(jet a) {
    for (int k = 0; k < 3; k++) {
        a.f[k] = enclosure_neg(a.f[k]);
    }
    return a;
}

static jet square(jet a, int order) {
    jet s = {{enclosure_square(a.f[0]), unknown, unknown}};
    if (order > 0) {
        s.f[1] = twice(enclosure_mul(a.f[0], a.f[1]));
    }
    if (order > 1) {
        s.f[2] = twice(enclosure_add(enclosure_square(a.f[1]), enclosure_mul(a.f[0], a.f[2])));
    }
    return s;
}

static jet times(jet a, jet b, int order) {
    jet p = {{enclosure_mul(a.f[0], b.f[0]), unknown, unknown}};
    if (order > 0) {
        p.f[1] = enclosure_add(enclosure_mul(a.f[1], b.f[0]), enclosure_mul(a.f[0], b.f[1]));
    }
    if (order > 1) {
        p.f[2] = enclosure_add(
            twice(enclosure_mul(a.f[1], b.f[1])),
            enclosure_add(enclosure_mul(a.f[2], b.f[0]), enclosure_mul(a.f[0], b.f[2])));
    }
    return p;
}

/* q = a / b: q' = (a' - q b') / b, q'' = (a'' - 2 q' b' - q b'') / b. */
static jet over(jet a, jet b, int order) {
    jet q = {{enclosure_div(a.f[0], b.f[0]), unknown, unknown}};
    if (order > 0) {
        q.f[1] = enclosure_div(enclosure_sub(a.f[1], enclosure_mul(q.f[0], b.f[1])), b.f[0]);
    }
    if (order > 1) {
        q.f[2] = enclosure_div(enclosure_sub(enclosure_sub(a.f[2], enclosure_mul(q.f[0], b.f[2])),
                                             twice(enclosure_mul(q.f[1], b.f[1]))),
                               b.f[0]);
    }
    return q;
}

/* The jet of a function of u. `of`: the function and its derivatives by u. */
static jet chain(jet u, jet of, int order) {
    if (order > 1) {
        of.f[2] = enclosure_add(enclosure_mul(of.f[2], enclosure_square(u.f[1])),
                                enclosure_mul(of.f[1], u.f[2]));
    }
    of.f[1] = order > 0 ? enclosure_mul(of.f[1], u.f[1]) : unknown;
    return of;
}

/* The jet of a kink between the branches a and b: its slope is between theirs, and its curvature is unknown. */
static jet either(jet a, jet b, enclosure value) {
    const bool sloped = enclosure_is_finite(a.f[1]) && enclosure_is_finite(b.f[1]);
    return (jet){{value, sloped ? enclosure_hull(a.f[1], b.f[1]) : unknown, unknown}};
}

static jet lesser(jet a, jet b) {
    if (a.f[0].high <= b.f[0].low || b.f[0].high <= a.f[0].low) {
        return a.f[0].high <= b.f[0].low ? a : b;
    }
    return either(a, b, enclosure_call(FN_MIN, a.f[0], b.f[0]));
}

static jet size_of(jet a) {
    if (a.f[0].low >= 0.0 || a.f[0].high <= 0.0) {
        return a.f[0].low >= 0.0 ? a : negative(a);
    }
    return either(a, negative(a), enclosure_call(FN_ABS, a.f[0], zero));
}

static jet sign_of(jet a) {
    const enclosure value = enclosure_call(FN_SIGN, a.f[0], zero);
    const enclosure slope = enclosure_is_point(value) ? zero : unknown;
    return (jet){{value, slope, slope}};
}

/* --- functions -------------------------------------------------------------------------------------------*/

static enclosure inverse(enclosure a) { return enclosure_div(enclosure_of(1.0), a); }

/* u^e; if e is not a whole number, negative values of u are left out. */
static enclosure power(enclosure u, double e) {
    const bool whole = number_nearest(e) == e;
    return enclosure_power(whole || !(u.low < 0.0) ? u : (enclosure){0.0, u.high}, enclosure_of(e));
}

static jet derivatives_of(function_id function, enclosure u) {
    const enclosure one = enclosure_of(1.0);
    const enclosure f = enclosure_call(function, u, zero);
    const enclosure uu = enclosure_square(u);
    enclosure x;
    switch (function) {
    case FN_SIN:
    case FN_COS:
        x = function == FN_SIN ? enclosure_cosine(u) : enclosure_neg(enclosure_sine(u));
        return (jet){{f, x, enclosure_neg(f)}};
    case FN_EXP: return (jet){{f, f, f}};
    case FN_LOG: return (jet){{f, inverse(u), enclosure_neg(inverse(uu))}};
    case FN_TAN:
        x = enclosure_add(one, enclosure_square(f));
        return (jet){{f, x, twice(enclosure_mul(f, x))}};
    case FN_SINH:
    case FN_COSH:
        x = enclosure_call(function == FN_SINH ? FN_COSH : FN_SINH, u, zero);
        return (jet){{f, x, f}};
    case FN_TANH:
        x = enclosure_sub(one, enclosure_square(f));
        return (jet){{f, x, enclosure_neg(twice(enclosure_mul(f, x)))}};
    case FN_ATAN:
        x = inverse(enclosure_add(one, uu));
        return (jet){{f, x, enclosure_neg(twice(enclosure_mul(u, enclosure_square(x))))}};
    case FN_ASIN:
    case FN_ACOS: {
        const enclosure rest = enclosure_sub(one, uu);
        const double sign = function == FN_ASIN ? 1.0 : -1.0;
        x = enclosure_times(power(rest, -0.5), sign);
        return (jet){{f, x, enclosure_div(enclosure_mul(u, x), rest)}};
    }
    case FN_SQRT:
        x = enclosure_times(inverse(f), 0.5);
        return (jet){{f, x, enclosure_neg(enclosure_times(enclosure_div(x, u), 0.5))}};
    case FN_ATAN2:
    case FN_ABS:
    case FN_SIGN:
    case FN_MIN:
    case FN_MAX: break;
    }
    return no_jet;
}

static jet call(function_id function, jet u, int order) {
    if (order == 0) {
        return (jet){{enclosure_call(function, u.f[0], zero), unknown, unknown}};
    }
    return chain(u, derivatives_of(function, u.f[0]), order);
}

/* atan2(y, x): its slope is n / q, n = x y' - y x', q = x^2 + y^2. It has no slope at the jump from -pi to pi. */
static jet angle_of(jet y, jet x, int order) {
    const jet n = {{enclosure_sub(enclosure_mul(x.f[0], y.f[1]), enclosure_mul(y.f[0], x.f[1])),
                    enclosure_sub(enclosure_mul(x.f[0], y.f[2]), enclosure_mul(y.f[0], x.f[2])),
                    unknown}};
    const jet slope = over(n, plus(square(x, 1), square(y, 1)), order - 1);
    const bool jumps = x.f[0].low < 0.0 && y.f[0].low <= 0.0 && y.f[0].high >= 0.0;
    return (jet){{enclosure_call(FN_ATAN2, y.f[0], x.f[0]), jumps ? unknown : slope.f[0],
                  jumps ? unknown : slope.f[1]}};
}

static jet raised(jet a, jet b, int order) {
    const enclosure u = a.f[0];
    if (enclosure_is_point(b.f[0]) && fabs(b.f[0].low) < 1e6) {
        const double e = b.f[0].low;
        const jet of = {{power(u, e), enclosure_times(power(u, e - 1.0), e),
                         enclosure_times(power(u, e - 2.0), e * (e - 1.0))}};
        return chain(a, of, order);
    }
    return call(FN_EXP, times(b, call(FN_LOG, a, order), order), order);
}

/* --- the list -----------------------------------------------------------------------------------------------*/

static jet phase_of(const taylor_bounds *a, const spot *p, const op *o) {
    jet sum = constant(o->value);
    for (int i = 0; i < a->list->angles && o->turns != NULL; i++) {
        if (o->turns[i] != 0) {
            sum = plus(sum, times_number(p->position[i], o->turns[i]));
        }
    }
    return o->b >= 0 ? plus(sum, p->of[o->b]) : sum;
}

static jet value_of(const taylor_bounds *a, const spot *p, const op *o) {
    const int values = op_rows[o->code].values;
    const jet x = values > 0 && o->a >= 0 ? p->of[o->a] : no_jet;
    const jet y = values > 1 && o->b >= 0 ? p->of[o->b] : no_jet;
    switch (o->code) {
    case OP_CONSTANT: return constant(o->value);
    case OP_LINEAR: return p->position[a->image->angles + o->a];
    case OP_RATE: return p->rate[o->a];
    case OP_INPUT: return constant(a->input[o->a]);
    case OP_PHASE: return phase_of(a, p, o);
    case OP_SIN: return call(FN_SIN, p->of[o->a], p->order);
    case OP_COS: return call(FN_COS, p->of[o->a], p->order);
    case OP_ADD: return plus(x, y);
    case OP_SUB: return plus(x, negative(y));
    case OP_NEG: return negative(x);
    case OP_MUL: return o->a == o->b ? square(x, p->order) : times(x, y, p->order);
    case OP_DIV: return over(x, y, p->order);
    case OP_SQRT: return call(FN_SQRT, x, p->order);
    case OP_ABS: return size_of(x);
    case OP_SIGN: return sign_of(x);
    case OP_MIN: return lesser(x, y);
    case OP_MAX: return negative(lesser(negative(x), negative(y)));
    case OP_POW: return raised(x, y, p->order);
    case OP_CALL:
        return o->function == FN_ATAN2 ? angle_of(x, y, p->order) : call(o->function, x, p->order);
    case OP_ACCEL:
    case OP_TIME:
    case OP_RADIANS:
    case OP_NOISE:
    case OP_CELL:
    case OP_LINE:
    case OP_CUBIC: break; /* no such operation in this list */
    }
    return no_jet;
}

/* Narrows the bounds over the part by Taylor forms about its middle. */
static void cut(jet *part, const jet *middle, double half) {
    const enclosure way = {-half, half};
    const enclosure bend = {0.0, enclosure_above(0.5 * half * half)};
    enclosure *f = part->f;
    f[1] = both(f[1], enclosure_add(middle->f[1], enclosure_mul(f[2], way)));
    f[0] = both(f[0], enclosure_add(middle->f[0], enclosure_mul(f[1], way)));
    f[0] = both(f[0], enclosure_add(enclosure_add(middle->f[0], enclosure_mul(middle->f[1], way)),
                                    enclosure_mul(f[2], bend)));
}

/* --- the path -----------------------------------------------------------------------------------------------*/

/* Sets the path: the cubic through the positions and rates of the states `from` and `to`, which are `span_s` apart. */
static void taylor_bounds_way(taylor_bounds *a, const double *from, const double *to,
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

/* Encloses a curve from a to b that deviates from the chord by at most `bend`. */
static enclosure between(double a, double b, double bend) {
    return (enclosure){enclosure_below(number_least(a, b) - bend),
                       enclosure_above(number_most(a, b) + bend)};
}

/* Computes positions and rates on a part of the path. */
static void go(taylor_bounds *a, double low, double high) {
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
        /* the state has round-off, so each position is an interval as wide as its round-off */
        const jet middle_rate = {{enclosure_of(slope[1]), enclosure_of(curve[1]), unknown}};
        const jet part_rate = {{slopes_on, curves, enclosure_of(third)}};
        a->middle.position[i] = (jet){{enclosure_about(at[1], 0), middle_rate.f[0], unknown}};
        a->part.position[i] = (jet){{between(at[0], at[2], bend * most), slopes_on, curves}};
        a->middle.rate[i] = times_number(middle_rate, 1.0 / h);
        a->part.rate[i] = times_number(part_rate, 1.0 / h);
    }
}

/* Costs, in list operations, of natural bounds, a coordinate's path, a Taylor form, and a Taylor form of a function. */
enum { BOUNDS = 6, WAY = 10, FORM = 20, CALLED = 200 };

/* Natural bounds of one result on the whole path: a quick test. */
static enclosure taylor_bounds_glance(taylor_bounds *a, int result) {
    if (!a->glanced) {
        a->glanced = true;
        engine_operations += (uint64_t)(BOUNDS * a->list->count + WAY * a->image->coordinates);
        go(a, 0.0, 1.0);
        memcpy(a->natural.position, a->part.position,
               2 * (size_t)a->image->coordinates * sizeof(jet)); /* copies the rates, too */
        for (int i = 0; i < a->list->count; i++) {
            a->natural.of[i] = value_of(a, &a->natural, &a->list->ops[i]);
        }
    }
    return a->natural.of[a->list->result[result]].f[0];
}

/* Bounds one result, or all (-1), on the path from s = low to s = high. */
static void taylor_bounds_look(taylor_bounds *a, int result, double low, double high) {
    const op_list *t = a->list;
    const bool *needs = result < 0 ? NULL : a->needs + (ptrdiff_t)result * t->count;
    const int last = result < 0 ? t->count - 1 : t->result[result];
    go(a, low, high);
    engine_operations += (uint64_t)(WAY * a->image->coordinates);
    for (int i = 0; i <= last; i++) {
        if (needs == NULL || needs[i]) {
            const op_code code = t->ops[i].code;
            a->middle.of[i] = value_of(a, &a->middle, &t->ops[i]);
            a->part.of[i] = value_of(a, &a->part, &t->ops[i]);
            if (op_rows[code].kind > OP_IS_LEAF) { /* a leaf's bounds are already exact */
                engine_operations += code == OP_CALL || code == OP_POW ? CALLED : FORM;
                cut(&a->part.of[i], &a->middle.of[i], a->half);
            }
        }
    }
}

static enclosure taylor_bounds_value(const taylor_bounds *a, int result) {
    return a->part.of[a->list->result[result]].f[0];
}

static enclosure taylor_bounds_middle(const taylor_bounds *a, int result) {
    return a->middle.of[a->list->result[result]].f[0];
}

/* Bounds the result's change over the whole path, as if this part's slope and curvature applied to all of it. */
static double taylor_bounds_change(const taylor_bounds *a, int result) {
    const int of = a->list->result[result];
    const double slope = enclosure_size(a->middle.of[of].f[1]);
    const enclosure curve = a->part.of[of].f[2];
    return enclosure_is_finite(curve) ? slope + enclosure_size(curve) : slope;
}

/* === what a step passes ========================================================================== */

#define HALVINGS 24    /* most halvings of a path */
#define PARTS_MOST 400 /* most parts of a path that are tested for one contact or coordinate */
/* A negative margin() counts as zero up to TOUCH * (margin at the ends) or WIDTHS * (round-off). */
#define TOUCH 1e-9
#define WIDTHS 64.0
/* An acceleration inside a path is hidden if it exceeds two limits: HIDDEN * (sum of the accelerations at both ends),
 * and TURNS * (larger rate at the ends) / (duration of the path). */
#define HIDDEN 2.0
#define TURNS 0.05
/* EDGE: least relative jump of a gap's slope. EDGE_HALVINGS: number of halvings that locate the jump. */
#define EDGE 0.05
#define EDGE_HALVINGS 8

struct missed {
    const image *image;
    taylor_bounds *signals;    /* of the list IMAGE_SIGNALS; NULL if there are no contacts */
    taylor_bounds *accel;      /* of the accelerations; NULL if not needed */
    bool hills;                /* the accelerations may have a narrow peak */
    bool smooth;               /* no acceleration has a kink */
    bool edges;                /* has_edges(image) */
    taylor_bounds *laws;       /* of the contact laws; NULL if not needed */
    int *mode;                 /* [contacts] before the step */
    int *mode_to;              /* [contacts] after the step */
    const engine_piece *piece; /* the present path */
};

/* Has the list a kink, or an exponential or hyperbolic function, either of which may make a narrow peak? */
static bool has_hills(const op_list *t) {
    bool some = op_list_has_kinks(t);
    for (int i = 0; i < t->count; i++) {
        const function_id f = t->ops[i].function;
        some = some || (t->ops[i].code == OP_CALL &&
                        (f == FN_EXP || f == FN_TANH || f == FN_SINH || f == FN_COSH));
    }
    return some;
}

static bool has_edges(const image *im) {
    return im->contacts > 0 && im->contact[0].kind == WH_STOP &&
           op_list_has_kinks(im->list[IMAGE_SIGNALS]);
}

/* The index of this row of contact k in the results of IMAGE_FORCES. */
static int law_of(const image *im, int k, int row) {
    return k * (WH_LAW_ROWS + 2 * im->coordinates) + row;
}

/* Is contact k a friction with a limit that is not constant? */
static bool has_moving_limits(const image *im, int k) {
    const op_list *t = im->list[IMAGE_FORCES];
    return im->contact[k].kind == WH_FRICTION &&
           (t->ops[t->result[law_of(im, k, WH_LAW_FIRST)]].code != OP_CONSTANT ||
            t->ops[t->result[law_of(im, k, WH_LAW_SECOND)]].code != OP_CONSTANT);
}

missed *missed_open(const image *im) {
    const op_list *signals = im->contacts > 0 ? im->list[IMAGE_SIGNALS] : NULL;
    const bool hills = im->form == WH_SECOND_ORDER && has_hills(im->list[IMAGE_STEP]);
    const op_list *laws = has_edges(im) ? im->list[IMAGE_FORCES] : NULL;
    for (int k = 0; k < im->forced; k++) {
        laws = has_moving_limits(im, k) ? im->list[IMAGE_FORCES] : laws;
    }
    if (signals == NULL && !hills) {
        return NULL;
    }
    missed *m = alloc(1, sizeof *m);
    m->image = im;
    m->signals = signals != NULL ? taylor_bounds_open(im, signals) : NULL;
    m->hills = hills;
    m->smooth = !op_list_has_kinks(im->list[IMAGE_STEP]);
    m->edges = has_edges(im);
    m->accel = hills || laws != NULL ? taylor_bounds_open(im, im->list[IMAGE_STEP]) : NULL;
    m->laws = laws != NULL ? taylor_bounds_open(im, laws) : NULL;
    m->mode = alloc(2 * im->contacts, sizeof *m->mode);
    m->mode_to = m->mode + im->contacts;
    return m;
}

void missed_close(missed *m) {
    if (m != NULL) {
        taylor_bounds_close(m->signals);
        taylor_bounds_close(m->accel);
        taylor_bounds_close(m->laws);
        free(m->mode);
        free(m);
    }
}

/* --- parts of a piece -----------------------------------------------------------------------------------*/

/* The margin of contact k: positive if the contact keeps its mode. */
static enclosure margin(const missed *m, int k, enclosure signal) {
    const bool is = m->image->contact[k].kind == WH_STOP || m->piece->mode[k] > 0;
    return is ? signal : enclosure_neg(signal);
}

typedef struct search search;
struct search {
    int (*look)(const search *s, double low, double high); /* 1 found, 0 excluded, -1 undecided */
    taylor_bounds *bounds;
    int result;
    double bar;      /* the threshold */
    const missed *m; /* for contacts */
    double size;     /* for contacts: the larger of the margins at the ends of the path */
    int parts;       /* number of parts tested so far */
};

/* Contacts shorter than the finest part are not searched. */
static bool is_finest(double low, double high) { return high - low <= 1.0 / (1 << HALVINGS); }

/* Is the margin negative? Values down to -s->bar do not count: events are located with an error. */
static int look_contact(const search *s, double low, double high) {
    const int k = s->result / 2;
    taylor_bounds_look(s->bounds, s->result, low, high);
    const enclosure middle = margin(s->m, k, taylor_bounds_middle(s->bounds, s->result));
    const enclosure value = margin(s->m, k, taylor_bounds_value(s->bounds, s->result));
    const double change = number_least(s->size, taylor_bounds_change(s->bounds, s->result));
    const double rounding = WIDTHS * (middle.high - middle.low);
    const double touch = number_most(s->bar, number_most(TOUCH * change, rounding));
    if (middle.high < -touch) {
        return 1;
    }
    const bool outside = value.low >= -s->bar || enclosure_size(value) <= touch;
    return outside || (is_finest(low, high) && enclosure_is_finite(value)) ? 0 : -1;
}

/* Is the magnitude of the value above the bar? */
static int look_size(const search *s, double low, double high) {
    taylor_bounds_look(s->bounds, s->result, low, high);
    const enclosure middle = taylor_bounds_middle(s->bounds, s->result);
    if (middle.low > s->bar || middle.high < -s->bar) {
        return 1;
    }
    return enclosure_size(taylor_bounds_value(s->bounds, s->result)) <= s->bar ? 0 : -1;
}

/* Is the value below the bar? */
static int look_grip(const search *s, double low, double high) {
    taylor_bounds_look(s->bounds, s->result, low, high);
    return taylor_bounds_middle(s->bounds, s->result).high < s->bar  ? 1
           : taylor_bounds_value(s->bounds, s->result).low >= s->bar ? 0
                                                                     : -1;
}

static int passes(search *s, double low, double high, int halvings) {
    if (s->parts >= PARTS_MOST) {
        return -1;
    }
    s->parts++;
    const int found = s->look(s, low, high);
    if (found >= 0 || halvings == 0) {
        return found;
    }
    const double middle = 0.5 * (low + high);
    const int first = passes(s, low, middle, halvings - 1);
    const int second = first > 0 ? 0 : passes(s, middle, high, halvings - 1);
    return first > 0 || second > 0 ? 1 : first < 0 || second < 0 ? -1 : 0;
}

static missed_found or_this(missed_found found, int passed, int what) {
    return passed > 0 || (passed < 0 && found.what < 0)
               ? (missed_found){.what = what, .sure = passed > 0}
               : found;
}

/* Is contact k an open hold whose expression is constant on this path? Closing it would have no effect. */
static bool is_idle(missed *m, int k) {
    if (m->image->contact[k].kind != WH_HOLD || m->piece->mode[k] != WH_FREE) {
        return false;
    }
    taylor_bounds_look(m->signals, 2 * k + 1, 0.0, 1.0);
    const enclosure middle = taylor_bounds_middle(m->signals, 2 * k + 1);
    return enclosure_size(taylor_bounds_value(m->signals, 2 * k + 1)) <=
           WIDTHS * (middle.high - middle.low) + DBL_MIN;
}

/* Does contact k, which has the same mode at both ends, leave this mode on the path? */
static int contact_passes(missed *m, int k) {
    search s = {.look = look_contact, .bounds = m->signals, .result = 2 * k, .m = m};
    if (is_idle(m, k) || margin(m, k, taylor_bounds_glance(m->signals, 2 * k)).low >= 0.0 ||
        look_contact(&s, 0.0, 1.0) == 0) {
        return 0;
    }
    for (int end = 0; end < 2; end++) {
        taylor_bounds_look(m->signals, 2 * k, end, end);
        const enclosure value = margin(m, k, taylor_bounds_value(m->signals, 2 * k));
        s.size = number_most(s.size, value.high);
        s.bar = number_most(s.bar, -2.0 * value.low);
    }
    return passes(&s, 0.0, 1.0, HALVINGS);
}

static double middle_of(taylor_bounds *a, int result) {
    const enclosure e = taylor_bounds_middle(a, result);
    return 0.5 * e.low + 0.5 * e.high;
}

/* If friction k sticks: the force that keeps it stuck. If it slides: a force that changes its speed noticeably. */
static double force_that_matters(missed *m, int k, bool sticks) {
    const int n = m->image->coordinates;
    const int rows = law_of(m->image, k, WH_LAW_ROWS);
    double most_turns = 0.0; /* acceleration per unit of friction force */
    double most_load = 0.0;
    double most_rate = 0.0;
    for (int end = 0; end < 2; end++) {
        taylor_bounds_look(m->laws, -1, end, end);
        taylor_bounds_look(m->accel, -1, end, end);
        double pull = middle_of(m->laws, law_of(m->image, k, WH_LAW_BIAS));
        double rate = 0.0;
        double turns = 0.0;
        for (int i = 0; i < n; i++) {
            const double row = middle_of(m->laws, rows + i);
            pull += row * middle_of(m->accel, i);
            rate += row * (end == 0 ? m->piece->from : m->piece->to)[n + i];
            turns += row * middle_of(m->laws, rows + n + i);
        }
        most_load = number_most(most_load, fabs(pull) / turns);
        most_rate = number_most(most_rate, fabs(rate));
        most_turns = number_most(most_turns, turns);
    }
    for (int l = 0; l < m->image->forced; l++) {
        const bool bears = m->image->contact[l].kind == WH_FRICTION || m->piece->mode[l] != WH_FREE;
        most_load = l != k && bears ? (double)INFINITY : most_load;
    }
    return sticks ? most_load : TURNS * most_rate / (m->piece->span_s * most_turns);
}

/* Is the limit of friction k much smaller (if stuck) or larger (if sliding) inside the path than at the ends? */
static int limit_passes(missed *m, int k) {
    const bool sticks = m->piece->mode[k] == WH_STUCK;
    const int i = law_of(m->image, k, sticks ? WH_LAW_FIRST : WH_LAW_SECOND);
    double drag = 0.0;
    double grip = (double)INFINITY;
    for (int end = 0; end < 2; end++) {
        taylor_bounds_look(m->laws, i, end, end);
        const enclosure value = taylor_bounds_value(m->laws, i);
        drag += enclosure_is_finite(value) ? HIDDEN * enclosure_size(value) : 0.0;
        grip = value.low / HIDDEN < grip ? value.low / HIDDEN : grip;
    }
    const enclosure glance = taylor_bounds_glance(m->laws, i);
    if (sticks ? glance.low >= grip : glance.high <= drag) {
        return 0;
    }
    const double force = force_that_matters(m, k, sticks);
    search s = {.look = sticks ? look_grip : look_size, .bounds = m->laws, .result = i};
    s.bar = sticks ? number_least(grip, force) : number_most(drag, force);
    return passes(&s, 0.0, 1.0, HALVINGS);
}

/* --- edges ---------------------------------------------------------------------------------------------*/

static double width_on(const search *s, double low, double high) {
    taylor_bounds_look(s->bounds, s->result, low, high);
    const enclosure e = taylor_bounds_value(s->bounds, s->result);
    return enclosure_is_finite(e) ? e.high - e.low : 0.0;
}

static int look_edge(const search *s, double low, double high) {
    return width_on(s, low, high) <= s->bar                   ? 0
           : high - low <= 1.0 / (double)(1 << EDGE_HALVINGS) ? 1
                                                              : -1;
}

/* Does the slope of stop k's gap jump on the path? False if both ends of the path are on an edge. */
static bool slope_jumps(missed *m, int k) {
    bool some = false;
    for (int c = 0; c < m->image->coordinates && !some; c++) {
        const int i = law_of(m->image, k, WH_LAW_ROWS + c);
        search s = {.look = look_edge, .bounds = m->laws, .result = i};
        const double width[2] = {width_on(&s, 0.0, 0.0), width_on(&s, 1.0, 1.0)};
        const double size = enclosure_size(taylor_bounds_value(m->laws, i));
        taylor_bounds_look(m->laws, i, 0.0, 0.0);
        s.bar = EDGE * (size + enclosure_size(taylor_bounds_value(m->laws, i)));
        some = (width[0] <= s.bar || width[1] <= s.bar) && passes(&s, 0.0, 1.0, EDGE_HALVINGS) > 0;
    }
    return some;
}

/* The core may move the body back to the stop's face. The path to `ahead` omits this move. */
static missed_found edge_passed(missed *m) {
    const engine_piece *p = m->piece;
    const int n = m->image->coordinates;
    double ahead[2 * IMAGE_COMPONENTS_MAX];
    memcpy(ahead, p->from, 2 * (size_t)n * sizeof *ahead);
    for (int i = 0; i < n; i++) {
        ahead[i] += p->span_s * p->from[n + i];
    }
    for (int way = 0; way < 2; way++) {
        taylor_bounds_way(m->laws, p->from, way == 0 ? p->to : ahead, p->span_s);
        for (int k = 0; k < m->image->forced; k++) {
            if (m->image->contact[k].kind == WH_STOP && p->mode[k] != WH_FREE &&
                slope_jumps(m, k)) {
                return (missed_found){.what = k, .sure = true, .edge = true};
            }
        }
    }
    return MISSED_NOTHING;
}

static missed_found contact_passed(missed *m) {
    missed_found found = MISSED_NOTHING;
    for (int k = 0; k < m->image->contacts && !found.sure; k++) {
        const image_contact *c = &m->image->contact[k];
        const int mode = m->piece->mode[k];
        if (c->kind == WH_HOLD || (c->kind == WH_STOP && mode == WH_FREE) ||
            (c->kind == WH_WHEN && c->sets > 0 && mode != 0)) {
            found = or_this(found, contact_passes(m, k), k);
        } else if (c->kind == WH_FRICTION && has_moving_limits(m->image, k)) {
            found = or_this(found, limit_passes(m, k), k);
        }
    }
    return found;
}

/* Finds a coordinate whose acceleration is much larger inside the path than at the ends. */
static missed_found force_passed(missed *m) {
    missed_found found = MISSED_NOTHING;
    const int n = m->image->coordinates;
    bool open[IMAGE_COMPONENTS_MAX];
    double most[IMAGE_COMPONENTS_MAX] = {0.0};
    for (int end = 0; end < 2; end++) {
        taylor_bounds_look(m->accel, -1, end, end);
        for (int i = 0; i < n; i++) {
            const enclosure value = taylor_bounds_value(m->accel, i);
            most[i] += enclosure_is_finite(value) ? HIDDEN * enclosure_size(value) : 0.0;
        }
    }
    for (int i = 0; i < n; i++) {
        const double rate = number_most(fabs(m->piece->from[n + i]), fabs(m->piece->to[n + i]));
        most[i] = number_most(number_most(most[i], TURNS * rate / m->piece->span_s), DBL_MIN);
        open[i] = !(enclosure_size(taylor_bounds_glance(m->accel, i)) <= most[i]);
    }
    for (int i = 0; i < n && !found.sure; i++) {
        search s = {.look = look_size, .bounds = m->accel, .result = i, .bar = most[i]};
        const int passed = open[i] ? passes(&s, 0.0, 1.0, HALVINGS) : 0;
        found = passed > 0 || m->smooth ? or_this(found, passed, m->image->contacts + i) : found;
    }
    return found;
}

static missed_found piece_passed(missed *m, const engine_piece *piece) {
    missed_found found = MISSED_NOTHING;
    if (piece->span_s <= m->image->step_s / (1 << HALVINGS)) {
        return found; /* shorter than the finest part */
    }
    m->piece = piece;
    taylor_bounds *const bounds[] = {m->signals, m->accel, m->laws};
    for (int i = 0; i < 3; i++) {
        if (bounds[i] != NULL) {
            taylor_bounds_way(bounds[i], piece->from, piece->to, piece->span_s);
        }
    }
    found = m->signals != NULL ? contact_passed(m) : found;
    found = found.what < 0 && m->edges ? edge_passed(m) : found;
    return found.what < 0 && m->hills ? force_passed(m) : found;
}

missed_found missed_enter(missed *m, const engine_kind *kind, const void *run, const double *from,
                          const double *to, bool eventful) {
    missed_found found = MISSED_NOTHING;
    if (m == NULL) {
        return found;
    }
    const image *im = m->image;
    int count = 0;
    memcpy(m->mode, m->mode_to, (size_t)im->contacts * sizeof *m->mode);
    if (im->contacts > 0) {
        kind->modes(run, m->mode_to);
    }
    if (from == NULL) {
        return found;
    }
    const engine_piece *pieces =
        im->contacts > 0 && kind->pieces != NULL ? kind->pieces(run, &count) : NULL;
    for (int i = 0; i < count && !found.sure; i++) {
        const missed_found in = piece_passed(m, &pieces[i]);
        found = in.sure || found.what < 0 ? in : found;
    }
    if (count == 0 && !eventful) {
        const engine_piece all = {im->step_s, from, to, m->mode};
        found = piece_passed(m, &all);
    }
    return found;
}

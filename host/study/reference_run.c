#include "host/study/reference_run.h"

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/engine/loop.h"
#include "host/number/functions.h"
#include "host/os/system.h"

/* === functions and lists in long double ======================================================= */

/* --- functions -------------------------------------------------------------------------------------*/

/* 1/0!, 1/1!, ..., enough for 113 binary digits at the arguments below. */
static const long double inverse_factorial[] = {1.0L,
                                                1.0L,
                                                1.0L / 2.0L,
                                                1.0L / 6.0L,
                                                1.0L / 24.0L,
                                                1.0L / 120.0L,
                                                1.0L / 720.0L,
                                                1.0L / 5040.0L,
                                                1.0L / 40320.0L,
                                                1.0L / 362880.0L,
                                                1.0L / 3628800.0L,
                                                1.0L / 39916800.0L,
                                                1.0L / 479001600.0L,
                                                1.0L / 6227020800.0L,
                                                1.0L / 87178291200.0L,
                                                1.0L / 1307674368000.0L,
                                                1.0L / 20922789888000.0L,
                                                1.0L / 355687428096000.0L,
                                                1.0L / 6402373705728000.0L,
                                                1.0L / 121645100408832000.0L,
                                                1.0L / 2432902008176640000.0L,
                                                1.0L / 51090942171709440000.0L,
                                                1.0L / 1124000727777607680000.0L,
                                                1.0L / 25852016738884976640000.0L,
                                                1.0L / 620448401733239439360000.0L,
                                                1.0L / 15511210043330985984000000.0L,
                                                1.0L / 403291461126605635584000000.0L,
                                                1.0L / 10888869450418352160768000000.0L,
                                                1.0L / 304888344611713860501504000000.0L,
                                                1.0L / 8841761993739701954543616000000.0L};
/* The last terms that matter for 113 binary digits, and for 64 or fewer. */
enum { SINE_LAST = LDBL_MANT_DIG > 64 ? 29 : 21, EXP_LAST = LDBL_MANT_DIG > 64 ? 29 : 19 };

/* The sum of x^k/k! for k = from, from + 2, ... up to `last`, divided by x^from. With sign = -1 the signs alternate. */
static long double even_series(long double square, int from, int last, long double sign) {
    long double sum = 0.0L;
    for (int k = last - (last - from) % 2; k >= from; k -= 2) {
        sum = inverse_factorial[k] + sign * square * sum;
    }
    return sum;
}

/* A quarter turn in three parts. The first two have 33 binary digits, so that up to 2^31 times each of them is exact. */
#define QUARTER_1 ((long double)UINT64_C(0x1921fb544) / 4294967296.0L)
#define QUARTER_2 ((long double)UINT64_C(0x85a308d3) / 36893488147419103232.0L)
#define QUARTER_3 2.02226624879595073239968462009475771647620240390820e-21L

void long_sincos(long double rad, long double *sine, long double *cosine) {
    const long double turns = rad / (QUARTER_1 + QUARTER_2);
    if (!(long_size(turns) < 2147483648.0L)) {
        *sine = (long double)NAN;
        *cosine = (long double)NAN;
        return;
    }
    const int64_t quarters = (int64_t)(turns < 0.0L ? turns - 0.5L : turns + 0.5L);
    const long double q = (long double)quarters;
    const long double x = ((rad - q * QUARTER_1) - q * QUARTER_2) - q * QUARTER_3;
    const long double s = x * even_series(x * x, 1, SINE_LAST, -1.0L);
    const long double c = even_series(x * x, 0, SINE_LAST, -1.0L);
    const bool swapped = ((uint64_t)quarters & 1U) != 0;
    const bool behind = ((uint64_t)quarters & 2U) != 0;
    const long double first = swapped ? c : s;
    const long double second = swapped ? -s : c;
    *sine = behind ? -first : first;
    *cosine = behind ? -second : second;
}

/* Newton's rule from the double's root. One iteration doubles the digits; a second is needed for 113. */
long double long_root(long double x) {
    if (!(x > 0.0L) || !isfinite(x)) {
        return x < 0.0L ? (long double)NAN : x;
    }
    long double y = (long double)number_root((double)x);
    if (!(y > 0.0L) || !isfinite(y)) { /* outside the range of double */
        return x < 1.0L ? long_root(x * 0x1p512L) * 0x1p-256L : long_root(x * 0x1p-512L) * 0x1p256L;
    }
    y = 0.5L * (y + x / y);
    return 0.5L * (y + x / y);
}

/* --- exponential and logarithm ---------------------------------------------------------------- */

/* ln 2 in two parts: 32 binary digits, so that whole multiples are exact, and the remainder. */
#define LN2_1 ((long double)UINT64_C(0xb17217f7) / 4294967296.0L)
#define LN2_2 1.9082149292705878161442656807550013436025525412068e-10L

static long double two_to(int n) {
    long double result = 1.0L;
    const long double factor = n < 0 ? 0.5L : 2.0L;
    for (int k = n < 0 ? -n : n; k > 0; k--) {
        result *= factor;
    }
    return result;
}

static long double exponential(long double x) {
    if (!(x > -12000.0L && x < 12000.0L)) {
        return x < 0.0L ? 0.0L : x > 0.0L ? (long double)INFINITY : x;
    }
    const int n = (int)(x / LN2_1 + (x < 0.0L ? -0.5L : 0.5L));
    const long double r = (x - (long double)n * LN2_1) - (long double)n * LN2_2;
    long double sum = 0.0L;
    for (int k = EXP_LAST; k >= 0; k--) {
        sum = inverse_factorial[k] + r * sum;
    }
    return sum * two_to(n);
}

/* 2 atanh((x - 1)/(x + 1)) near 1; else corrects a double's logarithm y by log(x exp(-y)). */
static long double logarithm(long double x) {
    if (!(x > 0.0L) || !isfinite(x)) {
        return x < 0.0L ? (long double)NAN : x > 0.0L || x != x ? x : -(long double)INFINITY;
    }
    if (x > 0.8L && x < 1.25L) {
        const long double s = (x - 1.0L) / (x + 1.0L); /* below 1/9: each term adds 6 bits */
        long double sum = 0.0L;
        for (int k = 2 * (LDBL_MANT_DIG / 6) + 1; k >= 1; k -= 2) {
            sum = 1.0L / (long double)k + s * s * sum;
        }
        return 2.0L * s * sum;
    }
    const long double y = (long double)number_call(FN_LOG, (double)x, 0.0);
    if (!isfinite(y)) {
        return x < 1.0L ? logarithm(x * 0x1p512L) - 512.0L * (LN2_1 + LN2_2)
                        : logarithm(x * 0x1p-512L) + 512.0L * (LN2_1 + LN2_2);
    }
    const long double d = x * exponential(-y) - 1.0L;
    return y + (d - d * d / 2.0L);
}

static bool is_whole(long double x) {
    return long_size(x) < 0x1p62L && (long double)(int64_t)x == x;
}

static long double whole_power(long double base, uint64_t exponent) {
    long double result = 1.0L;
    for (; exponent != 0; exponent >>= 1) {
        result *= (exponent & 1U) != 0 ? base : 1.0L;
        base *= base;
    }
    return result;
}

long double long_power(long double base, long double exponent) {
    if (is_whole(exponent) && long_size(exponent) <= 1024.0L) {
        const long double power = whole_power(base, (uint64_t)long_size(exponent));
        return exponent < 0.0L ? 1.0L / power : power;
    }
    if (base == 0.0L) {
        return exponent > 0.0L ? 0.0L : (long double)INFINITY;
    }
    if (base < 0.0L && is_whole(exponent)) {
        const long double size = exponential(exponent * logarithm(-base));
        return ((int64_t)exponent & 1) != 0 ? -size : size;
    }
    return exponential(exponent * logarithm(base));
}

/* --- angles of ratios, hyperbolic functions ------------------------------------------------------ */

/* Corrects a double's angle y by the angle of (x - tan y)/(1 + x tan y), which is so small that its series ends with the cube. */
static long double angle_of(long double x) {
    if (x != x || !isfinite((double)x)) {
        return x != x ? x : x < 0.0L ? -(QUARTER_1 + QUARTER_2) : QUARTER_1 + QUARTER_2;
    }
    long double s;
    long double c;
    const long double y = (long double)number_call(FN_ATAN, (double)x, 0.0);
    long_sincos(y, &s, &c);
    const long double d = (x * c - s) / (c + x * s);
    return y + (d - d * d * d / 3.0L);
}

static long double angle_of_two(long double y, long double x) {
    const long double half = 2.0L * (QUARTER_1 + QUARTER_2) + 2.0L * QUARTER_3;
    if (x == 0.0L && y == 0.0L) { /* the zeros' signs count */
        return (long double)number_call(FN_ATAN2, (double)y, (double)x);
    }
    if (long_size(y) > long_size(x)) {
        const long double quarter = y < 0.0L ? -half / 2.0L : half / 2.0L;
        return quarter - angle_of(x / y);
    }
    const long double small = angle_of(y / x);
    return x > 0.0L ? small : y < 0.0L || (y == 0.0L && signbit(y)) ? small - half : small + half;
}

static long double hyperbolic_sine(long double x) {
    if (long_size(x) < 0.5L) {
        return x * even_series(x * x, 1, EXP_LAST, 1.0L);
    }
    const long double up = exponential(x);
    return 0.5L * (up - 1.0L / up);
}

static long double hyperbolic_cosine(long double x) {
    const long double up = exponential(x);
    return 0.5L * (up + 1.0L / up);
}

static long double hyperbolic_tangent(long double x) {
    if (long_size(x) > 40.0L) {
        return x < 0.0L ? -1.0L : 1.0L;
    }
    return hyperbolic_sine(x) / hyperbolic_cosine(x);
}

long double long_call(function_id function, long double x, long double y) {
    long double s;
    long double c;
    switch (function) {
    case FN_SIN: long_sincos(x, &s, &c); return s;
    case FN_COS: long_sincos(x, &s, &c); return c;
    case FN_TAN: long_sincos(x, &s, &c); return s / c;
    case FN_ASIN: return angle_of_two(x, long_root((1.0L - x) * (1.0L + x)));
    case FN_ACOS: return angle_of_two(long_root((1.0L - x) * (1.0L + x)), x);
    case FN_ATAN: return angle_of_two(x, 1.0L);
    case FN_ATAN2: return angle_of_two(x, y);
    case FN_SQRT: return long_root(x);
    case FN_EXP: return exponential(x);
    case FN_LOG: return logarithm(x);
    case FN_ABS: return long_size(x);
    case FN_SIGN: return x != x ? x : (long double)((x > 0.0L) - (x < 0.0L));
    case FN_MIN: return y < x || y != y ? y : x;
    case FN_MAX: return y > x || y != y ? y : x;
    case FN_SINH: return hyperbolic_sine(x);
    case FN_COSH: return hyperbolic_cosine(x);
    case FN_TANH: return hyperbolic_tangent(x);
    }
    return (long double)NAN;
}

/* --- lists -----------------------------------------------------------------------------------------*/

struct long_list {
    const op_list *list;
    long double *value;
    long double *sine;
    long double *cosine;
};

long_list *long_list_new(const op_list *t) {
    long_list *l = alloc(1, sizeof *l);
    *l = (long_list){t, alloc(t->count, sizeof(long double)), alloc(t->count, sizeof(long double)),
                     alloc(t->count, sizeof(long double))};
    return l;
}

void long_list_free(long_list *l) {
    if (l != NULL) {
        free(l->value);
        free(l->sine);
        free(l->cosine);
        free(l);
    }
}

static long double phase_of(const op_list *t, const op *o, const long_leaves *in) {
    long double sum = (long double)o->value;
    for (int i = 0; i < t->angles && o->turns != NULL; i++) {
        sum += (long double)o->turns[i] * in->angle_rad[i];
    }
    for (int i = 0; i < t->angles && o->parts != NULL; i++) {
        sum += (long double)o->parts[i] * in->angle_rad[i];
    }
    return sum;
}

/* The cell of a phase. References use the exact list, which has no cells: the middle of the cell suffices. */
static long double cell_of(const op_list *t, long double phase_rad) {
    const long double turns = phase_rad / 6.28318530717958647692528676655900577L;
    const double cells = (double)(1U << (unsigned)t->tables.bits);
    const long double whole = (long double)number_floor((double)turns);
    const double at = number_floor((double)(turns - whole) * cells + 0.5);
    return (long double)((at < cells ? at : 0.0) * t->tables.count * t->tables.terms);
}

/* The operands of operation o, if they are values. */
#define A (l->value[o->a])
#define B (l->value[o->b])

static long double value_of(long_list *l, int i, const long_leaves *in) {
    const op *o = &l->list->ops[i];
    switch (o->code) {
    case OP_CONSTANT: return (long double)o->value;
    case OP_LINEAR: return in->linear[o->a];
    case OP_RATE: return in->rate[o->a];
    case OP_INPUT: return (long double)in->input[o->a];
    case OP_ACCEL:
    case OP_NOISE: return 0.0L;
    case OP_TIME: return in->time_s;
    case OP_RADIANS: return in->angle_rad[o->a];
    case OP_PHASE:
        long_sincos(phase_of(l->list, o, in) + (o->b >= 0 ? B : 0.0L), &l->sine[i], &l->cosine[i]);
        return 0.0L;
    case OP_SIN: return l->sine[o->a];
    case OP_COS: return l->cosine[o->a];
    case OP_ADD: return A + B;
    case OP_SUB: return A - B;
    case OP_MUL: return A * B;
    case OP_DIV: return A / B;
    case OP_NEG: return -A;
    case OP_SQRT: return long_call(FN_SQRT, A, 0.0L);
    case OP_ABS: return long_call(FN_ABS, A, 0.0L);
    case OP_SIGN: return long_call(FN_SIGN, A, 0.0L);
    case OP_MIN: return long_call(FN_MIN, A, B);
    case OP_MAX: return long_call(FN_MAX, A, B);
    case OP_CALL: return long_call(o->function, A, o->b >= 0 ? B : 0.0L);
    case OP_POW: return long_power(A, B);
    case OP_CELL: return cell_of(l->list, phase_of(l->list, o, in));
    case OP_LINE:
    case OP_CUBIC: return (long double)l->list->tables.number[(size_t)A + (size_t)o->value];
    }
    return 0.0L;
}

#undef A
#undef B

void long_list_run(long_list *l, const long_leaves *in, long double *result) {
    const op_list *t = l->list;
    for (int i = 0; i < t->count; i++) {
        l->value[i] = value_of(l, i, in);
    }
    for (int i = 0; i < t->results; i++) {
        result[i] = l->value[t->result[i]];
    }
}

bool long_list_asks(const op_list *t, int result, op_code code) {
    bool *needed = alloc(t->count, sizeof *needed);
    bool found = false;
    op_list_mark_needed(t, t->result[result], needed);
    for (int i = t->result[result]; i >= 0; i--) {
        found = found || (needed[i] && t->ops[i].code == code);
    }
    free(needed);
    return found;
}

/* === extrapolation ============================================================================ */

struct extrapolation {
    const image *image;
    extrapolation_setting how;
    long_list *list;
    evaluator *rough; /* evaluates in double, for bounds on the list's round-off */
    double *input;    /* [inputs] */
    int count;        /* components */
    long double *state;
    long double *lost;  /* round-off of the sums of steps (Kahan) */
    long double *slope; /* slope at the state */
    long double *largest;
    long double *row[2]; /* [columns][count]: two rows of the tableau */
    long double *before, *here, *work;
    double *rounding;   /* [results] of the list */
    long double step_s; /* length of the next tried step; 0: not chosen yet */
    double operations;
    double most_operations;
};

static long double *numbers(int count) { return alloc(count, sizeof(long double)); }

static void slope_at(extrapolation *e, const long double *state, long double *slope) {
    const image *im = e->image;
    const int linear = im->form == WH_SECOND_ORDER ? im->coordinates - im->angles : im->reals;
    const long double *rate = state + im->angles + linear;
    const long_leaves in = {state, state + im->angles, rate, e->input, 0.0L};
    e->operations += im->list[IMAGE_STEP]->count;
    if (im->form == WH_SECOND_ORDER) {
        memcpy(slope, rate, (size_t)im->coordinates * sizeof *slope);
        long_list_run(e->list, &in, slope + im->coordinates);
    } else {
        long_list_run(e->list, &in, slope);
    }
}

extrapolation *extrapolation_new(const image *im, extrapolation_setting how, double operations) {
    extrapolation *e = alloc(1, sizeof *e);
    const int count = im->angles + im->reals;
    *e = (extrapolation){.image = im,
                         .how = how,
                         .list = long_list_new(im->list[IMAGE_STEP]),
                         .rough = evaluator_new(im->list[IMAGE_STEP]),
                         .input = alloc(im->inputs, sizeof *e->input),
                         .count = count,
                         .state = numbers(count),
                         .lost = numbers(count),
                         .slope = numbers(count),
                         .largest = numbers(count),
                         .row = {numbers(count * how.columns), numbers(count * how.columns)},
                         .before = numbers(count),
                         .here = numbers(count),
                         .work = numbers(count),
                         .rounding = alloc(im->list[IMAGE_STEP]->results, sizeof *e->rounding),
                         .most_operations = operations};
    image_inputs(im, e->input);
    for (int i = 0; i < count; i++) {
        e->state[i] = (long double)image_start(im, i);
        e->largest[i] = long_size(e->state[i]);
    }
    return e;
}

void extrapolation_free(extrapolation *e) {
    if (e == NULL) {
        return;
    }
    long_list_free(e->list);
    evaluator_free(e->rough);
    free(e->input);
    free(e->state);
    free(e->lost);
    free(e->slope);
    free(e->largest);
    free(e->row[0]);
    free(e->row[1]);
    free(e->before);
    free(e->here);
    free(e->work);
    free(e->rounding);
    free(e);
}

const long double *extrapolation_state(const extrapolation *e) { return e->state; }
double extrapolation_operations(const extrapolation *e) { return e->operations; }

/* The scale of a step's error: the largest value so far, or the round-off of the list's own operations within the
 * step. The latter matters for a component that should stay at zero. */
static void scale_of(extrapolation *e, long double span_s, long double *scale) {
    const image *im = e->image;
    const int linear = im->form == WH_SECOND_ORDER ? im->coordinates - im->angles : im->reals;
    double value[2 * IMAGE_COMPONENTS_MAX];
    double slope[2 * IMAGE_COMPONENTS_MAX];
    for (int i = 0; i < e->count; i++) {
        value[i] = (double)e->state[i];
    }
    evaluator_run(e->rough, 0.0, value, value + im->angles, value + im->angles + linear, e->input,
                  slope);
    evaluator_rounding(e->rough, value, 0.0, e->rounding);
    const int first = im->form == WH_SECOND_ORDER ? im->coordinates : 0;
    for (int i = 0; i < e->count; i++) {
        scale[i] = e->largest[i];
        if (i >= first && isfinite(e->rounding[i - first])) {
            const long double rounded = span_s * (long double)e->rounding[i - first];
            scale[i] = rounded > scale[i] ? rounded : scale[i];
        }
    }
    for (int i = 0; i < first; i++) { /* the error of a rate moves its coordinate */
        const long double moved = span_s * scale[first + i];
        scale[i] = moved > scale[i] ? moved : scale[i];
    }
}

/* The increment of the state by the modified midpoint rule with this many substeps. Increments are summed and
 * extrapolated instead of states, so that a short step has little round-off. Returns false if a value is not finite. */
static bool midpoint(extrapolation *e, long double span_s, int substeps, long double *result) {
    const long double h = span_s / (long double)substeps;
    long double *here = result; /* increments after k substeps, and one before */
    for (int i = 0; i < e->count; i++) {
        e->before[i] = 0.0L;
        here[i] = h * e->slope[i];
    }
    for (int k = 1; k < substeps; k++) {
        for (int i = 0; i < e->count; i++) {
            e->here[i] = e->state[i] + here[i];
        }
        slope_at(e, e->here, e->work);
        for (int i = 0; i < e->count; i++) {
            const long double next = e->before[i] + 2.0L * h * e->work[i];
            e->before[i] = here[i];
            here[i] = next;
        }
    }
    bool finite = true;
    for (int i = 0; i < e->count; i++) {
        finite = finite && isfinite(here[i]);
    }
    return finite;
}

/* The increment of a step by the last column; *error is the difference of the last two, as a part of the tolerance.
 * Infinite if a value is not finite: the increment is then invalid. */
static const long double *try_step(extrapolation *e, long double span_s, double *error) {
    long double scale[2 * IMAGE_COMPONENTS_MAX] = {0};
    const int n = e->count;
    const int columns = e->how.columns;
    scale_of(e, span_s, scale);
    long double *above = e->row[0];
    long double *row = e->row[1];
    for (int j = 0; j < columns; j++) {
        if (!midpoint(e, span_s, 2 * (j + 1), row)) {
            *error = (double)INFINITY;
            return row;
        }
        for (int k = 1; k <= j; k++) {
            const long double ratio = (long double)(j + 1) / (long double)(j + 1 - k);
            for (int i = 0; i < n; i++) {
                const long double better = row[(k - 1) * n + i];
                row[k * n + i] =
                    better + (better - above[(k - 1) * n + i]) / (ratio * ratio - 1.0L);
            }
        }
        long double *swap = above;
        above = row;
        row = swap;
    }
    *error = 0.0;
    const long double *made = above + (size_t)(columns - 1) * (size_t)n;
    const long double *other = above + (size_t)(columns - 2) * (size_t)n;
    for (int i = 0; i < n; i++) {
        const long double size = long_size(e->state[i] + made[i]);
        const long double allowed = size > scale[i] ? size : scale[i];
        const long double off = long_size(made[i] - other[i]);
        if (!isfinite(off)) {
            *error = (double)INFINITY;
        } else if (off > 0.0L) {
            *error = number_most(*error, (double)(off / allowed) / e->how.tolerance);
        }
    }
    return made;
}

/* Kahan's sum: the next step adds back the round-off of the last. */
static void take(extrapolation *e, const long double *made) {
    for (int i = 0; i < e->count; i++) {
        const long double move = made[i] - e->lost[i];
        const long double moved = e->state[i] + move;
        e->lost[i] = (moved - e->state[i]) - move;
        e->state[i] = moved;
        const long double size = long_size(moved);
        e->largest[i] = size > e->largest[i] ? size : e->largest[i];
    }
}

/* The factor for the length of the next step after one with this error, which grows with the power 2 columns - 1 of the length. */
static long double longer(const extrapolation *e, double error) {
    if (!(error > 0.0)) {
        return 3.0L;
    }
    if (!isfinite(error)) {
        return 0.2L;
    }
    const double factor = 0.9 * number_power(error, -1.0 / (2.0 * e->how.columns - 1.0));
    return (long double)number_least(number_most(factor, 0.2), 3.0);
}

extrapolation_status extrapolation_go(extrapolation *e, long double span_s) {
    long double left_s = span_s;
    if (!(e->step_s > 0.0L)) {
        e->step_s = span_s;
    }
    while (left_s > 0.0L) {
        const bool last = e->step_s >= left_s;
        const long double step_s = last                         ? left_s
                                   : 2.0L * e->step_s >= left_s ? 0.5L * left_s
                                                                : e->step_s;
        slope_at(e, e->state, e->slope);
        double error;
        const long double *made = try_step(e, step_s, &error);
        if (e->operations > e->most_operations) {
            return EXTRAPOLATION_LONG;
        }
        const long double next_s = step_s * longer(e, error);
        if (error <= 1.0) {
            take(e, made);
            left_s = last ? 0.0L : left_s - step_s;
            e->step_s = !last || next_s > e->step_s ? next_s : e->step_s;
        } else {
            e->step_s = next_s < 0.7L * step_s ? next_s : 0.7L * step_s;
        }
        if (!(e->step_s > 1e-9L * span_s)) {
            return EXTRAPOLATION_SMALL;
        }
    }
    return EXTRAPOLATION_OK;
}

/* === the deviation of a run =================================================================== */

/* Enter a record; false if the run is useless from now on. */
static bool enter(const reference *r, const records *now, int record, deviation_of_what what,
                  deviation *d) {
    const long double *row = r->row + (size_t)record * (size_t)r->columns;
    for (int k = 1; k < r->columns; k++) {
        const reference_column *c = &r->column[k];
        if (what.column >= 0 ? k != what.column : !c->counts) {
            continue;
        }
        const long double unit = what.column >= 0 ? 1.0L : c->largest;
        const double off = (double)(long_size((long double)now->row[k] - row[k]) / unit);
        if (d->column < 0 || !(off <= d->error)) { /* also true for NaN */
            d->error = off;
            d->column = k;
            d->known = (double)(c->off / unit);
        }
    }
    return d->error <= what.give_up;
}

/* Evaluations so far. With contacts, reading a record is also an evaluation, but not one of a step. */
typedef struct counted {
    double in_steps;
    double most; /* most evaluations in one step */
} counted;

/* Makes one step. With contacts the cost of a step varies; a step by one matrix evaluates one list. */
static bool take_step(const engine_kind *kind, void *run, const image *im, counted *c) {
    uint64_t declared;
    const bool matrix = im->list[IMAGE_MATRIX] != NULL;
    const uint64_t before = kind->evaluations(run, &declared);
    const bool good = loop_steps(kind, run, 1) == WH_OK;
    const double taken = matrix ? 1.0 : (double)(kind->evaluations(run, &declared) - before);
    c->in_steps += taken;
    c->most = taken > c->most ? taken : c->most;
    return good;
}

deviation deviation_measure(const reference *r, const image *im, const engine_kind *kind,
                            deviation_pace pace, deviation_of_what what) {
    deviation d = {.column = what.column};
    counted c = {0.0, 0.0};
    records *now = records_open(NULL, im, kind);
    void *run = kind->start(im);
    records_read(now, run, 0.0);
    bool good = enter(r, now, 0, what, &d);
    const int each = (int)pace.records;
    for (int i = each; i <= r->records && good && !interrupted; i += each) {
        for (uint64_t k = 0; k < pace.steps && good; k++) {
            good = take_step(kind, run, im, &c);
        }
        if (good) {
            records_read(now, run, 0.0);
            good = enter(r, now, i, what, &d);
        }
    }
    uint64_t most;
    const bool matrix = im->list[IMAGE_MATRIX] != NULL; /* a step then evaluates only that */
    const uint64_t evaluations = matrix ? kind->steps(run) : kind->evaluations(run, &most);
    d.operations =
        (double)evaluations * (double)im->list[matrix ? IMAGE_MATRIX : IMAGE_STEP]->count;
    const double time_s = ratio_times(kind->steps(run), im->step);
    d.evaluations = time_s > 0.0 ? c.in_steps / time_s : 0.0;
    d.evaluations_most = im->contacts > 0 ? c.most
                         : matrix         ? 1.0
                                          : (double)wh_methods[im->settings.method].stages;
    d.usable = good && (kind->saturated == NULL || kind->saturated(run) == 0);
    kind->stop(run);
    records_close(now);
    return d;
}

/* === the reference ============================================================================ */

/* --- a state as a row of records -------------------------------------------------------------------*/

struct long_rows {
    const records *shape;
    long_list *observe;
    double *input;
    long double *output; /* [image->outputs] */
};

long_rows *long_rows_new(const records *shape) {
    const image *im = shape->image;
    long_rows *l = alloc(1, sizeof *l);
    *l = (long_rows){shape, long_list_new(im->list[IMAGE_OBSERVE]),
                     alloc(im->inputs, sizeof *l->input), alloc(im->outputs, sizeof *l->output)};
    image_inputs(im, l->input);
    return l;
}

void long_rows_free(long_rows *l) {
    if (l != NULL) {
        long_list_free(l->observe);
        free(l->input);
        free(l->output);
        free(l);
    }
}

static int column_of(const records *r, component c) {
    int column = 1;
    while (r->column[column].unknown != c.unknown || r->column[column].primes != c.primes) {
        column++;
    }
    return column;
}

void long_rows_read(long_rows *l, const long double *state, long double time_s, long double *row) {
    const records *r = l->shape;
    const image *im = r->image;
    const long double *real = state + im->angles;
    const int linear = im->form == WH_SECOND_ORDER ? im->coordinates - im->angles : 0;
    const long_leaves in = {state, real, real + linear, l->input, time_s};
    long_list_run(l->observe, &in, l->output);
    memset(row, 0, (size_t)r->columns * sizeof *row);
    for (int i = 0; i < im->angles + im->reals; i++) {
        row[column_of(r, image_component(im, i))] = state[i];
    }
    for (int i = 0; i < im->own_outputs; i++) {
        row[r->columns - im->own_outputs + i] = l->output[i];
    }
    for (int k = 0; k < im->recovered; k++) {
        for (int primes = 0; primes < 2; primes++) {
            const component c = {im->from_momentum[k], primes};
            row[column_of(r, c)] = l->output[im->own_outputs + 2 * k + primes];
        }
    }
    for (int i = 1; i < r->columns; i++) {
        const image_unit *u = r->column[i].unit;
        row[i] = row[i] * (long double)u->divisor / (long double)u->scale;
    }
    row[0] = time_s;
}

/* --- by fine steps ---------------------------------------------------------------------------------*/

/* The steps are this many times finer than the scene's, if the limit of operations allows it. */
#define FINER 16.0
/* Evaluations in a step: those of RK4, and those of the search for events. */
#define EVALUATIONS 4.0
#define EVALUATIONS_CONTACTS 12.0

uint64_t fine_steps_of(const reference_wish *w) {
    const image *im = w->image;
    if (w->by.steps > 0) {
        return w->by.steps;
    }
    const double spacing_s = ratio_times(1, w->spacing);
    const double each =
        (im->contacts > 0 ? EVALUATIONS_CONTACTS : EVALUATIONS) * im->list[IMAGE_STEP]->count;
    const double wanted = number_ceiling(FINER * spacing_s / im->step_s / 2.0);
    const double affordable = number_floor(w->operations / each / w->records / 2.0);
    return 2U * (uint64_t)number_most(1.0, number_least(wanted, affordable));
}

int fine_steps_run(const reference_wish *w, const records *shape, uint64_t steps,
                   long double *row) {
    image copy = *w->image;
    copy.settings = (image_settings)IMAGE_SETTINGS_DEFAULT;
    copy.settings.compensated = true;
    copy.list[IMAGE_MATRIX] = NULL;
    if (w->by.steps > 0) {
        copy.settings.method = w->by.method;
    }
    copy.step = (whole_ratio){w->spacing.numerator, w->spacing.denominator * steps};
    copy.step_s = ratio_times(1, copy.step);
    copy.steps = steps * (uint64_t)w->records;
    records *r = records_open(NULL, &copy, &engine_double);
    void *run = engine_double.start(&copy);
    int done = 0;
    for (;; done++) {
        records_read(r, run, ratio_times((uint64_t)done, w->spacing));
        for (int i = 0; i < shape->columns; i++) {
            row[(size_t)done * (size_t)shape->columns + (size_t)i] = (long double)r->row[i];
        }
        if (done == w->records || interrupted || loop_steps(&engine_double, run, steps) != WH_OK) {
            break;
        }
    }
    engine_double.stop(run);
    records_close(r);
    return done;
}

/* --- the two computations and their agreement ------------------------------------------------------*/

/* The settings of the two extrapolations. The second has another order, and so other steps. */
static const extrapolation_setting fine = {6, 16.0 * (double)LDBL_EPSILON};
static const extrapolation_setting coarse = {5, 64.0 * (double)LDBL_EPSILON};

/* A record is trusted while the two computations differ by less than this part of a column's largest value. In long double
 * they differ by less than 1e-16 at first. When the difference reaches the limit, the motion has amplified the round-off. */
#define LIMIT_EXTRAPOLATED (LONG_IS_LONGER ? 1e-12 : 1e-9)
#define LIMIT_FINE_STEPS 1e-6
/* A column is known if the two computations agree up to a record at which its value has reached this part of its largest
 * value. Otherwise it is only round-off of the motion or of the list's constants. */
#define KNOWN_BY 1e-6L

typedef struct computed {
    long double *row; /* [wanted + 1][columns] */
    int records;      /* after the start */
    extrapolation_status status;
} computed;

static long double *rows_of(const reference *r) {
    return alloc((int64_t)(r->wanted + 1) * r->columns, sizeof(long double));
}

static computed extrapolate(const reference_wish *w, const reference *r,
                            extrapolation_setting how) {
    computed c = {rows_of(r), 0, EXTRAPOLATION_OK};
    long_rows *rows = long_rows_new(r->shape);
    extrapolation *e = extrapolation_new(w->image, how, w->operations);
    const long double spacing_s =
        (long double)w->spacing.numerator / (long double)w->spacing.denominator;
    for (int i = 0;; i++) {
        long double *row = c.row + (size_t)i * (size_t)r->columns;
        long_rows_read(rows, extrapolation_state(e), (long double)i * spacing_s, row);
        c.records = i;
        if (i < r->wanted) {
            c.status = extrapolation_go(e, spacing_s);
        }
        if (i == r->wanted || c.status != EXTRAPOLATION_OK || interrupted) {
            break;
        }
    }
    extrapolation_free(e);
    long_rows_free(rows);
    return c;
}

static long double row_off(const reference *r, const computed *other, int record, int column) {
    const size_t at = (size_t)record * (size_t)r->columns + (size_t)column;
    const long double off = long_size(r->row[at] - other->row[at]);
    return isfinite(off) ? off : (long double)INFINITY;
}

/* Finds a column's largest value and largest difference over the records up to `until`. */
static void measure(reference *r, const computed *other, int until, int column) {
    reference_column *c = &r->column[column];
    c->largest = 0.0L;
    c->off = 0.0L;
    for (int i = 0; i <= until; i++) {
        const long double size = long_size(r->row[(size_t)i * (size_t)r->columns + (size_t)column]);
        const long double off = row_off(r, other, i, column);
        c->largest = size > c->largest ? size : c->largest;
        c->off = off > c->off ? off : c->off;
    }
}

/* Is this column, whose largest value is set, known (KNOWN_BY)? */
static bool is_known(const reference *r, const computed *other, int until, int column) {
    const long double enough = KNOWN_BY * r->column[column].largest;
    long double largest = 0.0L;
    long double off = 0.0L;
    for (int i = 0; i <= until; i++) {
        const long double size = long_size(r->row[(size_t)i * (size_t)r->columns + (size_t)column]);
        const long double now = row_off(r, other, i, column);
        largest = size > largest ? size : largest;
        off = now > off ? now : off;
        if (i > 0 && largest > 0.0L && largest >= enough &&
            off <= (long double)r->limit * largest) {
            return true;
        }
    }
    return false;
}

/* Decides which columns count, and up to which record the computations agree. */
static void judge(reference *r, const computed *other) {
    const int both = other->records < r->records ? other->records : r->records;
    for (int k = 1; k < r->columns; k++) {
        measure(r, other, both, k);
        r->column[k].counts = r->shape->column[k].unknown >= 0 && is_known(r, other, both, k);
    }
    r->records = both;
    for (int k = 1; k < r->columns; k++) {
        const reference_column *c = &r->column[k];
        for (int i = 0; i <= r->records && c->counts; i++) {
            if (row_off(r, other, i, k) > (long double)r->limit * c->largest) {
                r->records = i - 1;
            }
        }
    }
    for (int k = 1; k < r->columns; k++) {
        measure(r, other, r->records < 0 ? 0 : r->records, k);
    }
}

static double time_of(const reference_wish *w, int record) {
    return ratio_times((uint64_t)(record < 0 ? 0 : record), w->spacing);
}

static void say_extrapolated(const reference_wish *w, reference *r, extrapolation_status status,
                             int reached) {
    r->how = alloc_words(
        "extrapolation of order %d in long double (%d binary digits), tolerance %.2g; compared with order %d, %.2g",
        2 * fine.columns, LDBL_MANT_DIG, fine.tolerance, 2 * coarse.columns, coarse.tolerance);
    if (r->records < reached) {
        r->why = alloc_words(
            "the two references diverge: by %.0e of a component's largest value after %.9g s, from less than 1e-15 at the start",
            r->limit, time_of(w, r->records));
    } else if (status == EXTRAPOLATION_SMALL) {
        r->why = alloc_words(
            "after %.9g s no step is small enough for the reference: a jump, a pole or an undefined value",
            time_of(w, r->records));
    } else if (status == EXTRAPOLATION_LONG) {
        r->why = alloc_words("the reference took too long after %.9g s", time_of(w, r->records));
    }
}

static reference *begin(const reference_wish *w) {
    reference *r = alloc(1, sizeof *r);
    r->shape = records_open(NULL, w->image, &engine_double);
    r->columns = r->shape->columns;
    r->wanted = w->records;
    r->column = alloc(r->columns, sizeof *r->column);
    return r;
}

static reference *by_extrapolation(const reference_wish *w) {
    reference *r = begin(w);
    const computed best = extrapolate(w, r, fine);
    const computed other = extrapolate(w, r, coarse);
    r->kind = REFERENCE_EXTRAPOLATED;
    r->limit = LIMIT_EXTRAPOLATED;
    r->row = best.row;
    r->records = best.records;
    const int reached = best.records < other.records ? best.records : other.records;
    judge(r, &other);
    r->broken = r->records >= reached && reached < r->wanted;
    say_extrapolated(w, r, best.status != EXTRAPOLATION_OK ? best.status : other.status, reached);
    free(other.row);
    r->stopped = interrupted != 0;
    return r;
}

static reference *by_fine_steps(const reference_wish *w) {
    reference *r = begin(w);
    const uint64_t steps = fine_steps_of(w);
    r->row = rows_of(r);
    computed other = {rows_of(r), 0, EXTRAPOLATION_OK};
    r->records = fine_steps_run(w, r->shape, steps, r->row);
    other.records = fine_steps_run(w, r->shape, steps / 2U, other.row);
    const int reached = r->records < other.records ? r->records : other.records;
    r->kind = REFERENCE_FINE_STEPS;
    r->limit = w->by.steps > 0 ? w->by.limit : LIMIT_FINE_STEPS;
    judge(r, &other);
    for (int k = 1; k < r->columns && w->by.steps > 0; k++) { /* finer run's error, by its order */
        r->column[k].off /= (long double)number_scaled(1.0, w->by.order) - 1.0L;
    }
    free(other.row);
    r->how = alloc_words(
        "rk4 in double with compensated sums by steps of %.6g s; compared with twice that step: a reference that shares the core's step and events",
        time_of(w, 1) / (double)steps);
    if (r->records < reached) {
        r->why = alloc_words(
            "the two references differ by more than %.0e of a component's largest value after %.9g s: the motion diverges, or events come in another order",
            r->limit, time_of(w, r->records));
    } else if (reached < r->wanted) {
        r->why = alloc_words("the run fails after %.9g s", time_of(w, r->records));
    }
    r->stopped = interrupted != 0;
    return r;
}

/* Does a coordinate or a rate move? Outputs do not matter. */
static bool moves(const reference *r) {
    for (int k = 1; k < r->columns; k++) {
        for (int i = 0; r->shape->column[k].unknown >= 0 && i <= (r->records < 0 ? 0 : r->records);
             i++) {
            if (r->row[(size_t)i * (size_t)r->columns + (size_t)k] != r->row[k]) {
                return true;
            }
        }
    }
    return false;
}

/* Is any column known? If not, the agreement of all records proves nothing. */
static bool knows(const reference *r) {
    for (int k = 1; k < r->columns; k++) {
        if (r->column[k].counts) {
            return true;
        }
    }
    return false;
}

reference *reference_new(const reference_wish *w) {
    const bool steps = w->image->contacts > 0 || w->by.steps > 0;
    reference *r = steps ? by_fine_steps(w) : by_extrapolation(w);
    if (!r->stopped && r->broken) {          /* no step of the extrapolation was small enough */
        reference *other = by_fine_steps(w); /* fixed steps also pass kinks and jumps */
        if (knows(other) && (other->records > r->records || !knows(r))) {
            reference *swap = r;
            r = other;
            other = swap;
        }
        reference_free(other);
    }
    if (r->records < 1 || !knows(r)) {
        r->kind = REFERENCE_NONE;
        if (r->why == NULL) {
            r->still = !moves(r);
            r->why = alloc_words(
                !r->still
                    ? "the two references never agree: the motion is only round-off, or the horizon is too long"
                    : "nothing moves");
        }
    }
    return r;
}

void reference_cut(reference *r, int until) {
    r->records = until < r->records ? until : r->records;
    for (int k = 1; k < r->columns; k++) {
        r->column[k].largest = 0.0L;
        for (int i = 0; i <= r->records; i++) {
            const long double size = long_size(r->row[(size_t)i * (size_t)r->columns + (size_t)k]);
            r->column[k].largest = size > r->column[k].largest ? size : r->column[k].largest;
        }
        r->column[k].counts = r->column[k].counts && r->column[k].largest > 0.0L;
    }
}

double reference_agreement(const reference *r) {
    double worst = 0.0;
    for (int k = 1; k < r->columns; k++) {
        const reference_column *c = &r->column[k];
        if (c->counts) {
            worst = number_most(worst, (double)(c->off / c->largest));
        }
    }
    return worst;
}

void reference_free(reference *r) {
    if (r != NULL) {
        records_close(r->shape);
        free(r->row);
        free(r->column);
        free(r->how);
        free(r->why);
        free(r);
    }
}

int reference_find(const reference *r, const char *name, bool *noisy) {
    const image *im = r->shape->image;
    const size_t length = strcspn(name, "'");
    const int primes = (int)strlen(name + length);
    *noisy = false;
    for (int k = 1; k < r->columns; k++) {
        const record_column *c = &r->shape->column[k];
        if (strlen(c->name) == length && strncmp(c->name, name, length) == 0 &&
            c->primes == primes && strspn(name + length, "'") == (size_t)primes) {
            *noisy = c->unknown < 0 && long_list_asks(im->list[IMAGE_OBSERVE],
                                                      k - (r->columns - im->own_outputs), OP_NOISE);
            return k;
        }
    }
    return -1;
}

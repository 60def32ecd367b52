#include "long_list.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include "host/base/alloc.h"
#include "host/number/functions.h"

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
/* The last terms that a number of 64 or fewer digits takes notice of, and one of 113. */
enum { SINE_LAST = LDBL_MANT_DIG > 64 ? 29 : 21, EXP_LAST = LDBL_MANT_DIG > 64 ? 29 : 19 };

/* sum of x^k/k!, k = from, from + 2, ... up to `last`, with signs that take turns for sign = -1; x^from left out. */
static long double even_series(long double square, int from, int last, long double sign) {
    long double sum = 0.0L;
    for (int k = last - (last - from) % 2; k >= from; k -= 2) {
        sum = inverse_factorial[k] + sign * square * sum;
    }
    return sum;
}

/* A quarter turn in three parts: the first two have 33 digits, so that up to 2^31 of them are exact. */
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

/* Newton's rule from the double's root: one round doubles its digits; the second is for 113 of them. */
long double long_root(long double x) {
    if (!(x > 0.0L) || !isfinite(x)) {
        return x < 0.0L ? (long double)NAN : x;
    }
    long double y = (long double)number_root((double)x);
    if (!(y > 0.0L) || !isfinite(y)) { /* no double is as large or small */
        return x < 1.0L ? long_root(x * 0x1p512L) * 0x1p-256L : long_root(x * 0x1p-512L) * 0x1p256L;
    }
    y = 0.5L * (y + x / y);
    return 0.5L * (y + x / y);
}

/* --- exponential and logarithm ---------------------------------------------------------------- */

/* ln 2: 32 digits, so that whole multiples are exact, and the rest. */
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
        const long double s = (x - 1.0L) / (x + 1.0L); /* below 1/9: 6 binary digits a term */
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

/* Corrects a double's angle y by the angle of (x - tan y)/(1 + x tan y), which is too small for more than a
 * cube. */
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
    const op_list *tape;
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
    const op *o = &l->tape->ops[i];
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
        long_sincos(phase_of(l->tape, o, in) + (o->b >= 0 ? B : 0.0L), &l->sine[i], &l->cosine[i]);
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
    case OP_CELL: return cell_of(l->tape, phase_of(l->tape, o, in));
    case OP_LINE:
    case OP_CUBIC: return (long double)l->tape->tables.number[(size_t)A + (size_t)o->value];
    }
    return 0.0L;
}

#undef A
#undef B

void long_list_run(long_list *l, const long_leaves *in, long double *result) {
    const op_list *t = l->tape;
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
    needed[t->result[result]] = true;
    for (int i = t->result[result]; i >= 0; i--) {
        int operand[2];
        const int operands = needed[i] ? op_list_operands(&t->ops[i], operand) : 0;
        found = found || (needed[i] && t->ops[i].code == code);
        for (int k = 0; k < operands; k++) {
            needed[operand[k]] = true;
        }
    }
    free(needed);
    return found;
}

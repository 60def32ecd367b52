/* functions.c: the language's functions in double. The core's double build computes sines, powers and roots. */
#include "host/number/functions.h"

#define WH_DOUBLE 1

#include <string.h>

#include "core/function_double.h"
#include "core/root.h"

double number_sine(double rad) { return wh_sine(rad); }
double number_cosine(double rad) { return wh_cosine(rad); }
double number_root(double x) { return x < 0.0 || wh_is_nan(x) ? WH_NAN : WH_SQRT(x); }
double number_power(double base, double exponent) { return wh_pow(base, exponent); }

typedef struct function_row {
    const char *name;
    const char *latex;
    int arguments;
    function_dimensions takes;
    bool is_real;
} function_row;

static const function_row rows[FUNCTIONS] = {
#define IS_REAL_EVERYWHERE true
#define IS_REAL_SOMEWHERE false
#define ROW(id, word, arguments, dimensions, range, latex, ...) \
    [FN_##id] = {#word, latex, arguments, TAKES_##dimensions, IS_REAL_##range},
    FUNCTION_ROWS(ROW)
#undef ROW
};

const char *function_name(function_id function) { return rows[function].name; }
const char *function_latex(function_id function) { return rows[function].latex; }
int function_arguments(function_id function) { return rows[function].arguments; }
function_dimensions function_takes(function_id function) { return rows[function].takes; }
bool function_is_real(function_id function) { return rows[function].is_real; }

bool function_find(const char *text, size_t length, function_id *function) {
    for (size_t i = 0; i < FUNCTIONS; i++) {
        if (strlen(rows[i].name) == length && memcmp(rows[i].name, text, length) == 0) {
            *function = (function_id)i;
            return true;
        }
    }
    return false;
}

#define FUNCTION_CORE(value) 1
#define FUNCTION_OWN(operation, value) 0
#define OF_CORE(id, word, arguments, dimensions, range, latex, value, ...) +value
#define ONE_MORE(name) +1
_Static_assert(1 FUNCTION_ROWS(OF_CORE) == 0 WH_FUNCTIONS(ONE_MORE, ONE_MORE),
               "core/function.h lists what the language calls, and the power");
#undef ONE_MORE
#undef OF_CORE
#undef FUNCTION_OWN
#undef FUNCTION_CORE

/* The sign of x; zeros and NaN are returned unchanged. */
static double sign_of(double x) { return x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : x; }
/* The slope of max(x, y) by x if `lead` is x - y. The slope of min(x, y) by x if `lead` is y - x. */
static double share_of(double lead) { return 0.5 + 0.5 * sign_of(lead); }

#define FUNCTION_CORE(value) value
#define FUNCTION_OWN(operation, value) value

double number_call(function_id function, double x, double y) {
    switch (function) {
#define ROW(id, word, arguments, dimensions, range, latex, value, ...) \
    case FN_##id: return value;
        FUNCTION_ROWS(ROW)
#undef ROW
    }
    return WH_NAN;
}

double number_slope(function_id function, int which, double x, double y) {
    switch (function) {
#define ROW(id, word, arguments, dimensions, range, latex, value, by_x, by_y) \
    case FN_##id: \
        if (which == 0) { \
            return by_x; \
        } \
        return by_y;
        FUNCTION_ROWS(ROW)
#undef ROW
    }
    return WH_NAN;
}

#define ALL_WHOLE 0x1p52 /* every double of at least this size is whole */

static double whole_part(double size) { return (double)(int64_t)size; }

/* Returns `size` with the sign of x, also if x is zero. */
static double like(double size, double x) { return wh_signed(size, wh_bits(x) >> 63 != 0); }

double number_floor(double x) {
    const double size = WH_ABS(x);
    if (!(size < ALL_WHOLE)) {
        return x;
    }
    const double whole = like(whole_part(size), x);
    return whole > x ? whole - 1.0 : whole;
}

double number_ceiling(double x) { return -number_floor(-x); }

/* Ties go to even if `even` is true, else away from zero. */
static double nearest(double x, bool even) {
    const double size = WH_ABS(x);
    if (!(size < ALL_WHOLE)) {
        return x;
    }
    const double whole = whole_part(size);
    const double rest = size - whole;
    const bool up = rest > 0.5 || (rest == 0.5 && !(even && (int64_t)whole % 2 == 0));
    return like(up ? whole + 1.0 : whole, x);
}

double number_nearest(double x) { return nearest(x, false); }
double number_even(double x) { return nearest(x, true); }

double number_scaled(double x, int exponent) {
    for (; exponent > 1023; exponent -= 1023) {
        x *= 0x1p1023;
    }
    for (; exponent < -1022; exponent += 969) {
        x *= 0x1p-969; /* a factor of 0x1p-1022 could round x twice */
    }
    return x * wh_power_of_two(exponent);
}

double number_split(double x, int *exponent) {
    const double size = WH_ABS(x);
    *exponent = 0;
    if (size == 0.0 || !(size < WH_INFINITY)) {
        return x;
    }
    const bool subnormal = size < 0x1p-1022;
    const uint64_t bits = wh_bits(subnormal ? x * 0x1p54 : x);
    *exponent = (int)(bits >> 52 & 2047U) - 1022 - (subnormal ? 54 : 0);
    return wh_of_bits((bits & ~(UINT64_C(2047) << 52)) | (UINT64_C(1022) << 52));
}

/* Splits a finite size >= 0: size = w * 2^e. Returns the whole number w, and sets *exponent to e >= -1074. */
static uint64_t whole_of(double size, int *exponent) {
    const uint64_t bits = wh_bits(size);
    const int field = (int)(bits >> 52);
    *exponent = field == 0 ? -1074 : field - 1075;
    return field == 0 ? bits : (bits & (UINT64_MAX >> 12)) | (UINT64_C(1) << 52);
}

double number_remainder(double x, double y) {
    const double size = WH_ABS(x);
    const double by = WH_ABS(y);
    int exponent;
    int by_exponent;
    uint64_t rest = whole_of(size, &exponent);
    const uint64_t divisor = whole_of(by, &by_exponent);
    if (!(size < WH_INFINITY) || wh_is_nan(y) || divisor == 0) {
        return WH_NAN;
    }
    if (size < by) {
        return x;
    }
    rest %= divisor;
    while (exponent > by_exponent) { /* `rest` has 53 bits, so a shift by 11 cannot overflow */
        const int bits = exponent - by_exponent < 11 ? exponent - by_exponent : 11;
        rest = (rest << bits) % divisor;
        exponent -= bits;
    }
    return like(number_scaled((double)(int64_t)rest, by_exponent), x);
}

double number_centred(double x, double y) {
    const double by = WH_ABS(y);
    if (!(WH_ABS(x) < WH_INFINITY) || !(by > 0.0)) {
        return WH_NAN;
    }
    /* the remainder of x / (2 * by), because a tie must go to the even multiple of `by` */
    double rest = WH_ABS(by < 0x1p1023 ? number_remainder(x, 2.0 * by) : x);
    const bool twice = by < 0x1p-1021; /* 0.5 * by could underflow */
    if (twice ? rest + rest > by : rest > 0.5 * by) {
        rest -= by;
        rest = (twice ? rest + rest >= by : rest >= 0.5 * by) ? rest - by : rest;
    }
    return like(rest, x);
}

double number_least(double a, double b) { return b < a || wh_is_nan(a) ? b : a; }
double number_most(double a, double b) { return b > a || wh_is_nan(a) ? b : a; }

/* function_double.h: arithmetic for the double build of function.h (core/function_*_double.c). A wh_pair is the number
 * high + low, with some hundred bits; low is at most half a unit in the last place of high. A function computes a pair
 * and returns its rounded sum, so its error is little more than half a unit in the last place. */
#ifndef WH_FUNCTION_DOUBLE_H
#define WH_FUNCTION_DOUBLE_H

#ifdef __cplusplus
#error "core/function_double.h is C only: C++ includes core/function.h"
#endif

#include "function.h"

typedef struct wh_pair {
    double high;
    double low;
} wh_pair;

/* The sum a + b without round-off: wh_pair_of() for |a| >= |b|, wh_pair_sum() for any two numbers (Dekker, Knuth). */
WH_INLINE wh_pair wh_pair_of(double a, double b) {
    const double sum = a + b;
    return (wh_pair){sum, b - (sum - a)};
}

WH_INLINE wh_pair wh_pair_sum(double a, double b) {
    const double sum = a + b;
    const double of_b = sum - a;
    return (wh_pair){sum, (a - (sum - of_b)) + (b - of_b)};
}

#if WH_DOUBLE

#define wh_sine WH_NAME(wh_sine)
#define wh_cosine WH_NAME(wh_cosine)
#define wh_log_pair WH_NAME(wh_log_pair)
#define wh_exp_pair WH_NAME(wh_exp_pair)
#define wh_exp_parts WH_NAME(wh_exp_parts)
#define wh_scaled_pair WH_NAME(wh_scaled_pair)

#define WH_NAN __builtin_nan("") /* one NaN, with the same bits everywhere */
#define WH_INFINITY __builtin_inf()

/* For any angle, the error is within one ulp. (wh_sincos() bounds the absolute error, in a limited range.) */
double wh_sine(double rad);
double wh_cosine(double rad);

/* The logarithm of a positive finite number, to at least 70 bits. */
wh_pair wh_log_pair(double x);
/* e^exponent for |exponent| < 1e4, rounded once; the result may be subnormal. */
double wh_exp_pair(wh_pair exponent);
/* Computes e^exponent as p 2^k. Returns p (0.99 to 2, right to 60 bits), and stores k in *power_of_two. */
wh_pair wh_exp_parts(wh_pair exponent, int *power_of_two);
/* Returns x 2^exponent, rounded once, for a pair x from 0.99 to 2. The result may be infinite or subnormal. */
double wh_scaled_pair(wh_pair x, int exponent);

WH_INLINE uint64_t wh_bits(double x) {
    const union {
        double number;
        uint64_t bits;
    } both = {x};
    return both.bits;
}

WH_INLINE double wh_of_bits(uint64_t bits) {
    const union {
        uint64_t bits;
        double number;
    } both = {bits};
    return both.number;
}

WH_INLINE bool wh_is_nan(double x) { return x != x; }

WH_INLINE double wh_signed(double size, bool negative) { return negative ? -size : size; }

WH_INLINE double wh_power_of_two(int exponent) {
    return wh_of_bits((uint64_t)(exponent + 1023) << 52);
}

/* x with only the upper 26 of its 53 bits. */
WH_INLINE double wh_upper(double x) { return wh_of_bits(wh_bits(x) & ~UINT64_C(0x7ffffff)); }

/* The product a b to 106 bits. */
WH_INLINE wh_pair wh_product(double a, double b) {
    const double product = a * b;
    const double a_high = wh_upper(a);
    const double b_high = wh_upper(b);
    const double a_low = a - a_high;
    const double b_low = b - b_high;
    return (wh_pair){product, ((a_high * b_high - product) + a_high * b_low + a_low * b_high) +
                                  a_low * b_low};
}

WH_INLINE wh_pair wh_quotient(wh_pair a, wh_pair b) {
    const double high = a.high / b.high;
    const wh_pair back = wh_product(high, b.high);
    const double rest = ((a.high - back.high) - back.low) + a.low - high * b.low;
    return wh_pair_of(high, rest / b.high);
}

WH_INLINE wh_pair wh_difference(wh_pair a, wh_pair b) {
    const wh_pair high = wh_pair_sum(a.high, -b.high);
    return wh_pair_of(high.high, high.low + (a.low - b.low));
}

#endif
#endif

/* function_hyperbolic_float.c: the hyperbolic functions in float. For |x| < 1, sinh x / x and cosh x are minimax
 * polynomials in x^2. Both are 1 at x = 0, so sinh x = x for small x. For |x| >= 1, e^x and e^-x are used. */
#include "function_float.h"

#if !WH_DOUBLE

#define EXP_BEYOND UINT32_C(0x42d00000)  /* 104: e^x is far beyond the largest float */
#define TANH_IS_ONE UINT32_C(0x41200000) /* 10 */

/* Returns sinh x for 0 < |x| < 1. The relative error is at most 5e-10. */
static wh_digits small_sinh(wh_digits x) {
    static const uint32_t series[] WH_FLASH = {12051U, 852043U, 35791420U, 715827882U}; /* Q32 */
    const uint32_t square = wh_square(x);
    return wh_longer(x,
                     wh_high(wh_series(series, sizeof series / sizeof series[0], square), square));
}

/* Returns cosh x for |x| < 1. The relative error is at most 5e-10. */
static wh_digits small_cosh(wh_digits x) {
    static const uint32_t series[] WH_FLASH = {1215U, 106488U, 5965246U, 178956969U,
                                               UINT32_C(2147483648)}; /* Q32 */
    const uint32_t square = wh_square(x);
    return wh_longer((wh_digits){WH_TOP_BIT, 0},
                     wh_high(wh_series(series, sizeof series / sizeof series[0], square), square));
}

/* Returns (e^x + e^-x)/2, or (e^x - e^-x)/2 if `minus`, for 1 <= x < 104. */
static float large(uint32_t sign, wh_digits x, bool minus) {
    const uint64_t octaves = wh_float_octaves(x);
    const wh_digits grown = wh_float_exp2(octaves);
    const wh_digits left = wh_float_exp2(0U - octaves);
    const int32_t shift = grown.exponent - left.exponent + 1;
    const uint32_t part = shift > 31 ? 0U : left.size >> shift;
    const uint32_t half = grown.size >> 1;
    return wh_float_round(sign, minus ? half - part : half + part, grown.exponent);
}

float wh_sinh(float x) {
    const uint32_t bits = wh_bits_of(x);
    const uint32_t magnitude = bits & ~WH_BITS_SIGN;
    const uint32_t sign = bits & WH_BITS_SIGN;
    if (magnitude > WH_BITS_INFINITE) {
        return wh_float_of_bits(WH_BITS_NAN);
    }
    if (magnitude == 0U) {
        return x;
    }
    if (magnitude >= EXP_BEYOND) {
        return wh_float_of_bits(sign | WH_BITS_INFINITE);
    }
    if (magnitude >= WH_BITS_ONE) {
        return large(sign, wh_digits_of(magnitude), true);
    }
    const wh_digits s = small_sinh(wh_digits_of(magnitude));
    return wh_float_round(sign, s.size, s.exponent);
}

float wh_cosh(float x) {
    const uint32_t magnitude = wh_bits_of(x) & ~WH_BITS_SIGN;
    if (magnitude > WH_BITS_INFINITE) {
        return wh_float_of_bits(WH_BITS_NAN);
    }
    if (magnitude == 0U) {
        return 1.0f;
    }
    if (magnitude >= EXP_BEYOND) {
        return wh_float_of_bits(WH_BITS_INFINITE);
    }
    if (magnitude >= WH_BITS_ONE) {
        return large(0U, wh_digits_of(magnitude), false);
    }
    const wh_digits c = small_cosh(wh_digits_of(magnitude));
    return wh_float_round(0U, c.size, c.exponent);
}

/* Returns 1 - tanh x in Q32, for 1 <= x < 10: 2 e^-2x / (1 + e^-2x). */
static uint32_t short_of_one(wh_digits x) {
    x.exponent++;
    const wh_digits left = wh_float_exp2(0U - wh_float_octaves(x)); /* e^-2x, below 1/7 */
    const wh_digits more = {WH_TOP_BIT + (left.size >> -left.exponent), 0};
    const wh_digits inverse = wh_float_inverse(more);
    return wh_high(left.size, inverse.size) >> (-3 - left.exponent - inverse.exponent);
}

float wh_tanh(float x) {
    const uint32_t bits = wh_bits_of(x);
    const uint32_t magnitude = bits & ~WH_BITS_SIGN;
    const uint32_t sign = bits & WH_BITS_SIGN;
    if (magnitude > WH_BITS_INFINITE) {
        return wh_float_of_bits(WH_BITS_NAN);
    }
    if (magnitude == 0U) {
        return x;
    }
    if (magnitude >= TANH_IS_ONE) {
        return wh_float_of_bits(sign | WH_BITS_ONE);
    }
    const wh_digits d = wh_digits_of(magnitude);
    if (magnitude >= WH_BITS_ONE) {
        return wh_float_round(sign, 0U - short_of_one(d), -1);
    }
    const wh_digits s = small_sinh(d);
    const wh_digits inverse = wh_float_inverse(small_cosh(d));
    const uint32_t zeros = wh_leading_zeros(s.size);
    return wh_float_round(sign, wh_high(s.size << zeros, inverse.size),
                          s.exponent - (int32_t)zeros + inverse.exponent + 1);
}

#endif

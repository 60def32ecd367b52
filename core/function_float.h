/* function_float.h: the integer arithmetic of the float functions (included by function_*_float.c only).
 *
 * A number is split into a sign, 32 binary digits and an exponent. The function is computed with about 30 of these
 * digits, and rounded to float once. That is cheaper than pairs of floats, even without floating-point hardware, and no
 * compiler option changes integer operations. "Q31" is a fixed-point format: a uint32_t in units of 2^-31. */
#ifndef WH_FUNCTION_FLOAT_H
#define WH_FUNCTION_FLOAT_H

#ifdef __cplusplus
#error "core/function_float.h is C only: C++ includes core/function.h"
#endif

#include "function.h"
#include "number/flash.h"

/* Bits of floats. If the sign bit is cleared, these integers have the same order as the floats' magnitudes. */
#define WH_BITS_SIGN UINT32_C(0x80000000)
#define WH_BITS_ONE UINT32_C(0x3f800000)
#define WH_BITS_INFINITE UINT32_C(0x7f800000)
#define WH_BITS_NAN UINT32_C(0x7fc00000)
#define WH_TOP_BIT UINT32_C(0x80000000)

typedef union wh_word {
    float value;
    uint32_t bits;
} wh_word;

/* The number size/2^31 * 2^exponent. The top bit of size is set. */
typedef struct wh_digits {
    uint32_t size;
    int32_t exponent;
} wh_digits;

WH_INLINE uint32_t wh_bits_of(float x) { return (wh_word){.value = x}.bits; }

WH_INLINE float wh_float_of_bits(uint32_t bits) { return (wh_word){.bits = bits}.value; }

/* Reads a number of a WH_FLASH table; on an AVR by the instructions of wh_flash_real(). */
WH_INLINE uint32_t wh_flash_word(const uint32_t *from) {
#if defined(__AVR__)
    return wh_bits_of(wh_flash_real((const float *)(const void *)from));
#else
    return *from;
#endif
}

WH_INLINE uint32_t wh_high(uint32_t a, uint32_t b) { return (uint32_t)(((uint64_t)a * b) >> 32); }

/* Leading zeros of x > 0. On the smallest machines an int has only 16 bits. */
WH_INLINE uint32_t wh_leading_zeros(uint32_t x) {
    return (uint32_t)(sizeof(int) >= 4 ? __builtin_clz((unsigned)x)
                                       : __builtin_clzl((unsigned long)x));
}

WH_INLINE uint32_t wh_leading_zeros_64(uint64_t x) { return (uint32_t)__builtin_clzll(x); }

/* Splits a magnitude (a float's bits without the sign) that is finite and not zero. It may be subnormal. */
WH_INLINE wh_digits wh_digits_of(uint32_t magnitude) {
    wh_digits d = {(magnitude << 8) | WH_TOP_BIT, (int32_t)(magnitude >> 23) - 127};
    if (magnitude < UINT32_C(0x00800000)) {
        const uint32_t zeros = wh_leading_zeros(magnitude);
        d = (wh_digits){magnitude << zeros, -118 - (int32_t)zeros};
    }
    return d;
}

/* x^2 in Q32, if x^2 is below one. */
WH_INLINE uint32_t wh_square(wh_digits x) {
    const int32_t shift = -2 * x.exponent - 2;
    return shift > 31 ? 0U : wh_high(x.size, x.size) >> shift;
}

/* The polynomial series[0] x^(count - 1) + ... + series[count - 1]. Coefficients, x and the result are in Q32. */
WH_INLINE uint32_t wh_series(const uint32_t *series, unsigned count, uint32_t x) {
    uint32_t sum = wh_flash_word(&series[0]);
    for (unsigned i = 1; i < count; i++) {
        sum = wh_flash_word(&series[i]) + wh_high(sum, x);
    }
    return sum;
}

/* x (1 + more/2^32). */
WH_INLINE wh_digits wh_longer(wh_digits x, uint32_t more) {
    x.size = (x.size >> 1) + (wh_high(x.size, more) >> 1);
    x.exponent++;
    return x;
}

#define wh_float_round WH_NAME(wh_float_round)
#define wh_float_ratio WH_NAME(wh_float_ratio)
#define wh_float_inverse WH_NAME(wh_float_inverse)
#define wh_float_octaves WH_NAME(wh_float_octaves)
#define wh_float_exp2 WH_NAME(wh_float_exp2)

/* The float nearest to size/2^31 * 2^exponent, for size > 0 and any exponent. Ties go to even. Results beyond the
 * largest float become infinite, very small results subnormal or zero. `sign` is WH_BITS_SIGN or 0. */
float wh_float_round(uint32_t sign, uint32_t size, int32_t exponent);

/* num/den, rounded down: in Q31 if num >= den, else in Q32. num and den have the top bit set and the 8 lowest clear. */
uint32_t wh_float_ratio(uint32_t num, uint32_t den);

/* 1/x for x > 0. The relative error is at most 1e-9. */
wh_digits wh_float_inverse(wh_digits x);

/* x log2(e) in Q32, rounded, for 2^-27 <= x < 2^9. The 8 lowest bits of x.size are ignored. */
uint64_t wh_float_octaves(wh_digits x);

/* 2^(power/2^32) for |power| < 2^42. A negative power is in two's complement. The relative error is at most 6e-10. */
wh_digits wh_float_exp2(uint64_t power);

#endif

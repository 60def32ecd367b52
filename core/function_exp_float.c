/* function_exp_float.c: exp, log and power in float, by 2^x and the logarithm to base 2. The logarithm has 55 binary
 * digits after the point, of which at least 39 are right. So the error of a power is little more than one rounding, and
 * a true power that is a float is returned exactly. Polynomials are minimax, with integer coefficients. */
#include "function_float.h"

#if !WH_DOUBLE

#define POINT 55 /* binary digits after the point of a logarithm */

/* Returns 2^fraction in Q31, for a fraction in Q32. The relative error is at most 1.2e-10; the result is monotonic. */
static uint32_t exp2_of(uint32_t fraction) {
    static const uint32_t slope[] WH_FLASH = {89165U,     627085U,     5751038U,   41300811U,
                                              238389830U, 1031764893U, 2977044473U};
    const uint32_t sum = wh_series(slope, sizeof slope / sizeof slope[0], fraction);
    return WH_TOP_BIT + (wh_high(sum, fraction) >> 1);
}

wh_digits wh_float_exp2(uint64_t power) {
    return (wh_digits){exp2_of((uint32_t)power), (int32_t)(uint32_t)(power >> 32)};
}

/* Returns 2^(size/2^32), or its inverse if below_one, with a sign. size/2^32 is below 2^10. */
static float exp2_signed(uint32_t sign, uint64_t size, bool below_one) {
    const wh_digits power = wh_float_exp2(below_one ? 0U - size : size);
    return wh_float_round(sign, power.size, power.exponent);
}

static uint64_t shifted(uint64_t size, int32_t shift) { return ((size >> (shift - 1)) + 1U) >> 1; }

/* Returns the logarithm to base 2, times 2^POINT, of a finite magnitude above zero.
 *
 * The result is exponent - log2(c) + log2(1 + z), with z = m c - 1 exactly. A table gives c, near 1/m, for each of 16
 * sectors of the mantissa m, so |z| <= 1/16. The polynomial log2(e) z - z^2 (...) approximates log2(1 + z). From 31/32
 * to 17/16, exponent - log2(c) is 0, so small logarithms keep their relative precision. */
static int64_t log2_of(uint32_t magnitude) {
    /* For each sector, c in Q7 in the upper 8 bits, and -log2(c) in Q55 in the other bits. */
    static const uint32_t inverses[] WH_FLASH = {
        UINT32_C(0x80000000), UINT32_C(0x00000000), UINT32_C(0x751097e3), UINT32_C(0x8ce60649),
        UINT32_C(0x6f1a5094), UINT32_C(0xb54d2828), UINT32_C(0x6924939a), UINT32_C(0x56279ad9),
        UINT32_C(0x642d961e), UINT32_C(0xd0cb91d4), UINT32_C(0x5f370ef8), UINT32_C(0xaf6360e0),
        UINT32_C(0x5b3f0095), UINT32_C(0xd1a19a03), UINT32_C(0x57474da0), UINT32_C(0xa5ad4953),
        UINT32_C(0x544dc88a), UINT32_C(0xedc1d1ef), UINT32_C(0x5056cb0f), UINT32_C(0x6865c8ea),
        UINT32_C(0x4d5dd9f0), UINT32_C(0x4a59e914), UINT32_C(0x4a6530a1), UINT32_C(0xd24b136c),
        UINT32_C(0x486a3fe5), UINT32_C(0xc6042978), UINT32_C(0x45721bde), UINT32_C(0xdfa92a23),
        UINT32_C(0x43778a63), UINT32_C(0xb02eb033), UINT32_C(0x40800000), UINT32_C(0x00000000)};
    /* Q31; the signs of the terms alternate. */
    static const uint32_t bend[] WH_FLASH = {422085684U, 517401452U,  619679893U,
                                             774539989U, 1032721315U, 1549082005U};
    const int64_t log2_e = INT64_C(99141248300); /* Q36 */

    const wh_digits x = wh_digits_of(magnitude);
    const uint32_t sector = (x.size >> 27) & 15U;
    const uint32_t high = wh_flash_word(&inverses[2U * sector]);
    const uint32_t low = wh_flash_word(&inverses[2U * sector + 1U]);
    const int64_t less = (int64_t)(((uint64_t)(high & UINT32_C(0xffffff)) << 32) | low);
    const int32_t rest = (int32_t)((x.size >> 8) * (high >> 24)) - (INT32_C(1) << 30); /* Q30 */
    const int32_t z = rest * 4;                                                        /* Q32 */
    int32_t sum = 0;
    for (unsigned i = 0; i < sizeof bend / sizeof bend[0]; i++) {
        sum = (int32_t)wh_flash_word(&bend[i]) - (int32_t)(((int64_t)sum * z) >> 32);
    }
    const int32_t bent = (int32_t)(((int64_t)sum * z) >> 28); /* Q35 */
    const int64_t straight = (log2_e * rest) >> 11;
    return (int64_t)x.exponent * (INT64_C(1) << POINT) + less + straight -
           (((int64_t)bent * z) >> 12);
}

uint64_t wh_float_octaves(wh_digits x) {
    const uint64_t log2_e = UINT64_C(793129986396); /* Q39 */
    return shifted(log2_e * (x.size >> 8), 30 - x.exponent);
}

float wh_exp(float x) {
    const uint32_t bits = wh_bits_of(x);
    const uint32_t magnitude = bits & ~WH_BITS_SIGN;
    if (magnitude > WH_BITS_INFINITE) {
        return wh_float_of_bits(WH_BITS_NAN);
    }
    if (magnitude >= UINT32_C(0x42d00000)) { /* 104 */
        return wh_float_of_bits(bits == magnitude ? WH_BITS_INFINITE : 0U);
    }
    if (magnitude < UINT32_C(0x32000000)) { /* 2^-27 */
        return 1.0f;
    }
    return exp2_signed(0U, wh_float_octaves(wh_digits_of(magnitude)), bits != magnitude);
}

float wh_log(float x) {
    const uint32_t ln_2 = UINT32_C(2977044472); /* Q32 */
    const uint32_t bits = wh_bits_of(x);
    if ((bits & ~WH_BITS_SIGN) == 0U) {
        return wh_float_of_bits(WH_BITS_SIGN | WH_BITS_INFINITE);
    }
    if (bits >= WH_BITS_INFINITE) { /* negative, infinite or NaN */
        return wh_float_of_bits(bits == WH_BITS_INFINITE ? bits : WH_BITS_NAN);
    }
    const int64_t log2 = log2_of(bits);
    if (log2 == 0) {
        return 0.0f;
    }
    const uint64_t size = log2 < 0 ? 0U - (uint64_t)log2 : (uint64_t)log2;
    const uint32_t zeros = wh_leading_zeros_64(size);
    const uint32_t digits = (uint32_t)((size << zeros) >> 32);
    return wh_float_round(log2 < 0 ? WH_BITS_SIGN : 0U, wh_high(digits, ln_2),
                          (int32_t)(63 - POINT) - (int32_t)zeros);
}

/* Returns 0 if the number is not whole, 1 if it is odd, 2 if it is even. Infinity is even. */
static uint32_t wholeness(uint32_t magnitude) {
    const uint32_t exponent = magnitude >> 23;
    if (exponent < 127U) {
        return 0U;
    }
    if (exponent > 150U) {
        return 2U;
    }
    const uint32_t digits = (magnitude & UINT32_C(0x7fffff)) | UINT32_C(0x800000);
    /* the top bit has the weight 1; the lower bits are the fraction */
    const uint32_t behind = digits << (exponent - 119U);
    return (behind & ~WH_TOP_BIT) != 0U ? 0U : (behind != 0U ? 1U : 2U);
}

float wh_pow(float base, float exponent) {
    const uint32_t base_bits = wh_bits_of(base);
    const uint32_t exponent_bits = wh_bits_of(exponent);
    const uint32_t x = base_bits & ~WH_BITS_SIGN;
    const uint32_t y = exponent_bits & ~WH_BITS_SIGN;
    if (y == 0U || base_bits == WH_BITS_ONE) {
        return 1.0f; /* even if x or y is NaN */
    }
    if (x > WH_BITS_INFINITE || y > WH_BITS_INFINITE) {
        return wh_float_of_bits(WH_BITS_NAN);
    }
    const bool below_zero = exponent_bits != y;
    uint32_t sign = 0U;
    if (base_bits != x) {
        const uint32_t whole = wholeness(y);
        if (whole == 0U && x != 0U && x != WH_BITS_INFINITE) {
            return wh_float_of_bits(WH_BITS_NAN);
        }
        sign = whole == 1U ? WH_BITS_SIGN : 0U;
    }
    const uint32_t least = sign;
    const uint32_t most = sign | WH_BITS_INFINITE;
    if (x == 0U || x == WH_BITS_INFINITE) {
        return wh_float_of_bits((x == 0U) == below_zero ? most : least);
    }
    const int64_t log2 = log2_of(x);
    if (log2 == 0) {
        return wh_float_of_bits(sign | WH_BITS_ONE);
    }
    const bool below_one = (log2 < 0) != below_zero;
    const uint64_t size = log2 < 0 ? 0U - (uint64_t)log2 : (uint64_t)log2;
    const uint32_t zeros = wh_leading_zeros_64(size);
    const wh_digits d = wh_digits_of(y);
    const uint64_t product = ((size << zeros) >> 24) * (d.size >> 8);
    /* A right shift by `shift` converts the product to |log2(result)| in Q32. */
    const int32_t shift = POINT - 33 + (int32_t)zeros - d.exponent;
    if (shift < 23) { /* the result's |log2| is at least 2^8 */
        return wh_float_of_bits(below_one ? least : most);
    }
    return shift > 63 ? wh_float_of_bits(sign | WH_BITS_ONE)
                      : exp2_signed(sign, shifted(product, shift), below_one);
}

#endif

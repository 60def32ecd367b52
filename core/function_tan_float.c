/* function_tan_float.c: the tangent in float, of an angle of any size. Quarter turns are subtracted in integers, with
 * as many digits of 2/pi as needed (M. Payne and R. Hanek, "Radian reduction for trigonometric functions", SIGNUM
 * Newsletter 18 (1983) 1). 60 binary digits after the point suffice, because no float is nearer to a multiple of a
 * quarter turn than 2^-30 quarter turns. */
#include "function_float.h"

#if !WH_DOUBLE

#define EIGHTH_TURN UINT32_C(0x3f490fda) /* the largest float below pi/4 */

/* 2/pi, in words of 32 binary digits; the first word is before the point. */
static const uint32_t two_over_pi[] WH_FLASH = {
    UINT32_C(0x00000000), UINT32_C(0xa2f9836e), UINT32_C(0x4e441529), UINT32_C(0xfc2757d1),
    UINT32_C(0xf534ddc0), UINT32_C(0xdb629599), UINT32_C(0x3c439041), UINT32_C(0xfe5163ab)};

/* Subtracts the nearest whole number of quarter turns from a magnitude. Returns the size of the remainder in radians.
 * *odd: the number of quarter turns is odd. *below: the remainder is negative. */
static wh_digits rest_of_quarters(uint32_t magnitude, bool *odd, bool *below) {
    /* The skipped bits of 2/pi contribute only whole half turns, which do not change the tangent. */
    const uint32_t skip = (magnitude >> 23) - (150U - 31U);
    const uint32_t *word = &two_over_pi[skip >> 5];
    const uint32_t shift = skip & 31U;
    uint32_t window[3];
    for (unsigned i = 0; i < 3; i++) {
        window[i] =
            (uint32_t)((((uint64_t)wh_flash_word(&word[i]) << 32) | wh_flash_word(&word[i + 1])) >>
                       (32U - shift));
    }
    const uint32_t digits = (magnitude & UINT32_C(0x7fffff)) | UINT32_C(0x800000);
    const uint64_t quarters =
        ((uint64_t)(digits * window[0]) << 32) + /* 63 digits after the point */
        (uint64_t)digits * window[1] + wh_high(digits, window[2]);
    const uint64_t rest = quarters << 1; /* Q64 */
    *below = rest >> 63 != 0U;
    *odd = (quarters >> 63 != 0U) != *below;
    const uint64_t size = *below ? 0U - rest : rest;
    const uint32_t zeros = wh_leading_zeros_64(size);
    const uint32_t half_pi = UINT32_C(3373259426); /* Q31 */
    const uint32_t rad = wh_high((uint32_t)((size << zeros) >> 32), half_pi);
    const int32_t exponent = -(int32_t)zeros;
    return rad < WH_TOP_BIT ? (wh_digits){rad << 1, exponent - 1} : (wh_digits){rad, exponent};
}

/* Returns the tangent of an angle up to an eighth of a turn. The relative error is at most 1.5e-9. */
static wh_digits tangent_of(wh_digits rad) {
    static const uint32_t series[] WH_FLASH = {18797842U,  380841U,    46542290U,  91405258U,
                                               232185762U, 572633515U, 1431656471U}; /* Q32 */
    const uint32_t square = wh_square(rad);
    const uint32_t sum = wh_series(series, sizeof series / sizeof series[0], square);
    return wh_longer(rad, wh_high(sum, square));
}

float wh_tan(float rad) {
    const uint32_t bits = wh_bits_of(rad);
    const uint32_t magnitude = bits & ~WH_BITS_SIGN;
    uint32_t sign = bits & WH_BITS_SIGN;
    if (magnitude >= WH_BITS_INFINITE) {
        return wh_float_of_bits(WH_BITS_NAN);
    }
    if (magnitude == 0U) {
        return rad;
    }
    if (magnitude <= EIGHTH_TURN) {
        const wh_digits t = tangent_of(wh_digits_of(magnitude));
        return wh_float_round(sign, t.size, t.exponent);
    }
    bool odd;
    bool below;
    wh_digits t = tangent_of(rest_of_quarters(magnitude, &odd, &below));
    sign ^= odd != below ? WH_BITS_SIGN : 0U;
    t = odd ? wh_float_inverse(t) : t;
    return wh_float_round(sign, t.size, t.exponent);
}

#endif

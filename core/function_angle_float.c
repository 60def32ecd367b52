/* function_angle_float.c: the inverse circular functions in float. The series of asin x and atan x are
 * x (1 + c x^2 + ...) with minimax coefficients. The 1 is fixed, so that a small x gives x. */
#include "function_float.h"

#if !WH_DOUBLE

/* Radians in Q30. */
#define QUARTER_TURN UINT32_C(1686629713)
#define HALF_TURN UINT32_C(3373259425)

/* Returns base + angle, or base - angle if `minus`. base is in radians, Q30. If base is 0, `minus` is ignored. */
static float angle_sum(uint32_t sign, uint32_t base, bool minus, wh_digits angle) {
    if (base == 0U) {
        return wh_float_round(sign, angle.size, angle.exponent);
    }
    const int32_t shift = 1 - angle.exponent;
    const uint32_t part = shift > 31 ? 0U : angle.size >> shift;
    return wh_float_round(sign, minus ? base - part : base + part, 1);
}

/* Returns the arc whose tangent is t, for 0 < t <= 1. The relative error is at most 5e-10. */
static wh_digits arc_of_tangent(wh_digits t) {
    static const uint32_t series[] WH_FLASH = {4758830U,   31312263U,  96570224U,  191677941U,
                                               289373305U, 378361278U, 474929245U, 613311670U,
                                               858979164U, 1431655485U}; /* Q32, signs alternate */
    if (t.exponent == 0) { /* t is one; its square would overflow */
        t = (wh_digits){UINT32_MAX, -1};
    }
    const uint32_t square = wh_square(t);
    uint32_t sum = wh_flash_word(&series[0]);
    for (unsigned i = 1; i < sizeof series / sizeof series[0]; i++) {
        sum = wh_flash_word(&series[i]) - wh_high(sum, square);
    }
    t.size -= wh_high(t.size, wh_high(sum, square));
    return t;
}

float wh_atan2(float y, float x) {
    const uint32_t y_bits = wh_bits_of(y);
    const uint32_t x_bits = wh_bits_of(x);
    const uint32_t high = y_bits & ~WH_BITS_SIGN;
    const uint32_t wide = x_bits & ~WH_BITS_SIGN;
    if (high > WH_BITS_INFINITE || wide > WH_BITS_INFINITE) {
        return wh_float_of_bits(WH_BITS_NAN);
    }
    const uint32_t sign = y_bits & WH_BITS_SIGN;
    const bool steep = high > wide;
    const bool behind = wide != x_bits;
    const uint32_t less = steep ? wide : high;
    const uint32_t more = steep ? high : wide;
    const uint32_t base = steep ? QUARTER_TURN : (behind ? HALF_TURN : 0U);
    wh_digits arc = {0U, -64};
    if (less == more && more != 0U) {
        arc = arc_of_tangent((wh_digits){WH_TOP_BIT, 0});
    } else if (less != 0U && more != WH_BITS_INFINITE) {
        const wh_digits num = wh_digits_of(less);
        const wh_digits den = wh_digits_of(more);
        const int32_t exponent = num.exponent - den.exponent - (num.size < den.size ? 1 : 0);
        arc = arc_of_tangent((wh_digits){wh_float_ratio(num.size, den.size), exponent});
    } else if (base == 0U) {
        return wh_float_of_bits(sign); /* the direction is that of the x axis */
    }
    return angle_sum(sign, base, steep != behind, arc);
}

float wh_atan(float x) { return wh_atan2(x, 1.0f); }

/* Returns the root of size * 2^32, for size >= 2^30, by Newton's method. The first guess is linear in size; only the
 * last step computes all digits. The relative error is at most 2^-30. */
static uint32_t root_of(uint32_t size) {
    const uint32_t line = wh_high(size, 43691U) + 23156U; /* (size/2^30 + 2.12)/3, times 2^15 */
    const uint32_t near = (line + size / line) >> 1;
    const uint32_t root = (near + size / near) >> 1;
    const uint32_t ratio = size / root;
    const uint32_t behind = ((size - ratio * root) << 16) / root;
    return ((root + ratio) << 15) + (behind >> 1);
}

/* x is the float with the bits `magnitude`, at most 1. Returns asin x if x <= 1/2, otherwise asin sqrt((1 - x)/2) =
 * (pi/2 - asin x)/2. The relative error is at most 5e-10. A zero result has size 0. */
static wh_digits arc_of_sine(uint32_t magnitude) {
    static const uint32_t series[] WH_FLASH = {161131133U, 62013972U,  136612917U,
                                               191198894U, 322144200U, 715827596U}; /* Q32 */
    wh_digits s = {0U, -64};
    if (magnitude <= UINT32_C(0x3f000000)) {
        if (magnitude != 0U) {
            s = wh_digits_of(magnitude);
        }
    } else if (magnitude != WH_BITS_ONE) {
        const uint32_t missing =
            UINT32_C(0x1000000) - ((magnitude & UINT32_C(0x7fffff)) | UINT32_C(0x800000));
        /* shift is odd, so that (shift - 1)/2 in the root's exponent is a whole number */
        const uint32_t shift = (wh_leading_zeros(missing) - 1U) | 1U;
        s = (wh_digits){root_of(missing << shift), 2 - (int32_t)((shift - 1U) / 2U)};
    }
    const uint32_t square = wh_square(s);
    const uint32_t sum = wh_series(series, sizeof series / sizeof series[0], square);
    return wh_longer(s, wh_high(sum, square));
}

float wh_asin(float x) {
    const uint32_t bits = wh_bits_of(x);
    const uint32_t magnitude = bits & ~WH_BITS_SIGN;
    if (magnitude > WH_BITS_ONE) {
        return wh_float_of_bits(WH_BITS_NAN);
    }
    if (magnitude == 0U) {
        return x;
    }
    wh_digits arc = arc_of_sine(magnitude);
    const bool steep = magnitude > UINT32_C(0x3f000000);
    arc.exponent += steep ? 1 : 0;
    return angle_sum(bits & WH_BITS_SIGN, steep ? QUARTER_TURN : 0U, true, arc);
}

float wh_acos(float x) {
    const uint32_t bits = wh_bits_of(x);
    const uint32_t magnitude = bits & ~WH_BITS_SIGN;
    if (magnitude > WH_BITS_ONE) {
        return wh_float_of_bits(WH_BITS_NAN);
    }
    if (bits == WH_BITS_ONE) {
        return 0.0f;
    }
    wh_digits arc = arc_of_sine(magnitude);
    const bool behind = bits != magnitude;
    if (magnitude <= UINT32_C(0x3f000000)) {
        return angle_sum(0U, QUARTER_TURN, !behind, arc);
    }
    arc.exponent += 1;
    return angle_sum(0U, behind ? HALF_TURN : 0U, true, arc);
}

#endif

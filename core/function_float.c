/* function_float.c: rounding and division for function_float.h. */
#include "function_float.h"

#if !WH_DOUBLE

float wh_float_round(uint32_t sign, uint32_t size, int32_t exponent) {
    const uint32_t zeros = wh_leading_zeros(size);
    size <<= zeros;
    exponent -= (int32_t)zeros;
    if (exponent > 127) {
        return wh_float_of_bits(sign | WH_BITS_INFINITE);
    }
    uint32_t drop = 8U; /* number of binary digits to round off */
    uint32_t start = 0U;
    if (exponent >= -126) {
        /* one less than the biased exponent, because the leading digit of `kept` adds one */
        start = (uint32_t)(exponent + 126) << 23;
    } else if (exponent > -151) {
        drop = (uint32_t)(-118 - exponent);
    } else {
        return wh_float_of_bits(sign);
    }
    const uint32_t kept = drop < 32U ? size >> drop : 0U;
    const uint32_t rest = size << (32U - drop);
    const uint32_t up = rest > WH_TOP_BIT || (rest == WH_TOP_BIT && (kept & 1U) != 0U) ? 1U : 0U;
    return wh_float_of_bits(sign | (start + kept + up)); /* a carry increments the exponent */
}

/* Long division, eight binary digits at a time, so that 32-bit divisions suffice. */
uint32_t wh_float_ratio(uint32_t num, uint32_t den) {
    const uint32_t by = den >> 8;
    uint32_t rest = num < den ? num : num >> 1;
    uint32_t ratio = 0U;
    for (int digit = 0; digit < 4; digit++) {
        const uint32_t part = rest / by;
        ratio = (ratio << 8) | part;
        rest = (rest - part * by) << 8;
    }
    return ratio;
}

/* wh_float_ratio() needs a 24-bit divisor. A first-order correction adds the effect of the lower 8 bits of x. */
wh_digits wh_float_inverse(wh_digits x) {
    const uint32_t zeros = wh_leading_zeros(x.size);
    const uint32_t size = x.size << zeros;
    const uint32_t first = size & ~UINT32_C(255);
    const bool power_of_two = first == WH_TOP_BIT;
    const uint32_t inverse = wh_float_ratio(WH_TOP_BIT, first); /* Q31 if power_of_two, else Q32 */
    const uint32_t others = (size - first) << (power_of_two ? 2 : 1);
    return (wh_digits){inverse - wh_high(inverse, wh_high(inverse, others)),
                       (int32_t)zeros - x.exponent - (power_of_two ? 0 : 1)};
}

#endif

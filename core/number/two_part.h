/* two_part.h: constants as sums of two reals. Part of step.h. One float is not enough: it stores 1 ms with a relative
 * error of 4.7e-8. This error is the same in every step, so compensated sums cannot remove it. */
#ifndef WH_TWO_PART_H
#define WH_TWO_PART_H

#include "turn.h"

/* The number high + low. low corrects the round-off of high. */
typedef struct wh_two_part {
    wh_real high;
    wh_real low;
} wh_two_part;

/* Writes a constant in generated code. Double needs no low part. */
#if WH_DOUBLE
#define WH_TWO_PART(high, low) ((wh_two_part){high, 0.0})
#else
#define WH_TWO_PART(high, low) ((wh_two_part){WH_R(high), WH_R(low)})
#endif

/* Returns the round-off of the product a b (Dekker's product, Veltkamp's split: Muller et al., Handbook of
 * Floating-Point Arithmetic, section 4.4). */
WH_INLINE wh_real wh_product_rest(wh_real a, wh_real b) {
    const wh_real split = WH_DOUBLE ? WH_R(134217729.0) : WH_R(4097.0);
    const wh_real product = a * b;
    const wh_real a_wide = split * a;
    const wh_real a_high = a_wide - (a_wide - a);
    const wh_real b_wide = split * b;
    const wh_real b_high = b_wide - (b_wide - b);
    const wh_real a_low = a - a_high;
    const wh_real b_low = b - b_high;
    return ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
}

WH_INLINE wh_two_part wh_two_part_over(wh_two_part a, wh_real parts) {
    wh_two_part part = {a.high / parts, WH_R(0.0)};
    const wh_real missing = (a.high - part.high * parts) - wh_product_rest(part.high, parts);
    part.low = (missing + a.low) / parts;
    return part;
}

WH_INLINE wh_two_part wh_two_part_times(wh_two_part a, wh_two_part b) {
    const wh_two_part product = {a.high * b.high, wh_product_rest(a.high, b.high) +
                                                      (a.high * b.low + a.low * b.high)};
    return product;
}

#endif

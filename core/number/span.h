/* span.h: constants as sums of two reals, for more precision than one has. With compensated sums in float, a step of a
 * millisecond as one real would be too long by 4.7e-8 of itself, in every step. Part of step.h. */
#ifndef WH_SPAN_H
#define WH_SPAN_H

#include "turn.h"

/* s + rest_s, rest_s below half a unit in the last place of s. A length of time, or a constant derived from one. */
typedef struct wh_span {
    wh_real s;
    wh_real rest_s;
} wh_span;

/* For generated code. Double needs no rest_s. */
#if WH_DOUBLE
#define WH_SPAN(s, rest_s) ((wh_span){s, 0.0})
#else
#define WH_SPAN(s, rest_s) ((wh_span){WH_R(s), WH_R(rest_s)})
#endif

/* The round-off of a b (Dekker's product, Veltkamp's split: Muller et al., Handbook of Floating-Point Arithmetic,
 * section 4.4). */
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

WH_INLINE wh_span wh_span_over(wh_span a, wh_real parts) {
    wh_span part = {a.s / parts, WH_R(0.0)};
    const wh_real missing = (a.s - part.s * parts) - wh_product_rest(part.s, parts);
    part.rest_s = (missing + a.rest_s) / parts;
    return part;
}

WH_INLINE wh_span wh_span_times(wh_span a, wh_span b) {
    const wh_span product = {a.s * b.s,
                             wh_product_rest(a.s, b.s) + (a.s * b.rest_s + a.rest_s * b.s)};
    return product;
}

#endif

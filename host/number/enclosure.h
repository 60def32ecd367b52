/* enclosure.h: interval arithmetic with outward rounding: two doubles that enclose a real number for certain (Moore,
 * Kearfott, Cloud, Introduction to Interval Analysis, 2009).
 *
 * The processor rounds to nearest, as usual. Each operation then moves the ends outwards by one or two ulp, with an
 * addition and a product (Rump, Zimmermann, Boldo, Melquiond, Computing predecessor and successor in rounding to
 * nearest, BIT 49, 2009). An exact zero stays exact.
 *
 * A failed enclosure is NaN at both ends, for example after an overflow, a division by an interval that contains zero,
 * or a root of a possibly negative number. NaN carries over, so one enclosure_is_finite() at the end is enough. */
#ifndef NUMBER_ENCLOSURE_H
#define NUMBER_ENCLOSURE_H

#include <stdbool.h>

#include "host/number/functions.h"

/* core/real.h checks the compiler's arithmetic. */
#include "core/real.h"

#if __DBL_MANT_DIG__ != 53 || __DBL_MIN_EXP__ != -1021
#error "Whirl needs IEEE 754 numbers of 64 bits."
#endif

typedef struct enclosure {
    double low;
    double high;
} enclosure;

/* A bound at or below the next lower double, and one at or above the next higher double. */
static inline double enclosure_below(double x) {
    return x - (0x1.0000000000001p-53 * (x < 0.0 ? -x : x) + 0x1p-1074);
}
static inline double enclosure_above(double x) {
    return x + (0x1.0000000000001p-53 * (x < 0.0 ? -x : x) + 0x1p-1074);
}

static inline enclosure enclosure_of(double value) { return (enclosure){value, value}; }
static inline bool enclosure_is_zero(enclosure a) { return a.low == 0.0 && a.high == 0.0; }
static inline bool enclosure_is_point(enclosure a) { return a.low == a.high; }
static inline bool enclosure_is_finite(enclosure a) {
    return a.low - a.low == 0.0 && a.high - a.high == 0.0;
}
static inline enclosure enclosure_neg(enclosure a) { return (enclosure){-a.high, -a.low}; }

static inline enclosure enclosure_add(enclosure a, enclosure b) {
    if (enclosure_is_zero(a)) {
        return b;
    }
    if (enclosure_is_zero(b)) {
        return a;
    }
    return (enclosure){enclosure_below(a.low + b.low), enclosure_above(a.high + b.high)};
}

static inline enclosure enclosure_sub(enclosure a, enclosure b) {
    return enclosure_add(a, enclosure_neg(b));
}

static inline enclosure enclosure_widened(enclosure a, double by) {
    return enclosure_add(a, (enclosure){-by, by});
}

static inline double enclosure_lesser(double a, double b) { return a < b ? a : b; }
static inline double enclosure_larger(double a, double b) { return a > b ? a : b; }

/* Encloses the exact values of four rounded products or quotients. If `zero`, the exact values are 0. */
static inline enclosure enclosure_of_four(double p, double q, double r, double s, bool zero) {
    const double bad = (p + q) + (r + s); /* not finite if one of the four is not */
    if (!(bad - bad == 0.0)) {
        return (enclosure){bad - bad, bad - bad};
    }
    if (zero) {
        return enclosure_of(0.0);
    }
    return (enclosure){
        enclosure_below(enclosure_lesser(enclosure_lesser(p, q), enclosure_lesser(r, s))),
        enclosure_above(enclosure_larger(enclosure_larger(p, q), enclosure_larger(r, s)))};
}

static inline enclosure enclosure_mul(enclosure a, enclosure b) {
    return enclosure_of_four(a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high,
                             enclosure_is_zero(a) || enclosure_is_zero(b));
}

static inline enclosure enclosure_times(enclosure a, double x) {
    const double p = a.low * x;
    const double q = a.high * x;
    const double bad = p + q;
    if (!(bad - bad == 0.0)) {
        return (enclosure){bad - bad, bad - bad};
    }
    if (enclosure_is_zero(a) || x == 0.0) {
        return enclosure_of(0.0);
    }
    return (enclosure){enclosure_below(x < 0.0 ? q : p), enclosure_above(x < 0.0 ? p : q)};
}

/* The smallest enclosure that contains both. */
static inline enclosure enclosure_hull(enclosure a, enclosure b) {
    if (!enclosure_is_finite(a) || !enclosure_is_finite(b)) {
        return enclosure_is_finite(a) ? b : a;
    }
    return (enclosure){enclosure_lesser(a.low, b.low), enclosure_larger(a.high, b.high)};
}

enclosure enclosure_div(enclosure a, enclosure b);
enclosure enclosure_square(enclosure a);
/* Encloses `value` and, on either side of it, the nearest (more + 1) doubles. */
enclosure enclosure_about(double value, int more);
/* A double near the middle, and an upper bound on the distance from that double to either end. */
double enclosure_middle(enclosure a);
double enclosure_radius(enclosure a);
/* The largest absolute value in `a`. */
double enclosure_size(enclosure a);
/* Returns true if `a` lies between the ends of `b` and touches neither end. */
bool enclosure_inside(enclosure a, enclosure b);
bool enclosure_has(enclosure a, double x);

enclosure enclosure_pi(void);
enclosure enclosure_root(enclosure a);
enclosure enclosure_sine(enclosure a);
enclosure enclosure_cosine(enclosure a);
enclosure enclosure_exp(enclosure a);
enclosure enclosure_log(enclosure a);
enclosure enclosure_whole_power(enclosure a, int n);
/* a^exponent. If the exponent is not a whole number, `a` must be above zero. */
enclosure enclosure_power(enclosure a, enclosure exponent);
/* Encloses the function's values at the points of `a` that are in its domain. `b` is the second argument, if any.
 * Results of exp are not finite if a.high > 700, and those of sinh and cosh if enclosure_size(a) > 700. */
enclosure enclosure_call(function_id function, enclosure a, enclosure b);

#endif

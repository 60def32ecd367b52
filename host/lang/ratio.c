/* ratio.c: simplest fractions, by continued fractions of an interval's ends. */
#include "ratio.h"

#include <math.h>

__extension__ typedef unsigned __int128 wide;

enum { MANTISSA = 53 };

/* A rational number; `in` may be 0: infinity. */
typedef struct end {
    wide of, in;
} end;

/* The fraction of least denominator strictly between two ends (Graham, Knuth & Patashnik, Concrete
 * Mathematics, section 4.5): as long as no whole number lies between them, both begin with the same. */
static ratio between(end low, end high) {
    wide p = 1; /* convergents: the last, and the one before */
    wide q = 0;
    wide p_before = 0;
    wide q_before = 1;
    for (;;) {
        const wide whole = low.of / low.in;
        const bool last = high.in == 0 || (whole + 1) * high.in < high.of;
        const wide term = last ? whole + 1 : whole;
        const wide p_next = term * p + p_before;
        const wide q_next = term * q + q_before;
        if (last) {
            return (ratio){(uint64_t)p_next, (uint64_t)q_next};
        }
        p_before = p;
        q_before = q;
        p = p_next;
        q = q_next;
        const end rest = {low.of - whole * low.in, low.in};
        low = (end){high.in, high.of - whole * high.in};
        high = (end){rest.in, rest.of};
    }
}

ratio ratio_of(double value) {
    if (!(value > 0.0)) {
        return (ratio){0, 1};
    }
    int exponent;
    const double mantissa = frexp(value, &exponent); /* below one: 53 bits behind the point */
    const wide digits = (wide)ldexp(mantissa, MANTISSA);
    const int scale = exponent - MANTISSA; /* value = digits * 2^scale, digits from 2^52 on */
    const wide off = 2;
    const wide up = scale > 0 ? (wide)1 << scale : 1;
    const wide down = scale < 0 ? (wide)1 << -scale : 1;
    return between((end){(digits - off) * up, down}, (end){(digits + off) * up, down});
}

bool ratio_count(ratio whole, ratio part, uint64_t *count) {
    const wide over = (wide)whole.numerator * part.denominator;
    const wide under = (wide)whole.denominator * part.numerator;
    const wide nearest = (2 * over + under - 1) / (2 * under);
    *count = (uint64_t)nearest;
    return nearest <= (wide)1 << 63;
}

double ratio_times(uint64_t count, ratio each) {
    wide of = (wide)count * each.numerator;
    int shift = 0;
    while (of != 0 && of >> 126 == 0) { /* a denominator has 60 bits at most: 66 are left */
        of <<= 1;
        shift++;
    }
    wide quotient = of / each.denominator;
    wide rest = of % each.denominator;
    while (quotient >> 63 != 0) { /* rounded once, so with a mark for what lies below */
        rest |= quotient & 1U;
        quotient >>= 1;
        shift--;
    }
    return ldexp((double)((uint64_t)quotient | (uint64_t)(rest != 0)), -shift);
}

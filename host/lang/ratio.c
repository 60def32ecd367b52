/* ratio.c: the fraction that a double stands for. */
#include "ratio.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/number/functions.h"

__extension__ typedef unsigned __int128 wide;

enum { MANTISSA = 53, DIGITS_MOST = 15 };

/* A rational number; `in` may be 0: infinity. */
typedef struct end {
    wide of, in;
} end;

/* The fraction of least denominator strictly between two ends (Graham, Knuth & Patashnik, Concrete
 * Mathematics, section 4.5): as long as no whole number lies between them, both begin with the same. */
static whole_ratio between(end low, end high) {
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
            return (whole_ratio){(uint64_t)p_next, (uint64_t)q_next};
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

/* The simplest fraction within 2^-51 of the value, or a little less. */
static whole_ratio simplest(double value) {
    int exponent;
    const double mantissa =
        number_split(value, &exponent); /* below one: 53 bits behind the point */
    const wide digits = (wide)number_scaled(mantissa, MANTISSA);
    const int scale = exponent - MANTISSA; /* value = digits * 2^scale, digits from 2^52 on */
    const wide off = 2;
    const wide up = scale > 0 ? (wide)1 << scale : 1;
    const wide down = scale < 0 ? (wide)1 << -scale : 1;
    return between((end){(digits - off) * up, down}, (end){(digits + off) * up, down});
}

static uint64_t common_divisor(uint64_t a, uint64_t b) {
    while (b != 0) {
        const uint64_t rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

/* The decimal of fewest digits as near, *said is 10 to the power of their number; false when it takes more than
 * 15 digits, or more than 60 bits as a fraction. */
static bool decimal(double value, whole_ratio *found, uint64_t *said) {
    char text[40];
    for (int digits = 1; digits <= DIGITS_MOST; digits++) {
        snprintf(text, sizeof text, "%.*e", digits - 1, value);
        if (!(fabs(strtod(text, NULL) - value) <= 0x1p-52 * value)) {
            continue;
        }
        int power = (int)strtol(strchr(text, 'e') + 1, NULL, 10) - (digits - 1);
        wide of = 0;
        for (const char *at = text; *at != 'e'; at++) {
            of = *at == '.' ? of : 10 * of + (unsigned)(*at - '0');
        }
        wide in = 1;
        *said = 1;
        for (int i = 0; i < digits; i++) {
            *said *= 10;
        }
        for (; power > 0 && of >> 63 == 0; power--) {
            of *= 10;
        }
        for (; power < 0 && in >> 63 == 0; power++) {
            in *= 10;
        }
        if (power != 0 || of >> 63 != 0 || in >> 63 != 0) {
            return false;
        }
        const uint64_t by = common_divisor((uint64_t)of, (uint64_t)in);
        *found = (whole_ratio){(uint64_t)of / by, (uint64_t)in / by};
        return found->numerator >> 60 == 0 && found->denominator >> 60 == 0;
    }
    return false;
}

whole_ratio ratio_of(double value) {
    if (!(value > 0.0)) {
        return (whole_ratio){0, 1};
    }
    whole_ratio plain;
    uint64_t said;
    const whole_ratio fraction = simplest(value);
    const bool shorter = decimal(value, &plain, &said) &&
                         said <= (wide)10 * fraction.numerator * fraction.denominator;
    return shorter ? plain : fraction;
}

bool ratio_count(whole_ratio whole, whole_ratio part, uint64_t *count) {
    const wide over = (wide)whole.numerator * part.denominator;
    const wide under = (wide)whole.denominator * part.numerator;
    const wide nearest = (2 * over + under - 1) / (2 * under);
    *count = (uint64_t)nearest;
    return nearest <= (wide)1 << 63;
}

double ratio_times(uint64_t count, whole_ratio each) {
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
    return number_scaled((double)((uint64_t)quotient | (uint64_t)(rest != 0)), -shift);
}

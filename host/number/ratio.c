#include "host/number/ratio.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/number/decimal.h"
#include "host/number/functions.h"

uint128 uint128_of(uint64_t value) { return (uint128){0, value}; }

uint128 uint128_plus(uint128 a, uint128 b) {
    const uint64_t low = a.low + b.low;
    return (uint128){a.high + b.high + (low < a.low ? 1U : 0U), low};
}

uint128 uint128_minus(uint128 a, uint128 b) {
    return (uint128){a.high - b.high - (a.low < b.low ? 1U : 0U), a.low - b.low};
}

/* The product of the low words is computed from their halves. */
uint128 uint128_times(uint128 a, uint128 b) {
    const uint64_t half = UINT32_MAX;
    const uint64_t low = (a.low & half) * (b.low & half);
    /* this sum and the next are below 2^64 */
    const uint64_t cross = (a.low >> 32) * (b.low & half) + (low >> 32);
    const uint64_t other = (a.low & half) * (b.low >> 32) + (cross & half);
    const uint64_t high = (a.low >> 32) * (b.low >> 32) + (cross >> 32) + (other >> 32);
    return (uint128){high + a.high * b.low + a.low * b.high, (other << 32) | (low & half)};
}

bool uint128_below(uint128 a, uint128 b) {
    return a.high != b.high ? a.high < b.high : a.low < b.low;
}

bool uint128_is_zero(uint128 a) { return a.high == 0 && a.low == 0; }

uint128 uint128_left(uint128 a, int bits) {
    if (bits == 0) {
        return a;
    }
    return bits < 64 ? (uint128){a.high << bits | a.low >> (64 - bits), a.low << bits}
                     : (uint128){a.low << (bits - 64), 0};
}

uint128 uint128_right(uint128 a, int bits) {
    if (bits == 0) {
        return a;
    }
    return bits < 64 ? (uint128){a.high >> bits, a.low >> bits | a.high << (64 - bits)}
                     : (uint128){0, a.high >> (bits - 64)};
}

/* Long division, bit by bit. */
uint128 uint128_over(uint128 a, uint128 b, uint128 *rest) {
    uint128 left = {0, 0};
    uint128 quotient = {0, 0};
    for (int bit = 127; bit >= 0; bit--) {
        const bool carried = left.high >> 63 != 0;
        left = uint128_plus(uint128_left(left, 1), uint128_of(uint128_right(a, bit).low & 1U));
        if (carried || !uint128_below(left, b)) {
            left = uint128_minus(left, b);
            quotient = uint128_plus(quotient, uint128_left(uint128_of(1), bit));
        }
    }
    if (rest != NULL) {
        *rest = left;
    }
    return quotient;
}

/* === ratios =================================================================================== */

enum { MANTISSA = 53, DIGITS_MOST = 15 };
#define TENTH (UINT64_MAX / 10) /* ten times a number below this fits into 64 bits */

/* The rational number `of` / `in`; infinity if `in` is 0. */
typedef struct end {
    uint128 of, in;
} end;

/* The fraction of least denominator strictly between two ends, by continued fractions (Graham, Knuth & Patashnik,
 * Concrete Mathematics, section 4.5). */
static whole_ratio between(end low, end high) {
    /* p / q: the last convergent; p_before / q_before: the one before it */
    uint128 p = uint128_of(1);
    uint128 q = uint128_of(0);
    uint128 p_before = uint128_of(0);
    uint128 q_before = uint128_of(1);
    for (;;) {
        uint128 low_rest;
        const uint128 whole = uint128_over(low.of, low.in, &low_rest);
        const uint128 above = uint128_plus(whole, uint128_of(1));
        const bool last =
            uint128_is_zero(high.in) || uint128_below(uint128_times(above, high.in), high.of);
        const uint128 term = last ? above : whole;
        const uint128 p_next = uint128_plus(uint128_times(term, p), p_before);
        const uint128 q_next = uint128_plus(uint128_times(term, q), q_before);
        if (last) {
            return (whole_ratio){p_next.low, q_next.low};
        }
        p_before = p;
        q_before = q;
        p = p_next;
        q = q_next;
        const uint128 low_in = low.in;
        low = (end){high.in, uint128_minus(high.of, uint128_times(whole, high.in))};
        high = (end){low_in, low_rest};
    }
}

/* Returns the simplest fraction that differs from `value` by less than two units in the last of its 53 bits. */
static whole_ratio simplest(double value) {
    int exponent;
    const double mantissa = number_split(value, &exponent);
    const uint64_t digits = (uint64_t)number_scaled(mantissa, MANTISSA);
    const int scale = exponent - MANTISSA; /* value = digits * 2^scale */
    const uint64_t off = 2;
    const int up = scale > 0 ? scale : 0;
    const uint128 down = uint128_left(uint128_of(1), scale < 0 ? -scale : 0);
    return between((end){uint128_left(uint128_of(digits - off), up), down},
                   (end){uint128_left(uint128_of(digits + off), up), down});
}

uint64_t ratio_divisor(uint64_t a, uint64_t b) {
    while (b != 0) {
        const uint64_t rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

/* Finds the shortest decimal within a relative error of 2^-52. *said: 10^n for a decimal of n digits. */
static bool decimal(double value, whole_ratio *found, uint64_t *said) {
    char text[40];
    for (int digits = 1; digits <= DIGITS_MOST; digits++) {
        snprintf(text, sizeof text, "%.*e", digits - 1, value);
        if (!(fabs(decimal_read(text, NULL) - value) <= 0x1p-52 * value)) {
            continue;
        }
        int power = (int)strtol(strchr(text, 'e') + 1, NULL, 10) - (digits - 1);
        uint64_t of = 0;
        for (const char *at = text; *at != 'e'; at++) {
            of = *at == '.' ? of : 10 * of + (unsigned)(*at - '0'); /* at most 15 digits */
        }
        uint64_t in = 1;
        *said = 1;
        for (int i = 0; i < digits; i++) {
            *said *= 10;
        }
        for (; power > 0 && of < TENTH; power--) {
            of *= 10;
        }
        for (; power < 0 && in < TENTH; power++) {
            in *= 10;
        }
        if (power != 0 || of >> 63 != 0 || in >> 63 != 0) {
            return false;
        }
        const uint64_t by = ratio_divisor(of, in);
        *found = (whole_ratio){of / by, in / by};
        return found->numerator >> 60 == 0 && found->denominator >> 60 == 0;
    }
    return false;
}

whole_ratio ratio_of(double value) {
    if (!(value > 0.0)) {
        return (whole_ratio){0, 1};
    }
    value = number_least(number_most(value, RATIO_LEAST), RATIO_MOST);
    whole_ratio plain;
    uint64_t said;
    const whole_ratio fraction = simplest(value);
    const bool shorter =
        decimal(value, &plain, &said) &&
        !uint128_below(uint128_times(uint128_times(uint128_of(10), uint128_of(fraction.numerator)),
                                     uint128_of(fraction.denominator)),
                       uint128_of(said));
    return shorter ? plain : fraction;
}

bool ratio_count(whole_ratio whole, whole_ratio part, uint64_t *count) {
    const uint128 over = uint128_times(uint128_of(whole.numerator), uint128_of(part.denominator));
    const uint128 under = uint128_times(uint128_of(whole.denominator), uint128_of(part.numerator));
    const uint128 twice = uint128_minus(uint128_plus(uint128_left(over, 1), under), uint128_of(1));
    const uint128 nearest = uint128_over(twice, uint128_left(under, 1), NULL);
    *count = nearest.low;
    return !uint128_below(uint128_left(uint128_of(1), 63), nearest);
}

/* As ratio_count(), for a time in seconds that was read or computed in double. */
static bool nearest_count(double time_s, whole_ratio step, uint64_t *count) {
    if (time_s < RATIO_LEAST) {
        *count = 0;
        return true;
    }
    return time_s <= RATIO_MOST && ratio_count(ratio_of(time_s), step, count);
}

bool ratio_count_each(double each_s, whole_ratio step, uint64_t *count) {
    return nearest_count(each_s, step, count) && *count > 0 &&
           fabs(ratio_times(*count, step) - each_s) <= 1e-6 * each_s;
}

bool ratio_count_from(double from_s, whole_ratio step, uint64_t *count) {
    if (!nearest_count(from_s, step, count)) {
        return false;
    }
    *count += ratio_times(*count, step) < from_s * (1.0 - 1e-12) ? 1 : 0;
    return true;
}

double ratio_times(uint64_t count, whole_ratio each) {
    uint128 of = uint128_times(uint128_of(count), uint128_of(each.numerator));
    int shift = 0;
    while (
        !uint128_is_zero(of) &&
        /* The loop ends when `of` has 127 bits. The quotient has at least 67 bits, more than the 53 of a double. */
        of.high >> 62 == 0) {
        of = uint128_left(of, 1);
        shift++;
    }
    uint128 rest;
    uint128 quotient = uint128_over(of, uint128_of(each.denominator), &rest);
    /* sticky bit: without it, the conversion to double would treat a value just above a tie as the tie */
    bool below = !uint128_is_zero(rest);
    while (quotient.high != 0 || quotient.low >> 63 != 0) {
        below = below || (quotient.low & 1U) != 0;
        quotient = uint128_right(quotient, 1);
        shift--;
    }
    return number_scaled((double)(quotient.low | (below ? 1U : 0U)), -shift);
}

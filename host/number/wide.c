/* wide.c: see wide.h. */
#include "wide.h"

#include <stddef.h>

wide wide_of(uint64_t value) { return (wide){0, value}; }

wide wide_plus(wide a, wide b) {
    const uint64_t low = a.low + b.low;
    return (wide){a.high + b.high + (low < a.low ? 1U : 0U), low};
}

wide wide_minus(wide a, wide b) {
    return (wide){a.high - b.high - (a.low < b.low ? 1U : 0U), a.low - b.low};
}

/* The whole product of two words, from their halves. */
static wide product(uint64_t a, uint64_t b) {
    const uint64_t half = UINT32_MAX;
    const uint64_t low = (a & half) * (b & half);
    const uint64_t cross = (a >> 32) * (b & half) + (low >> 32); /* fits: (2^32 - 1)^2 + 2^32 */
    const uint64_t other = (a & half) * (b >> 32) + (cross & half);
    return (wide){(a >> 32) * (b >> 32) + (cross >> 32) + (other >> 32),
                  (other << 32) | (low & half)};
}

wide wide_times(wide a, wide b) {
    wide made = product(a.low, b.low);
    made.high += a.high * b.low + a.low * b.high;
    return made;
}

bool wide_below(wide a, wide b) { return a.high != b.high ? a.high < b.high : a.low < b.low; }

bool wide_is_zero(wide a) { return a.high == 0 && a.low == 0; }

wide wide_left(wide a, int bits) {
    if (bits == 0) {
        return a;
    }
    return bits < 64 ? (wide){a.high << bits | a.low >> (64 - bits), a.low << bits}
                     : (wide){a.low << (bits - 64), 0};
}

wide wide_right(wide a, int bits) {
    if (bits == 0) {
        return a;
    }
    return bits < 64 ? (wide){a.high >> bits, a.low >> bits | a.high << (64 - bits)}
                     : (wide){0, a.high >> (bits - 64)};
}

/* Bit by bit, as on paper. */
wide wide_over(wide a, wide b, wide *rest) {
    wide left = {0, 0};
    wide quotient = {0, 0};
    for (int bit = 127; bit >= 0; bit--) {
        const bool carried = left.high >> 63 != 0; /* then `left` is 2^128 and more, so above b */
        left = wide_plus(wide_left(left, 1), wide_of(wide_right(a, bit).low & 1U));
        if (carried || !wide_below(left, b)) {
            left = wide_minus(left, b);
            quotient = wide_plus(quotient, wide_left(wide_of(1), bit));
        }
    }
    if (rest != NULL) {
        *rest = left;
    }
    return quotient;
}

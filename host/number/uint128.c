#include "uint128.h"

#include <stddef.h>

uint128 uint128_of(uint64_t value) { return (uint128){0, value}; }

uint128 uint128_plus(uint128 a, uint128 b) {
    const uint64_t low = a.low + b.low;
    return (uint128){a.high + b.high + (low < a.low ? 1U : 0U), low};
}

uint128 uint128_minus(uint128 a, uint128 b) {
    return (uint128){a.high - b.high - (a.low < b.low ? 1U : 0U), a.low - b.low};
}

/* The whole product of two words, from their halves. */
static uint128 product(uint64_t a, uint64_t b) {
    const uint64_t half = UINT32_MAX;
    const uint64_t low = (a & half) * (b & half);
    const uint64_t cross = (a >> 32) * (b & half) + (low >> 32); /* fits: (2^32 - 1)^2 + 2^32 */
    const uint64_t other = (a & half) * (b >> 32) + (cross & half);
    return (uint128){(a >> 32) * (b >> 32) + (cross >> 32) + (other >> 32),
                     (other << 32) | (low & half)};
}

uint128 uint128_times(uint128 a, uint128 b) {
    uint128 made = product(a.low, b.low);
    made.high += a.high * b.low + a.low * b.high;
    return made;
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

/* Bit by bit, as on paper. */
uint128 uint128_over(uint128 a, uint128 b, uint128 *rest) {
    uint128 left = {0, 0};
    uint128 quotient = {0, 0};
    for (int bit = 127; bit >= 0; bit--) {
        const bool carried = left.high >> 63 != 0; /* then `left` is 2^128 and more, so above b */
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

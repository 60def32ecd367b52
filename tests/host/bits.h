/* bits.h: converts between a double and its bits. */
#ifndef TESTS_HOST_BITS_H
#define TESTS_HOST_BITS_H

#include "test.h"

static inline double of_bits(uint64_t bits) {
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static inline uint64_t bits_of(double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

#endif

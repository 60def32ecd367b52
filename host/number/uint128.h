/* uint128.h: unsigned integers of 128 bits, for compilers without them (all for 32 bits). */
#ifndef NUMBER_UINT128_H
#define NUMBER_UINT128_H

#include <stdbool.h>
#include <stdint.h>

/* high * 2^64 + low */
typedef struct uint128 {
    uint64_t high;
    uint64_t low;
} uint128;

uint128 uint128_of(uint64_t value);
/* All modulo 2^128. */
uint128 uint128_plus(uint128 a, uint128 b);
uint128 uint128_minus(uint128 a, uint128 b);
uint128 uint128_times(uint128 a, uint128 b);
/* The quotient of a / b, and the remainder in *rest (may be NULL); b is not 0. */
uint128 uint128_over(uint128 a, uint128 b, uint128 *rest);
bool uint128_below(uint128 a, uint128 b); /* a < b */
bool uint128_is_zero(uint128 a);
/* By 0 ... 127 bits. */
uint128 uint128_left(uint128 a, int bits);
uint128 uint128_right(uint128 a, int bits);

#endif

/* ratio.h: steps and ends of runs as fractions of whole numbers, so that counts and times are exact. All
 * conversions of times to steps are here. */
#ifndef NUMBER_RATIO_H
#define NUMBER_RATIO_H

#include <stdbool.h>
#include <stdint.h>

/* === unsigned integers of 128 bits, for compilers without them (all for 32 bits) ============== */

/* high * 2^64 + low */
typedef struct uint128 {
    uint64_t high;
    uint64_t low;
} uint128;

uint128 uint128_of(uint64_t value);
/* Sum, difference and product modulo 2^128. */
uint128 uint128_plus(uint128 a, uint128 b);
uint128 uint128_minus(uint128 a, uint128 b);
uint128 uint128_times(uint128 a, uint128 b);
/* The quotient of a / b, and the remainder in *rest (may be NULL); b is not 0. */
uint128 uint128_over(uint128 a, uint128 b, uint128 *rest);
bool uint128_below(uint128 a, uint128 b); /* a < b */
bool uint128_is_zero(uint128 a);
uint128 uint128_left(uint128 a, int bits);
uint128 uint128_right(uint128 a, int bits);

/* Limits of a positive duration, s. */
#define RATIO_LEAST 1e-18
#define RATIO_MOST 1e18

/* numerator / denominator, in lowest terms, both below 2^60. */
typedef struct whole_ratio {
    uint64_t numerator;
    uint64_t denominator; /* > 0 */
} whole_ratio;

/* The fraction that `value` was before the round-off of units and doubles. The candidates are the decimal with the
 * fewest digits (at most 15) and the simplest fraction, both within a relative error of 2^-51. The shorter one is
 * taken. So 0.0011000000000000001 is 11/10000, and 1/44100 is exact. A decimal with more than 60 bits in numerator or
 * denominator (9.99999999999999e-7) becomes the simplest fraction, too. The result is 0 for values not above zero, and
 * clamped to RATIO_LEAST and RATIO_MOST. */
whole_ratio ratio_of(double value);

/* The whole number nearest to whole / part; of two equally near ones, the lower. Returns false if it exceeds 2^63.
 * `part` is above zero. */
bool ratio_count(whole_ratio whole, whole_ratio part, uint64_t *count);

/* Number of steps in a spacing of `each_s` seconds. Returns false if it is not within 1e-6 of a whole number of at
 * least 1. */
bool ratio_count_each(double each_s, whole_ratio step, uint64_t *count);

/* The first step's end at or after from_s >= 0, allowing for round-off; 0 is the start. Returns false if that is more
 * than 2^63. */
bool ratio_count_from(double from_s, whole_ratio step, uint64_t *count);

/* The largest number that divides both; 0 for two zeros. */
uint64_t ratio_divisor(uint64_t a, uint64_t b);

/* count * each, to the nearest double. */
double ratio_times(uint64_t count, whole_ratio each);

#endif

/* ratio.h: steps and end times as fractions, so that numbers of steps are exact. */
#ifndef NUMBER_RATIO_H
#define NUMBER_RATIO_H

#include <stdbool.h>
#include <stdint.h>

/* === unsigned integers of 128 bits, which compilers for 32-bit hosts lack ===================== */

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
/* Returns a / b, rounded down. *rest (may be NULL) is the remainder. `b` must not be 0. */
uint128 uint128_over(uint128 a, uint128 b, uint128 *rest);
bool uint128_below(uint128 a, uint128 b); /* a < b */
bool uint128_is_zero(uint128 a);
uint128 uint128_left(uint128 a, int bits);
uint128 uint128_right(uint128 a, int bits);

/* Limits of a duration, in seconds. */
#define RATIO_LEAST 1e-18
#define RATIO_MOST 1e18

/* A fraction in lowest terms. Both numbers are below 2^60. */
typedef struct whole_ratio {
    uint64_t numerator;
    uint64_t denominator; /* > 0 */
} whole_ratio;

/* Returns the fraction that `value` probably was before a conversion of units and a rounding to double: 11/10000 for
 * 0.0011000000000000001, and 1/44100 for the double nearest to 1/44100. The fraction's relative error is below 2^-51.
 * If `value` <= 0, returns 0. Limits positive values to the range from RATIO_LEAST to RATIO_MOST. */
whole_ratio ratio_of(double value);

/* Sets *count to whole / part, rounded to the nearest, ties down. Returns false above 2^63. `part` must not be 0. */
bool ratio_count(whole_ratio whole, whole_ratio part, uint64_t *count);

/* *count: the number of steps in `each_s`. Returns false if it is 0, or not whole within a relative error of 1e-6. */
bool ratio_count_each(double each_s, whole_ratio step, uint64_t *count);

/* *count: the number of the first step that ends at or after from_s >= 0, up to round-off. Returns false above 2^63. */
bool ratio_count_from(double from_s, whole_ratio step, uint64_t *count);

/* The greatest common divisor; 0 for two zeros. */
uint64_t ratio_divisor(uint64_t a, uint64_t b);

/* count * each, rounded to the nearest double. */
double ratio_times(uint64_t count, whole_ratio each);

#endif

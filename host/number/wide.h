/* wide.h: whole numbers of 128 bits, without sign, for hosts whose compilers have none (all of 32 bits). */
#ifndef NUMBER_WIDE_H
#define NUMBER_WIDE_H

#include <stdbool.h>
#include <stdint.h>

/* high * 2^64 + low */
typedef struct wide {
    uint64_t high;
    uint64_t low;
} wide;

wide wide_of(uint64_t value);
/* All modulo 2^128. */
wide wide_plus(wide a, wide b);
wide wide_minus(wide a, wide b);
wide wide_times(wide a, wide b);
/* The whole part of a / b, and what is left in *rest (may be NULL); b is not 0. */
wide wide_over(wide a, wide b, wide *rest);
bool wide_below(wide a, wide b); /* a < b */
bool wide_is_zero(wide a);
/* By 0 ... 127 bits. */
wide wide_left(wide a, int bits);
wide wide_right(wide a, int bits);

#endif

/* draw.h: random draws for the tests of contacts, in the build's numbers: the same on every machine. */
#ifndef TESTS_DRAW_H
#define TESTS_DRAW_H

#include <stdbool.h>
#include <stdint.h>

#include "core/real.h"

/* Returns the upper 31 bits of the next number of a linear congruential generator. */
static inline uint64_t draw_bits(uint64_t *seed) {
    *seed = *seed * 6364136223846793005U + 1442695040888963407U;
    return *seed >> 33;
}

/* Draws a whole number, both bounds included. */
static inline wh_real draw_whole(uint64_t *seed, int least, int most) {
    return (wh_real)(least + (int)(draw_bits(seed) % (uint64_t)(most - least + 1)));
}

/* Draws a number that is not whole. Two such numbers are never equal by chance. */
static inline wh_real draw_broken(uint64_t *seed, int least, int most) {
    return draw_whole(seed, least * 1024, most * 1024 - 1) / 1024 +
           draw_whole(seed, 1, 1023) / WH_R(1048576.0);
}

/* Draws one of 10001 evenly spaced numbers, both bounds included. */
static inline wh_real draw_between(uint64_t *seed, wh_real least, wh_real most) {
    return least + (most - least) * draw_whole(seed, 0, 10000) / WH_R(10000.0);
}

/* Draws an index below `count`; zero if `count` is zero. */
static inline unsigned draw_one_of(uint64_t *seed, unsigned count) {
    return count > 0 ? (unsigned)(draw_bits(seed) % count) : 0U;
}

/* A PC takes all cases. An emulated board takes an eighth of them, because all would take minutes. */
enum { DRAW_PART = __STDC_HOSTED__ ? 1 : 8 };
static inline unsigned draw_cases(unsigned all) { return all / DRAW_PART; }

static inline bool draw_one_in(uint64_t *seed, unsigned of) { return draw_bits(seed) % of == 0; }

#endif

/* scattered.h: the tests' scattered 64-bit numbers (xorshift; Marsaglia, Journal of Statistical Software 8 (2003) 14).
 * Each file that includes this has its own sequence, and sets scattered_state, not 0, before it calls scattered(). */
#ifndef TESTS_SCATTERED_H
#define TESTS_SCATTERED_H

#include <stdint.h>

static uint64_t scattered_state;

static inline uint64_t scattered(void) {
    scattered_state ^= scattered_state << 13;
    scattered_state ^= scattered_state >> 7;
    scattered_state ^= scattered_state << 17;
    return scattered_state;
}

#endif

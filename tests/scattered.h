/* scattered.h: random 64-bit numbers for tests (xorshift; Marsaglia, Journal of Statistical Software 8 (2003) 14).
 * Each file that includes this header has a sequence of its own. The file must set scattered_state to a number that
 * is not 0 before it calls scattered(). */
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

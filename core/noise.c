/* noise.c: splitmix64, the sum of twelve uniform numbers, and Teichroew's polynomial. */
#include "noise.h"

#define WORDS 3U      /* each word gives four uniform numbers */
#define MEAN 0x5fffaU /* 12 * 65535 / 2 */

/* Coefficients of p, in units of 2^-40. The deviate is z p(z^2), with z = (sum - MEAN)/2^16. Teichroew's argument is
 * z/4, so the coefficients are his a_1, a_3, ... a_9, divided by 4, 4^3, ... 4^9. */
static const uint64_t polynomial[] = {UINT64_C(1085725439164), UINT64_C(4336349890),
                                      UINT64_C(82187326), UINT64_C(560760), UINT64_C(125409)};
enum { TERMS = sizeof polynomial / sizeof polynomial[0] };

static uint64_t mix(uint64_t z) {
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return z ^ (z >> 31);
}

int32_t wh_noise_raw(uint32_t seed, uint64_t index) {
    const uint64_t step = UINT64_C(0x9e3779b97f4a7c15);
    uint64_t at = mix(seed) + WORDS * index * step;
    uint32_t sum = 0;
    for (unsigned k = 0; k < WORDS; k++) {
        at += step;
        const uint64_t word = mix(at);
        const uint32_t low = (uint32_t)word;
        const uint32_t high = (uint32_t)(word >> 32);
        sum += (low & 0xffffU) + (low >> 16) + (high & 0xffffU) + (high >> 16);
    }
    const bool below = sum < MEAN;
    const uint64_t size = below ? MEAN - sum : sum - MEAN; /* at most 6 * 2^16 */
    const uint64_t square = (size * size) >> 16;
    /* `slope` stays below 2^41, and its product with the square below 2^63 */
    uint64_t slope = polynomial[TERMS - 1];
    for (unsigned k = TERMS - 1; k > 0; k--) {
        slope = polynomial[k - 1] + ((slope * square) >> 16);
    }
    const int32_t deviate = (int32_t)((size * slope + (UINT64_C(1) << 39)) >> 40);
    return below ? -deviate : deviate;
}

/* noise.c: splitmix64, and the sum of twelve. */
#include "noise.h"

#define WORDS 3U      /* of four uniform numbers each */
#define MEAN 0x5fffaU /* 12 * 65535 / 2 */

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
    return (int32_t)(sum - MEAN);
}

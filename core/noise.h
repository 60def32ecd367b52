/* noise.h: Gaussian noise that is the same everywhere: a number from a seed and an index, no state.
 *
 * The sum z of twelve uniform 16-bit numbers, less its mean, is turned into a Gaussian deviate by a polynomial of degree 9
 * (Teichroew 1953; Knuth, The Art of Computer Programming 2, section 3.4.1). The uniform numbers are the words 3 index + 1
 * to 3 index + 3 of splitmix64 (Steele, Lea & Flood, Fast splittable pseudorandom number generators, OOPSLA 2014),
 * started at the mixed seed. All is integer arithmetic of 64 bits, and the result has 21 bits with its sign, so float and
 * double builds give the same number exactly.
 *
 * Its limits: mean 0, standard deviation 1.0001, kurtosis 3.002. Beyond three standard deviations there are 1.006 times a
 * Gaussian's values, beyond four 1.05 times, beyond 8.6 none. Good for sensors, and not for secrets.
 */
#ifndef WH_NOISE_H
#define WH_NOISE_H

#include "real.h"

#ifdef __cplusplus
extern "C" {
#endif

#define wh_noise_raw WH_NAME(wh_noise_raw)

/* The deviate of `seed` at `index` in units of 2^-16: -566871 to 566871. Other seeds give sequences that
 * have nothing to do with each other; equal ones the same. */
int32_t wh_noise_raw(uint32_t seed, uint64_t index);

/* The same as a number of standard deviations, exactly: times 2^-16. */
WH_INLINE wh_real wh_noise(uint32_t seed, uint64_t index) {
    return (wh_real)wh_noise_raw(seed, index) * WH_R(1.52587890625e-05);
}

#ifdef __cplusplus
}
#endif

#endif

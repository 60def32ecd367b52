/* noise.h: Gaussian noise with the same bits everywhere: a function of a seed and an index, without state.
 *
 * The sum of twelve uniform 16-bit numbers, less its mean, is nearly Gaussian. A polynomial of degree 9 corrects it
 * (Teichroew 1953; Knuth, The Art of Computer Programming 2, section 3.4.1). Three 64-bit words of splitmix64 (Steele,
 * Lea & Flood, Fast splittable pseudorandom number generators, OOPSLA 2014) give the uniform numbers. All arithmetic is
 * in integers. The result has 21 bits, so a float holds it exactly.
 *
 * The mean is 0, the standard deviation 1.0001, the kurtosis 3.002. Values beyond three standard deviations are 1.006
 * times as frequent as a Gaussian's, values beyond four 1.05 times. No value is beyond 8.65. Not for cryptography. */
#ifndef WH_NOISE_H
#define WH_NOISE_H

#include "real.h"

WH_C_BEGIN

#define wh_noise_raw WH_NAME(wh_noise_raw)

/* The deviate of `seed` at `index` in units of 2^-16: -566871 to 566871. Different seeds give independent sequences. */
int32_t wh_noise_raw(uint32_t seed, uint64_t index);

/* The deviate in standard deviations: wh_noise_raw() times 2^-16, exactly. */
WH_INLINE wh_real wh_noise(uint32_t seed, uint64_t index) {
    return (wh_real)wh_noise_raw(seed, index) * WH_R(1.52587890625e-05);
}

WH_C_END

#endif

/* test_noise.c: noise as a function of seed and index: the same integers on every machine, and the documented
 * distribution. WH_TEST_SMALL: fewer draws. */
#include "core/noise.h"

#include "tests/suites.h"

#define DRAWS (WH_TEST_SMALL ? 4096 : 65536)
/* Four standard errors of an estimate from DRAWS numbers, relative: 4/sqrt(DRAWS). */
#define FOUR_SIGMA (WH_TEST_SMALL ? 0.0625 : 0.015625)
#define ONE 65536 /* one standard deviation, in raw units */

/* Reference values from a Python program, whose splitmix64 gives the published first outputs of seed 1234567
 * (6457827717110365317, 3203168211198807973). */
TEST(noise, fixed_values) {
    static const struct {
        uint64_t index;
        uint32_t seed;
        int32_t raw;
    } known[] = {{0, 0, 4280},
                 {1, 0, 6721},
                 {0, 1, 77899},
                 {1, 1, 40335},
                 {2, 1, -56621},
                 {1000, 7, 98131},
                 {UINT64_C(1) << 32, 42, -75712},
                 {0, UINT32_MAX, -49239},
                 {UINT64_MAX, UINT32_MAX, -79612},
                 {9000, 123456789, -38615}};
    for (unsigned i = 0; i < sizeof known / sizeof known[0]; i++) {
        TEST_ASSERT_EQUAL_INT32(known[i].raw, wh_noise_raw(known[i].seed, known[i].index));
        const wh_real deviate = wh_noise(known[i].seed, known[i].index);
        TEST_ASSERT_TRUE(deviate * WH_R(65536.0) == (wh_real)known[i].raw); /* exact */
    }
}

/* The moments of order 1, 2 and 4 are a Gaussian's (0, 1 and 3) to 0.1 %. The tolerances are from the standard errors
 * of a Gaussian's moments: 1, sqrt 2, sqrt 96. */
TEST(noise, moments) {
    for (uint32_t seed = 1; seed <= 4; seed++) {
        int64_t sum = 0;
        int64_t squares = 0;
        int64_t fourths = 0; /* fourth powers of deviates in units of 2^-8 */
        for (unsigned i = 0; i < DRAWS; i++) {
            const int64_t x = wh_noise_raw(seed, i);
            TEST_ASSERT_TRUE(x >= -566871 && x <= 566871);
            sum += x;
            squares += x * x;
            const int64_t y = (x / 256) * (x / 256);
            fourths += y * y;
        }
        const double mean = (double)sum / DRAWS / ONE;
        const double second = (double)squares / DRAWS / ((double)ONE * ONE);
        const double fourth = (double)fourths / DRAWS / (65536.0 * 65536.0);
        TEST_ASSERT_TRUE(mean > -FOUR_SIGMA && mean < FOUR_SIGMA);
        TEST_ASSERT_TRUE(second > 1.0 - 1.42 * FOUR_SIGMA && second < 1.0 + 1.42 * FOUR_SIGMA);
        TEST_ASSERT_TRUE(fourth > 3.0 - 9.8 * FOUR_SIGMA && fourth < 3.0 + 9.8 * FOUR_SIGMA);
    }
}

/* The shares beyond one to four standard deviations are a Gaussian's. The tolerances are four standard errors of a
 * count, sqrt(p (1 - p)/(16 DRAWS)). A sum of twelve uniform numbers would fail: 0.0020 instead of 0.0027 are beyond
 * three. */
TEST(noise, tails) {
    const uint32_t seeds = 16; /* 16 * DRAWS does not fit an AVR's int */
    static const double part[] = {0.31731, 0.045500, 0.0026998, 6.33e-5};
    static const double root[] = {0.46543, 0.20840, 0.051889, 0.0079585}; /* sqrt(p (1 - p)) */
    unsigned beyond[4] = {0};
    for (uint32_t i = 0; i < seeds * DRAWS; i++) {
        const int32_t x = wh_noise_raw(2026 + i % seeds, i / seeds);
        for (int k = 0; k < 4; k++) {
            beyond[k] += x > (k + 1) * ONE || x < -(k + 1) * ONE;
        }
    }
    for (int k = 0; k < 4; k++) {
        const double found = (double)beyond[k] / (seeds * DRAWS);
        TEST_ASSERT_TRUE(found > part[k] - root[k] * (FOUR_SIGMA / 4));
        TEST_ASSERT_TRUE(found < part[k] + root[k] * (FOUR_SIGMA / 4));
    }
}

/* The correlation of two independent sequences of unit deviates is within 4/sqrt(DRAWS). */
static double correlation(uint32_t a, uint32_t b, unsigned lag) {
    int64_t sum = 0;
    for (unsigned i = 0; i < DRAWS; i++) {
        sum += (int64_t)wh_noise_raw(a, i) * wh_noise_raw(b, i + lag);
    }
    return (double)sum / DRAWS / ((double)ONE * ONE);
}

TEST(noise, independence) {
    static const uint32_t seeds[][2] = {{0, 1}, {1, 2}, {1, 0x80000001U}, {7, 70}};
    for (unsigned i = 0; i < sizeof seeds / sizeof seeds[0]; i++) {
        for (unsigned lag = 0; lag < 3; lag++) {
            const double with_other = correlation(seeds[i][0], seeds[i][1], lag);
            TEST_ASSERT_TRUE(with_other > -FOUR_SIGMA && with_other < FOUR_SIGMA);
            const double with_itself = correlation(seeds[i][0], seeds[i][0], lag + 1U);
            TEST_ASSERT_TRUE(with_itself > -FOUR_SIGMA && with_itself < FOUR_SIGMA);
        }
    }
}

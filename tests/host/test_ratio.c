/* test_ratio.c: times as fractions (host/number/ratio.h): what a decimal or a simple fraction is taken for, and how often one
 * goes into another, against whole numbers counted by the test; halves among them. */
#include <math.h>
#include <stdint.h>

#include "command.h"
#include "host/number/ratio.h"
#include "unity.h"

void suite_ratio(void);

static bool same(whole_ratio r, uint64_t of, uint64_t in) {
    return r.numerator * in == of * r.denominator; /* both below 2^32 */
}

static void test_decimals_and_fractions_are_themselves(void) {
    dice d = dice_of("ratio", 71);
    for (unsigned k = 0; k < 4000U; k++) {
        const uint64_t of = 1U + dice_one_of(&d, 9999);
        uint64_t in = 1;
        for (unsigned i = dice_one_of(&d, 6); i > 0; i--) {
            in *= 10U;
        }
        TEST_ASSERT_TRUE(same(ratio_of((double)of / (double)in), of, in));
        const uint64_t less = 1U + dice_one_of(&d, 60);
        const uint64_t more = 1U + dice_one_of(&d, 60);
        TEST_ASSERT_TRUE(same(ratio_of((double)less / (double)more), less, more));
    }
    const whole_ratio none = ratio_of(-1.0);
    TEST_ASSERT_TRUE(none.numerator == 0 && none.denominator == 1);
    TEST_ASSERT_TRUE(ratio_of(0.0).numerator == 0 && ratio_of((double)NAN).numerator == 0);
}

/* Any double is within 2^-51 of what it is taken for, and what is beyond the ends of their range, of the nearer end. */
static void test_nothing_is_far_off(void) {
    dice d = dice_of("ratio", 72);
    for (unsigned k = 0; k < 4000U; k++) {
        const int power =
            k % 2U == 0 ? (int)dice_one_of(&d, 130) - 65 : (int)dice_one_of(&d, 2096) - 1073;
        const double drawn = ldexp(dice_between(&d, 1.0, 2.0), power);
        const double value = fmin(fmax(drawn, RATIO_LEAST), RATIO_MOST);
        const whole_ratio r = ratio_of(drawn);
        TEST_ASSERT_TRUE(r.denominator > 0 && r.denominator >> 60 == 0 && r.numerator >> 60 == 0);
        const long double is = (long double)r.numerator / (long double)r.denominator;
        TEST_ASSERT_TRUE(fabsl(is - (long double)value) <= 0x1p-51L * (long double)value);
        const uint64_t count = 1U + dice_one_of(&d, 1U << 30);
        const long double times = (long double)count * is;
        TEST_ASSERT_TRUE(fabsl((long double)ratio_times(count, r) - times) <= 0x1.1p-53L * times);
    }
}

static void test_counts_are_nearest(void) {
    dice d = dice_of("ratio", 73);
    for (unsigned k = 0; k < 4000U; k++) {
        whole_ratio whole = {dice_one_of(&d, 1U << 20), 1U + dice_one_of(&d, 1U << 10)};
        const whole_ratio part = {1U + dice_one_of(&d, 1U << 10), 1U + dice_one_of(&d, 1U << 10)};
        if (k % 2U == 0) { /* a whole number of them and a half, and what is next to it */
            const uint64_t halves = 1U + dice_one_of(&d, 2000);
            whole =
                (whole_ratio){halves * part.numerator * 1000U + k % 3U, 2000U * part.denominator};
        }
        const uint64_t over = whole.numerator * part.denominator;
        const uint64_t under = whole.denominator * part.numerator;
        uint64_t count = 0;
        TEST_ASSERT_TRUE(ratio_count(whole, part, &count));
        TEST_ASSERT_EQUAL_UINT64(over / under + (2U * (over % under) > under ? 1U : 0U), count);
    }
    uint64_t count = 0;
    const whole_ratio most = {UINT64_C(1) << 59, 1};
    TEST_ASSERT_TRUE(ratio_count(most, (whole_ratio){1, 16}, &count) && count == UINT64_C(1) << 63);
    TEST_ASSERT_FALSE(ratio_count(most, (whole_ratio){1, 17}, &count));
}

void suite_ratio(void) {
    RUN_TEST(test_decimals_and_fractions_are_themselves);
    RUN_TEST(test_nothing_is_far_off);
    RUN_TEST(test_counts_are_nearest);
}

/* test_wide.c: whole numbers of 128 bits do as the compiler's own, where it has them, and as schoolbooks say everywhere. */
#include <inttypes.h>
#include <stdio.h>

#include "derived.h"
#include "host/number/wide.h"
#include "unity.h"

void suite_wide(void);

enum { NUMBERS = 40000 };

static uint64_t seed = 20261123;

/* Of any length, with rows of zeros and ones. */
static wide any(void) {
    wide n = {random_bits(&seed), random_bits(&seed)};
    if (random_bits(&seed) % 3 == 0) {
        n.high = 0;
    }
    if (random_bits(&seed) % 3 == 0) {
        n.low = random_bits(&seed) % 2 == 0 ? 0 : UINT64_MAX;
    }
    return wide_right(n, (int)(random_bits(&seed) % 128));
}

static bool same(wide a, wide b) { return !wide_below(a, b) && !wide_below(b, a); }

static void test_laws(void) {
    for (int i = 0; i < NUMBERS; i++) {
        const wide a = any();
        const wide b = any();
        const wide c = any();
        const int bits = (int)(random_bits(&seed) % 128);
        TEST_ASSERT_TRUE(same(wide_minus(wide_plus(a, b), b), a));
        TEST_ASSERT_TRUE(
            same(wide_times(a, wide_plus(b, c)), wide_plus(wide_times(a, b), wide_times(a, c))));
        TEST_ASSERT_TRUE(same(wide_left(a, bits), wide_times(a, wide_left(wide_of(1), bits))));
        if (!wide_is_zero(b)) {
            wide rest;
            const wide quotient = wide_over(a, b, &rest);
            TEST_ASSERT_TRUE(wide_below(rest, b));
            TEST_ASSERT_TRUE(same(wide_plus(wide_times(quotient, b), rest), a));
            TEST_ASSERT_TRUE(!wide_below(a, quotient));
        }
        if (bits > 0) {
            TEST_ASSERT_TRUE(
                same(wide_right(a, bits), wide_over(a, wide_left(wide_of(1), bits), NULL)));
        }
    }
}

#ifdef __SIZEOF_INT128__
__extension__ typedef unsigned __int128 native;

static native native_of(wide a) { return (native)a.high << 64 | a.low; }

static void test_the_compilers_own(void) {
    for (int i = 0; i < NUMBERS; i++) {
        const wide a = any();
        const wide b = any();
        const int bits = (int)(random_bits(&seed) % 128);
        TEST_ASSERT_TRUE(native_of(wide_plus(a, b)) == native_of(a) + native_of(b));
        TEST_ASSERT_TRUE(native_of(wide_minus(a, b)) == native_of(a) - native_of(b));
        TEST_ASSERT_TRUE(native_of(wide_times(a, b)) == native_of(a) * native_of(b));
        TEST_ASSERT_TRUE(native_of(wide_left(a, bits)) == native_of(a) << bits);
        TEST_ASSERT_TRUE(native_of(wide_right(a, bits)) == native_of(a) >> bits);
        TEST_ASSERT_TRUE(wide_below(a, b) == (native_of(a) < native_of(b)));
        if (!wide_is_zero(b)) {
            TEST_ASSERT_TRUE(native_of(wide_over(a, b, NULL)) == native_of(a) / native_of(b));
        }
    }
}
#endif

void suite_wide(void) {
    printf("wide: seed %" PRIu64 "\n", seed);
    RUN_TEST(test_laws);
#ifdef __SIZEOF_INT128__
    RUN_TEST(test_the_compilers_own);
#endif
}

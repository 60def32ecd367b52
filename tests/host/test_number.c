/* test_number.c: number functions of the host, compared with those of the C library, which are exact here. Seeds are
 * fixed. Also integers of 128 bits, and times as fractions. */
#include "bits.h"
#include "command.h"
#include "derived.h"
#include "host/number/functions.h"
#include "host/number/ratio.h"
#include "tests/scattered.h"

#define MANY 400000

/* Any bits, small and large integers, halves, and their neighbours. */
static double any(void) {
    const double half = 0.5 * (double)((int64_t)scattered() >> (scattered() % 64U));
    switch (scattered() % 4U) {
    case 0: return half;
    case 1: return nextafter(half, (scattered() & 1U) != 0 ? (double)INFINITY : -(double)INFINITY);
    case 2: return of_bits(scattered() & ~(UINT64_C(0x7ff) << 52)); /* subnormal or 0 */
    default: return of_bits(scattered());
    }
}

static void expect_same(const char *name, double got, double wanted, double x, double y) {
    if (isnan(got) && isnan(wanted)) {
        return;
    }
    if (bits_of(got) != bits_of(wanted)) {
        char text[160];
        (void)snprintf(text, sizeof text, "%s(%a, %a): %a, not %a", name, x, y, got, wanted);
        TEST_FAIL_MESSAGE(text);
    }
}

static void test_whole_numbers(void) {
    scattered_state = 1;
    for (int i = 0; i < MANY; i++) {
        const double x = any();
        expect_same("floor", number_floor(x), floor(x), x, 0.0);
        expect_same("ceiling", number_ceiling(x), ceil(x), x, 0.0);
        expect_same("nearest", number_nearest(x), round(x), x, 0.0);
        expect_same("even", number_even(x), nearbyint(x), x, 0.0);
    }
}

static void test_roots(void) {
    scattered_state = 2;
    for (int i = 0; i < MANY; i++) {
        const double x = any();
        expect_same("root", number_root(x), sqrt(x), x, 0.0);
        expect_same("sqrt", number_call(FN_SQRT, x, 0.0), sqrt(x), x, 0.0);
        const double whole = (double)(scattered() >> 38);
        expect_same("root of a square", number_root(whole * whole), whole, whole, 0.0);
    }
}

static void test_exponents(void) {
    scattered_state = 3;
    for (int i = 0; i < MANY; i++) {
        const double x = any();
        const int shift = (int)(scattered() % 4600U) - 2300;
        expect_same("scaled", number_scaled(x, shift), ldexp(x, shift), x, shift);
        int got;
        int wanted;
        const double part = frexp(x, &wanted);
        expect_same("split", number_split(x, &got), part, x, 0.0);
        TEST_ASSERT_TRUE(!isfinite(x) || got == wanted);
    }
}

/* A remainder of zero has the sign of x; that of glibc's remainder() has not. */
static void expect_remainders(double x, double y) {
    const double nearest = remainder(x, y);
    expect_same("remainder", number_remainder(x, y), fmod(x, y), x, y);
    expect_same("centred", number_centred(x, y), nearest == 0.0 ? copysign(0.0, x) : nearest, x, y);
}

static void test_remainders(void) {
    scattered_state = 4;
    for (int i = 0; i < MANY; i++) {
        const double x = any();
        const double y = any();
        expect_remainders(x, y);
    }
    for (int i = 0; i < MANY; i++) { /* tests multiples of 1/2 */
        const double y = (double)(1 + scattered() % 1000U);
        const double x = 0.5 * y * (double)((int64_t)(scattered() % 2000U) - 1000);
        expect_remainders(x, y);
    }
}

static void test_sizes(void) {
    scattered_state = 5;
    for (int i = 0; i < MANY; i++) {
        const double a = any();
        const double b = any();
        if (a == b || isnan(a) || isnan(b)) {
            continue;
        }
        expect_same("least", number_least(a, b), fmin(a, b), a, b);
        expect_same("most", number_most(a, b), fmax(a, b), a, b);
    }
    const double no_number = (double)NAN;
    TEST_ASSERT_TRUE(number_least(no_number, 1.0) == 1.0 && number_most(1.0, no_number) == 1.0);
    TEST_ASSERT_TRUE(isnan(number_least(no_number, no_number)));
    TEST_ASSERT_FALSE(signbit(number_most(0.0, -0.0)));
    TEST_ASSERT_TRUE(signbit(number_least(-0.0, 0.0)));
}

/* The functions of the language: NaN must give NaN; sign() must give 1, 0 and -1. */
static void test_language(void) {
    const double no_number = (double)NAN;
    for (int f = 0; f < FUNCTIONS; f++) {
        TEST_ASSERT_TRUE(isnan(number_call((function_id)f, no_number, no_number)));
    }
    TEST_ASSERT_TRUE(isnan(number_call(FN_MIN, 1.0, no_number)));
    TEST_ASSERT_TRUE(isnan(number_call(FN_MAX, no_number, 1.0)));
    TEST_ASSERT_TRUE(number_call(FN_MIN, 1.0, -(double)INFINITY) == -(double)INFINITY);
    TEST_ASSERT_TRUE(number_call(FN_MAX, 1.0, 2.0) == 2.0);
    TEST_ASSERT_TRUE(number_call(FN_SIGN, -3.0, 0.0) == -1.0);
    TEST_ASSERT_TRUE(number_call(FN_SIGN, 0.0, 0.0) == 0.0);
    TEST_ASSERT_TRUE(number_call(FN_ABS, -3.0, 0.0) == 3.0);
    TEST_ASSERT_TRUE(number_call(FN_ATAN2, 1.0, 0.0) == 0x1.921fb54442d18p0); /* y first */
    TEST_ASSERT_TRUE(number_call(FN_ATAN2, 0.0, -1.0) == 0x1.921fb54442d18p1);
    TEST_ASSERT_TRUE(number_call(FN_EXP, 0.0, 0.0) == 1.0);
    TEST_ASSERT_TRUE(number_call(FN_LOG, 1.0, 0.0) == 0.0);
    TEST_ASSERT_TRUE(number_sine(0.0) == 0.0 && number_cosine(0.0) == 1.0);
}

/* Integers of 128 bits, compared with the compiler's type. Without that type, these tests are left out. */
enum { NUMBERS = 40000 };

static uint64_t seed = 20261123;

#ifdef __SIZEOF_INT128__
/* A random number of any length, with runs of zeros and ones. */
static uint128 any_wide(void) {
    uint128 n = {random_bits(&seed), random_bits(&seed)};
    if (random_bits(&seed) % 3 == 0) {
        n.high = 0;
    }
    if (random_bits(&seed) % 3 == 0) {
        n.low = random_bits(&seed) % 2 == 0 ? 0 : UINT64_MAX;
    }
    return uint128_right(n, (int)(random_bits(&seed) % 128));
}

__extension__ typedef unsigned __int128 native;

static native native_of(uint128 a) { return (native)a.high << 64 | a.low; }

static void test_the_compilers_own(void) {
    for (int i = 0; i < NUMBERS; i++) {
        const uint128 a = any_wide();
        const uint128 b = any_wide();
        const int bits = (int)(random_bits(&seed) % 128);
        TEST_ASSERT_TRUE(native_of(uint128_plus(a, b)) == native_of(a) + native_of(b));
        TEST_ASSERT_TRUE(native_of(uint128_minus(a, b)) == native_of(a) - native_of(b));
        TEST_ASSERT_TRUE(native_of(uint128_times(a, b)) == native_of(a) * native_of(b));
        TEST_ASSERT_TRUE(native_of(uint128_left(a, bits)) == native_of(a) << bits);
        TEST_ASSERT_TRUE(native_of(uint128_right(a, bits)) == native_of(a) >> bits);
        TEST_ASSERT_TRUE(uint128_below(a, b) == (native_of(a) < native_of(b)));
        if (!uint128_is_zero(b)) {
            uint128 rest;
            TEST_ASSERT_TRUE(native_of(uint128_over(a, b, &rest)) == native_of(a) / native_of(b));
            TEST_ASSERT_TRUE(native_of(rest) == native_of(a) % native_of(b));
        }
    }
}
#endif

/* Times as fractions (host/number/ratio.h): the fraction of a decimal number, and how often one time fits into
 * another. The reference counts in integers, including halves. */
static bool same_ratio(whole_ratio r, uint64_t of, uint64_t in) {
    return r.numerator * in == of * r.denominator; /* the products are below 2^64 */
}

static void test_decimals_and_fractions_are_themselves(void) {
    dice d = dice_of("ratio", 71);
    for (unsigned k = 0; k < 4000U; k++) {
        const uint64_t of = 1U + dice_one_of(&d, 9999);
        uint64_t in = 1;
        for (unsigned i = dice_one_of(&d, 6); i > 0; i--) {
            in *= 10U;
        }
        TEST_ASSERT_TRUE(same_ratio(ratio_of((double)of / (double)in), of, in));
        const uint64_t less = 1U + dice_one_of(&d, 60);
        const uint64_t more = 1U + dice_one_of(&d, 60);
        TEST_ASSERT_TRUE(same_ratio(ratio_of((double)less / (double)more), less, more));
    }
    const whole_ratio none = ratio_of(-1.0);
    TEST_ASSERT_TRUE(none.numerator == 0 && none.denominator == 1);
    TEST_ASSERT_TRUE(ratio_of(0.0).numerator == 0 && ratio_of((double)NAN).numerator == 0);
}

/* A double's fraction must be within 2^-51 of it. A double out of range must give the nearer end of the range. */
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
        if (k % 2U == 0) { /* an integer plus a half, and its neighbours */
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

SUITE(number) {
    RUN_TEST(test_whole_numbers);
    RUN_TEST(test_roots);
    RUN_TEST(test_exponents);
    RUN_TEST(test_remainders);
    RUN_TEST(test_sizes);
    RUN_TEST(test_language);
    printf("wide: seed %" PRIu64 "\n", seed);
#ifdef __SIZEOF_INT128__
    RUN_TEST(test_the_compilers_own);
#endif
    RUN_TEST(test_decimals_and_fractions_are_themselves);
    RUN_TEST(test_nothing_is_far_off);
    RUN_TEST(test_counts_are_nearest);
}

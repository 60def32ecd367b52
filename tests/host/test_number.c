/* test_number.c: what the host computes numbers with, against the machine's library, whose functions of these
 * are exact. Seeds are fixed. */
#include "bits.h"
#include "host/lang/units.h"
#include "host/number/functions.h"

#include "tests/scattered.h"
#include "unity.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

void suite_number(void);

#define MANY 400000

/* Any bits, small and large whole numbers, halves and what is next to them. */
static double any(void) {
    const double half = 0.5 * (double)((int64_t)scattered() >> (scattered() % 64U));
    switch (scattered() % 4U) {
    case 0: return half;
    case 1: return nextafter(half, (scattered() & 1U) != 0 ? (double)INFINITY : -(double)INFINITY);
    case 2: return of_bits(scattered() & ~(UINT64_C(0x7ff) << 52)); /* subnormal or zero */
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

/* What is left has the sign of x where it is zero, which glibc's remainder() does not keep. */
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
    for (int i = 0; i < MANY; i++) { /* multiples of a half */
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
        if (a == b || isnan(a) || isnan(b)) { /* of zeros, libraries take either */
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

/* In the language what is no number goes through, the signs of numbers come out as 1, 0 and -1. */
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

/* Powers of units that are decimal fractions stay whole over whole: 7 [1/ms^2] is 7 * 1000000 / 1. */
static void test_powers_of_units(void) {
    static const struct {
        const char *name;
        double in_si; /* of these in one of SI */
    } small[] = {{"ms", 1e3}, {"cm", 1e2}, {"us", 1e6}, {"g", 1e3}};
    for (size_t i = 0; i < sizeof small / sizeof small[0]; i++) {
        double power = 1.0;
        for (int exponent = 1; exponent <= 3; exponent++) {
            power *= small[i].in_si;
            char text[32];
            unit_scale up;
            unit_scale down;
            unit_error error;
            (void)snprintf(text, sizeof text, "%s^%d", small[i].name, exponent);
            TEST_ASSERT_TRUE(unit_parse(text, strlen(text), &up, &error));
            TEST_ASSERT_TRUE(up.scale == 1.0 && up.divisor == power);
            (void)snprintf(text, sizeof text, "%s^-%d", small[i].name, exponent);
            TEST_ASSERT_TRUE_MESSAGE(unit_parse(text, strlen(text), &down, &error), text);
            TEST_ASSERT_TRUE_MESSAGE(down.scale == power && down.divisor == 1.0, text);
        }
    }
}

void suite_number(void) {
    RUN_TEST(test_whole_numbers);
    RUN_TEST(test_roots);
    RUN_TEST(test_exponents);
    RUN_TEST(test_remainders);
    RUN_TEST(test_sizes);
    RUN_TEST(test_language);
    RUN_TEST(test_powers_of_units);
}

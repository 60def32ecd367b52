/* test_enclosure.c: intervals must contain the exact results and be no wider than necessary. The operations run on
 * random ends and on random numbers between them. The reference has 113 bits, in which sums and products of these
 * doubles are exact. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "command.h"
#include "host/number/enclosure.h"
#include "quad_arms.h"
#include "unity.h"

void suite_enclosure(void);

static dice die;

/* A number between 2^-20 and 2^20 with either sign, with all bits or few, so that sums need 113 bits or less. */
static double drawn(void) {
    const double size = ldexp(dice_between(&die, 1.0, 2.0), (int)dice_one_of(&die, 40) - 20);
    const double few = dice_one_of(&die, 4) == 0 ? nearbyint(size) : size;
    return dice_one_of(&die, 2) == 0 ? few : -few;
}

/* A point, a narrow interval, or a wide interval, which may contain zero. */
static enclosure drawn_enclosure(void) {
    const double a = drawn();
    const unsigned kind = dice_one_of(&die, 3);
    const double b = kind == 0 ? a : kind == 1 ? a + 1e-12 * fabs(drawn()) : drawn();
    return (enclosure){fmin(a, b), fmax(a, b)};
}

static double between(enclosure a) {
    const double x = a.low + dice_between(&die, 0.0, 1.0) * (a.high - a.low);
    return dice_one_of(&die, 3) == 0 ? a.low : fmin(fmax(x, a.low), a.high);
}

static void expect_holds(const char *what, enclosure got, quad exact) {
    char message[160];
    snprintf(message, sizeof message, "%s: %.17g is not in [%.17g, %.17g]", what, (double)exact,
             got.low, got.high);
    TEST_ASSERT_TRUE_MESSAGE((quad)got.low <= exact && exact <= (quad)got.high, message);
}

/* For a point as argument: the ends must be within `units` units in the last place. */
static void expect_narrow(const char *what, enclosure got, double units) {
    const double unit = fmax(fabs(got.low), fabs(got.high)) * 0x1p-52 + 1e-300;
    TEST_ASSERT_TRUE_MESSAGE(got.high - got.low <= units * unit, what);
}

static void test_four_operations(void) {
#ifdef QUAD_KNOWN
    for (unsigned i = 0; i < dice_cases(usual_or(200000, 50000)); i++) {
        const enclosure a = drawn_enclosure();
        const enclosure b = drawn_enclosure();
        const double x = between(a);
        const double y = between(b);
        expect_holds("a sum", enclosure_add(a, b), (quad)x + (quad)y);
        expect_holds("a difference", enclosure_sub(a, b), (quad)x - (quad)y);
        expect_holds("a product", enclosure_mul(a, b), (quad)x * (quad)y);
        expect_holds("a square", enclosure_square(a), (quad)x * (quad)x);
        const enclosure ratio = enclosure_div(a, b);
        if (b.low <= 0.0 && b.high >= 0.0) {
            TEST_ASSERT_FALSE(enclosure_is_finite(ratio));
        } else { /* the bounds of the ratio, multiplied exactly by y, must enclose x */
            const quad low = (quad)ratio.low * (quad)y;
            const quad high = (quad)ratio.high * (quad)y;
            expect_holds("a ratio", ratio, (quad)x / (quad)y);
            TEST_ASSERT_TRUE(y > 0.0 ? low <= (quad)x && (quad)x <= high
                                     : low >= (quad)x && (quad)x >= high);
        }
        if (a.low == a.high && b.low == b.high) {
            expect_narrow("a sum", enclosure_add(a, b), 4.0);
            expect_narrow("a product", enclosure_mul(a, b), 4.0);
        }
    }
#else
    TEST_IGNORE_MESSAGE("no numbers of 113 bits here");
#endif
}

/* At the ends of a double's range, the error terms of products lose their bits. */
static void test_smallest_and_largest(void) {
    static const double sizes[] = {0x1p-1074, 0x1.8p-1073, 0x1p-1022, 0x1.fffffffffffffp-1022,
                                   0x1p-1000, 1.0,         0x1p1022,  0x1.fffffffffffffp1023};
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        for (int sign = -1; sign <= 1; sign += 2) {
            const double x = sign * sizes[i];
            TEST_ASSERT_TRUE(enclosure_below(x) <= nextafter(x, -(double)INFINITY));
            TEST_ASSERT_TRUE(enclosure_above(x) >= nextafter(x, (double)INFINITY));
        }
    }
    const enclosure tiny = enclosure_mul(enclosure_of(0x1p-600), enclosure_of(0x1p-600));
    TEST_ASSERT_TRUE(tiny.low <= 0.0 && tiny.high > 0.0);
    TEST_ASSERT_FALSE(enclosure_is_finite(enclosure_mul(enclosure_of(1e300), enclosure_of(1e300))));
    TEST_ASSERT_FALSE(enclosure_is_finite(enclosure_root((enclosure){-1e-300, 1.0})));
    TEST_ASSERT_FALSE(enclosure_is_finite(enclosure_log((enclosure){0.0, 1.0})));
    const enclosure lost = enclosure_div(enclosure_of(1.0), (enclosure){-1.0, 1.0});
    TEST_ASSERT_FALSE(enclosure_is_finite(enclosure_mul(enclosure_of(0.0), lost)));
    TEST_ASSERT_FALSE(enclosure_is_finite(enclosure_hull(enclosure_of(0.0), lost)));
    TEST_ASSERT_FALSE(enclosure_is_finite(enclosure_add(lost, enclosure_of(0.0))));
}

/* Any finite double: subnormal and the largest numbers come as often as others. */
static double drawn_bits(void) {
    const int exponent = (int)dice_one_of(&die, 2098) - 1074;
    const double size = ldexp(dice_between(&die, 1.0, 2.0), exponent);
    return dice_one_of(&die, 40) == 0 ? 0.0 : dice_one_of(&die, 2) == 0 ? size : -size;
}

/* With the largest doubles, an operation may return an infinite interval. */
static void expect_holds_or_large(const char *what, enclosure got, quad exact) {
    if (enclosure_is_finite(got)) {
        expect_holds(what, got, exact);
    } else {
        const double size = fabs((double)exact);
        TEST_ASSERT_TRUE_MESSAGE(size > 0x1p1020, what);
    }
}

static void expect_whole_range(double x, double y) {
    const enclosure a = enclosure_of(x);
    const enclosure b = enclosure_of(y);
    expect_holds_or_large("a sum", enclosure_add(a, b), (quad)x + (quad)y);
    expect_holds_or_large("a difference", enclosure_sub(a, b), (quad)x - (quad)y);
    expect_holds_or_large("a product", enclosure_mul(a, b), (quad)x * (quad)y);
    expect_holds_or_large("a product by a point", enclosure_times(a, y), (quad)x * (quad)y);
    expect_holds_or_large("a square", enclosure_square(a), (quad)x * (quad)x);
    const enclosure both = {fmin(x, y), fmax(x, y)};
    const enclosure parts[] = {enclosure_mul(both, a), enclosure_times(both, x)};
    for (int i = 0; i < 2; i++) { /* if infinite, only the larger product is checked */
        const bool finite = enclosure_is_finite(parts[i]);
        expect_holds_or_large("all products", parts[i],
                              finite || fabs(x) > fabs(y) ? (quad)x * (quad)x : (quad)x * (quad)y);
        expect_holds_or_large("all products", parts[i],
                              finite || fabs(y) > fabs(x) ? (quad)x * (quad)y : (quad)x * (quad)x);
    }
    if (y != 0.0) {
        expect_holds_or_large("a ratio", enclosure_div(a, b), (quad)x / (quad)y);
    } else {
        TEST_ASSERT_FALSE(enclosure_is_finite(enclosure_div(a, b)));
    }
    if (x >= 0.0) {
        const enclosure root = enclosure_root(a);
        TEST_ASSERT_TRUE((quad)root.low * (quad)root.low <= (quad)x &&
                         (quad)root.high * (quad)root.high >= (quad)x);
    }
    const double middle = enclosure_middle(both);
    const double radius = enclosure_radius(both);
    TEST_ASSERT_TRUE((quad)middle - (quad)radius <= (quad)both.low &&
                     (quad)both.high <= (quad)middle + (quad)radius);
}

/* Any double, or one whose product or ratio with x is subnormal. */
static double drawn_beside(double x) {
    const double y = drawn_bits();
    if (x == 0.0 || y == 0.0 || dice_one_of(&die, 2) == 0) {
        return y;
    }
    const int least = -1060 + (int)dice_one_of(&die, 60);
    const int sign = dice_one_of(&die, 2) == 0 ? 1 : -1;
    const double other = ldexp(y, -ilogb(y) + sign * (least - ilogb(x)));
    return isfinite(other) ? other : y;
}

static void test_whole_range(void) {
#ifdef QUAD_KNOWN
    for (unsigned i = 0; i < dice_cases(few_or_all(usual_or(10000, 4000), 2000000)); i++) {
        const double x = drawn_bits();
        expect_whole_range(x, drawn_beside(x));
        TEST_ASSERT_TRUE(enclosure_below(x) < x && enclosure_above(x) > x);
    }
#else
    TEST_IGNORE_MESSAGE("no numbers of 113 bits here");
#endif
}

/* An interval that is not finite must stay so under every operation. */
static void test_not_finite(void) {
    static const double large = 0x1.fffffffffffffp1023;
    const double ends[] = {-(double)INFINITY, (double)INFINITY, (double)NAN, 0.0, 1.0, -large};
    for (int i = 0; i < 36; i++) {
        const enclosure bad = {ends[i / 6], ends[i % 6]};
        for (unsigned k = 0; k < 100 && !enclosure_is_finite(bad); k++) {
            const enclosure a = k == 0 ? enclosure_of(0.0) : drawn_enclosure();
            TEST_ASSERT_FALSE(enclosure_is_finite(enclosure_add(bad, a)));
            TEST_ASSERT_FALSE(enclosure_is_finite(enclosure_sub(a, bad)));
            TEST_ASSERT_FALSE(enclosure_is_finite(enclosure_mul(bad, a)));
            TEST_ASSERT_FALSE(enclosure_is_finite(enclosure_mul(a, bad)));
            TEST_ASSERT_FALSE(enclosure_is_finite(enclosure_times(bad, a.low)));
            TEST_ASSERT_FALSE(enclosure_is_finite(enclosure_div(bad, a)));
            TEST_ASSERT_FALSE(enclosure_is_finite(enclosure_div(a, bad)));
            TEST_ASSERT_FALSE(enclosure_is_finite(enclosure_square(bad)));
            TEST_ASSERT_FALSE(enclosure_is_finite(enclosure_hull(bad, a)));
            TEST_ASSERT_FALSE(enclosure_is_finite(enclosure_hull(a, bad)));
            TEST_ASSERT_FALSE(enclosure_is_finite(enclosure_sine(bad)));
            TEST_ASSERT_FALSE(enclosure_is_finite(enclosure_cosine(bad)));
            TEST_ASSERT_FALSE(enclosure_is_finite(enclosure_root(bad)));
            TEST_ASSERT_FALSE(enclosure_is_finite(enclosure_exp(bad)));
            TEST_ASSERT_FALSE(enclosure_is_finite(enclosure_log(bad)));
        }
    }
}

static void test_sines(void) {
#ifdef QUAD_KNOWN
    for (unsigned i = 0; i < dice_cases(20000); i++) {
        const double middle = dice_one_of(&die, 2) == 0 ? dice_between(&die, -2.0, 2.0)
                                                        : dice_between(&die, -3e4, 3e4);
        const double radius =
            dice_one_of(&die, 2) == 0 ? 0.0 : pow(10.0, dice_between(&die, -16, 0.5));
        const enclosure a = {middle - radius, middle + radius};
        const double x = between(a);
        const enclosure sine = enclosure_sine(a);
        const enclosure cosine = enclosure_cosine(a);
        expect_holds("a sine", sine, quad_sine((quad)x));
        expect_holds("a cosine", cosine, quad_cosine((quad)x));
        TEST_ASSERT_TRUE(sine.high - sine.low <= 2.2 * (a.high - a.low) + 4e-15);
        TEST_ASSERT_TRUE(cosine.high - cosine.low <= 2.2 * (a.high - a.low) + 4e-15);
    }
#endif
}

/* For each function of the language, the interval of the result must contain the values at numbers within the
 * argument. A point must give a narrow interval. */
static void test_functions(void) {
    for (unsigned i = 0; i < dice_cases(usual_or(60000, 15000)); i++) {
        const function_id function = (function_id)(i % (unsigned)FUNCTIONS);
        static const double scales[] = {1.0, 0x1p-20, 0x1p7}; /* 2^7: exp() may overflow */
        const double scale = scales[dice_one_of(&die, 3)];
        enclosure a = drawn_enclosure();
        enclosure b = drawn_enclosure();
        a = (enclosure){scale * a.low, scale * a.high};
        b = (enclosure){scale * b.low, scale * b.high};
        const double x = between(a);
        const double y = between(b);
        const double value = number_call(function, x, y);
        const enclosure got = enclosure_call(function, a, b);
        const bool grows = function == FN_EXP || function == FN_SINH || function == FN_COSH;
        const bool large = (grows && fmax(function == FN_EXP ? a.high : -a.low, a.high) > 700.0) ||
                           function == FN_TAN;
        const bool open = large ? !enclosure_is_finite(got) : function == FN_LOG && isinf(value);
        char message[200];
        snprintf(message, sizeof message, "%s(%.17g, %.17g) = %.17g is not in [%.17g, %.17g]",
                 function_name(function), x, y, value, got.low, got.high);
        TEST_ASSERT_TRUE_MESSAGE(isnan(value) || open || enclosure_has(got, value), message);
        const enclosure point = enclosure_call(function, enclosure_of(x), enclosure_of(y));
        if (!isnan(value) && !large && enclosure_is_finite(point) && function != FN_SIGN &&
            function != FN_TAN && function != FN_SIN && function != FN_COS &&
            !(function == FN_ATAN2 && y <= 0.0 && x == 0.0)) {
            expect_narrow(function_name(function), point, 16.0);
        }
    }
    TEST_ASSERT_FALSE(enclosure_is_finite(
        enclosure_call(FN_MIN, enclosure_of(1.0), (enclosure){(double)NAN, (double)NAN})));
}

void suite_enclosure(void) {
    die = dice_of("enclosure", 15);
    RUN_TEST(test_four_operations);
    RUN_TEST(test_smallest_and_largest);
    RUN_TEST(test_whole_range);
    RUN_TEST(test_not_finite);
    RUN_TEST(test_sines);
    RUN_TEST(test_functions);
}

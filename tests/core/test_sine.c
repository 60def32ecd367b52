/* test_sine.c: sine and cosine together. The reference of the float build is in integers, which every board can
 * compute. That of the double build is the sine of the C library, if there is one. WH_TEST_SMALL takes fewer angles. */
#include "core/angle.h"

#include "tests/scattered.h"
#include "tests/suites.h"

#if __STDC_HOSTED__
#include <math.h>
#endif

#define QUARTER (UINT32_C(1) << 30)
#define SECTOR (UINT32_C(1) << 25) /* a sector of the sine table */

static wh_real sine_of(wh_phase phase) {
    wh_real s;
    wh_real c;
    wh_sincos(phase, &s, &c);
    return s;
}

static wh_real cosine_of(wh_phase phase) {
    wh_real s;
    wh_real c;
    wh_sincos(phase, &s, &c);
    return c;
}

#if __STDC_HOSTED__
static void test_table_is_nearest(void) {
    for (unsigned i = 0; i < 160; i++) {
        const long double exact = sinl(i * (6.283185307179586476925286766559L / 128.0L));
        const wh_real wanted = i % 64 == 0 ? WH_R(0.0) : (wh_real)exact;
        TEST_ASSERT_TRUE_MESSAGE(wh_sine_table[i] == wanted, "sine table");
    }
}
#endif

#if WH_DOUBLE

static bool is_nan(double value) { return value != value; }

static bool near(double got, double wanted, double tolerance) {
    return WH_ABS(got - wanted) <= tolerance;
}

#define PI 3.141592653589793

static void test_known_values(void) {
    TEST_ASSERT_TRUE(sine_of(0.0) == 0.0);
    TEST_ASSERT_TRUE(cosine_of(0.0) == 1.0);
    TEST_ASSERT_TRUE(sine_of(PI / 2.0) == 1.0);
    TEST_ASSERT_TRUE(cosine_of(PI) == -1.0);
    TEST_ASSERT_TRUE(sine_of(-PI / 2.0) == -1.0);
    /* the constant PI is not exactly pi */
    TEST_ASSERT_TRUE(near(sine_of(PI), 1.2246467991473532e-16, 1e-27));
    TEST_ASSERT_TRUE(near(cosine_of(PI / 2.0), 6.123233995736766e-17, 1e-27));
    TEST_ASSERT_TRUE(near(sine_of(PI / 6.0), 0.5, 2.3e-16));
    TEST_ASSERT_TRUE(near(cosine_of(PI / 3.0), 0.5, 2.3e-16));
    TEST_ASSERT_TRUE(near(sine_of(PI / 4.0), 0.70710678118654752, 2.3e-16));
    TEST_ASSERT_TRUE(near(sine_of(1.0), 0.84147098480789651, 2.3e-16));
    TEST_ASSERT_TRUE(near(cosine_of(1.0), 0.54030230586813972, 2.3e-16));
    TEST_ASSERT_TRUE(near(sine_of(1e8), 0.93163902710972601, 2.3e-16));
    TEST_ASSERT_TRUE(near(cosine_of(-1e8), -0.36338508935569055, 2.3e-16));
}

static void test_small_angles_keep_their_digits(void) {
    for (double angle = 1e-4; angle > 1e-300; angle *= 0.37) {
        const double series = angle - angle * angle * angle / 6.0;
        TEST_ASSERT_TRUE(near(sine_of(angle), series, 2.3e-16 * angle));
    }
}

static void test_unit_circle_and_symmetry(void) {
    scattered_state = 1;
    for (unsigned i = 0; i < 100000; i++) {
        const double angle = (double)(int64_t)scattered() * (5e8 / 9223372036854775808.0);
        double s;
        double c;
        wh_sincos(angle, &s, &c);
        TEST_ASSERT_TRUE(near(s * s + c * c, 1.0, 6e-16));
        TEST_ASSERT_TRUE(sine_of(-angle) == -s);
        TEST_ASSERT_TRUE(cosine_of(-angle) == c);
        TEST_ASSERT_TRUE(WH_ABS(s) <= 1.0 && WH_ABS(c) <= 1.0);
    }
}

static void test_out_of_range_is_nan(void) {
    const double bad[] = {5.000001e8,      -5.000001e8,      1e300,
                          __builtin_inf(), -__builtin_inf(), __builtin_nan("")};
    for (unsigned i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        TEST_ASSERT_TRUE(is_nan(sine_of(bad[i])));
        TEST_ASSERT_TRUE(is_nan(cosine_of(bad[i])));
    }
    TEST_ASSERT_FALSE(is_nan(sine_of(5e8)));
    double sine = 0.5;
    double cosine = 0.25;
    /* Only float needs this check, because its phase cannot represent such numbers. */
    wh_sincos_of_range(1e300, &sine, &cosine);
    TEST_ASSERT_TRUE(sine == 0.5 && cosine == 0.25);
}

#if __STDC_HOSTED__
static void test_against_libm(void) {
    const double reach[] = {1e-2, 0.8, 6.4, 1e2, 1e4, 1e6, 5e8};
    scattered_state = 2;
    double worst = 0.0;
    for (unsigned i = 0; i < 700000; i++) {
        const double angle = (double)(int64_t)scattered() * (reach[i % 7] / 9223372036854775808.0);
        double s;
        double c;
        wh_sincos(angle, &s, &c);
        worst = fmax(worst, (double)fabsl((long double)s - sinl((long double)angle)));
        worst = fmax(worst, (double)fabsl((long double)c - cosl((long double)angle)));
    }
    TEST_ASSERT_DOUBLE_WITHIN(1.4e-16, 0.0, worst);
}
#endif

SUITE(sine) {
    RUN_TEST(test_known_values);
    RUN_TEST(test_small_angles_keep_their_digits);
    RUN_TEST(test_unit_circle_and_symmetry);
    RUN_TEST(test_out_of_range_is_nan);
#if __STDC_HOSTED__
    RUN_TEST(test_against_libm);
    RUN_TEST(test_table_is_nearest);
#endif
}

#else

/* --- a reference in integers --------------------------------------------------------------------
 * Numbers are in units of 2^-31. */
#define ONE (INT64_C(1) << 31)

static int64_t times(int64_t a, int64_t b) { return (a * b + (INT64_C(1) << 30)) >> 31; }

/* Taylor series about the nearest quarter turn, nested as 1 - z/(2*3)(1 - z/(4*5)(...)). The error is below 3e-9. */
static void reference(uint32_t phase, int64_t *sine, int64_t *cosine) {
    const uint32_t quarter = (phase + QUARTER / 2U) / QUARTER;
    const int32_t rest = (int32_t)(phase - quarter * QUARTER);
    const int64_t x = ((int64_t)rest * INT64_C(3373259426) + (INT64_C(1) << 29)) >> 30;
    const int64_t z = times(x, x);
    int64_t s = ONE;
    int64_t c = ONE;
    for (int64_t k = 6; k >= 1; k--) {
        s = ONE - times(z, s) / (2 * k * (2 * k + 1));
        c = ONE - times(z, c) / (2 * k * (2 * k - 1));
    }
    s = times(x, s);
    const int64_t turned_s[] = {s, c, -s, -c};
    *sine = turned_s[quarter & 3U];
    *cosine = turned_s[(quarter + 1U) & 3U];
}

/* Converts a float from -1 to 1 to units of 2^-31, truncated. */
static int64_t fixed(float value) { return (int64_t)(int32_t)(value * 0x1p30f) * 2; }

#define TOLERANCE 143 /* 6.285e-8, the sine's largest error, plus 4e-9 for the reference */

/* Returns the error of sine and cosine at `phase`, in units of 2^-31. */
static int64_t error_at(uint32_t phase) {
    float s;
    float c;
    wh_sincos(phase, &s, &c);
    if (!(WH_ABS(s) <= 1.0f && WH_ABS(c) <= 1.0f)) {
        return ONE;
    }
    int64_t sine;
    int64_t cosine;
    reference(phase, &sine, &cosine);
    const int64_t off[] = {fixed(s) - sine, sine - fixed(s), fixed(c) - cosine, cosine - fixed(c)};
    int64_t worst = 0;
    for (unsigned i = 0; i < 4; i++) {
        worst = off[i] > worst ? off[i] : worst;
    }
    return worst;
}

static void expect_good(uint32_t first, uint32_t step, uint32_t many) {
    int64_t worst = 0;
    for (uint32_t i = 0; i < many; i++) {
        const int64_t error = error_at(first + i * step);
        worst = error > worst ? error : worst;
    }
    TEST_ASSERT_LESS_OR_EQUAL_INT64(TOLERANCE, worst);
}

static void test_known_values(void) {
    TEST_ASSERT_TRUE(sine_of(0) == 0.0f);
    TEST_ASSERT_TRUE(cosine_of(0) == 1.0f);
    TEST_ASSERT_TRUE(sine_of(QUARTER) == 1.0f);
    TEST_ASSERT_TRUE(cosine_of(QUARTER) == 0.0f);
    TEST_ASSERT_TRUE(sine_of(2 * QUARTER) == 0.0f);
    TEST_ASSERT_TRUE(cosine_of(2 * QUARTER) == -1.0f);
    TEST_ASSERT_TRUE(sine_of(3 * QUARTER) == -1.0f);
    TEST_ASSERT_TRUE(cosine_of(3 * QUARTER) == 0.0f);
    TEST_ASSERT_TRUE(sine_of(QUARTER / 2) == 0.707106781f);
    TEST_ASSERT_TRUE(cosine_of(QUARTER / 2) == 0.707106781f);
    CHECK_NEAR(6.3e-8f, 0.5f, sine_of(QUARTER / 3));
    CHECK_NEAR(6.3e-8f, 0.866025404f, cosine_of(QUARTER / 3));
    CHECK_NEAR(6.3e-8f, 0.1f, sine_of(68470971)); /* asin 0.1, in phase units */
}

static void test_smallest_angles(void) {
    /* One phase unit is 1.4629e-9 rad; its sine is precise to the last digit. */
    CHECK_NEAR(1e-16f, 1.46291808e-9f, sine_of(1));
    CHECK_NEAR(1e-16f, -1.46291808e-9f, sine_of(UINT32_MAX));
    TEST_ASSERT_TRUE(cosine_of(1) == 1.0f);
}

static void test_round_the_turn(void) {
    const uint32_t many = WH_TEST_SMALL ? 5000 : 400000;
    expect_good(12345, UINT32_MAX / many, many);
}

static void test_about_quarters_and_sectors(void) {
    const uint32_t many = WH_TEST_SMALL ? 20 : 4000;
    for (uint32_t eighth = 0; eighth < 8; eighth++) {
        expect_good(eighth * (QUARTER / 2) - many / 2, 1, many);
    }
    const uint32_t few = WH_TEST_SMALL ? 4 : 400;
    for (uint32_t half = 0; half < 256; half++) { /* middles and edges of sectors */
        expect_good(half * (SECTOR / 2) - few / 2, 1, few);
    }
}

static void test_worst_found(void) {
    /* The phases with the largest errors, from tests/tools/functions_exhaustive.c. */
    expect_good(UINT32_C(0x48ffebe7), 1, 1);
    expect_good(UINT32_C(0x08ffebe7), 1, 1);
    TEST_ASSERT_GREATER_THAN_INT64(125, error_at(UINT32_C(0x48ffebe7)));
}

static void test_unit_circle_and_symmetry(void) {
    const uint32_t many = WH_TEST_SMALL ? 3000 : 200000;
    scattered_state = 3;
    for (uint32_t i = 0; i < many; i++) {
        const uint32_t phase = (uint32_t)(scattered() >> 16);
        float s;
        float c;
        wh_sincos(phase, &s, &c);
        TEST_ASSERT_TRUE(WH_ABS(s * s + c * c - 1.0f) <= 2.4e-7f);
        /* A quarter turn later the bits are the same. So are the mirrored ones, except at the edge of two sectors. */
        TEST_ASSERT_TRUE(sine_of(phase + QUARTER) == c);
        TEST_ASSERT_TRUE(cosine_of(phase + QUARTER) == -s);
        if (phase % SECTOR != SECTOR / 2) {
            TEST_ASSERT_TRUE(sine_of(0U - phase) == -s);
            TEST_ASSERT_TRUE(cosine_of(0U - phase) == c);
        }
    }
}

SUITE(sine) {
    RUN_TEST(test_known_values);
    RUN_TEST(test_smallest_angles);
    RUN_TEST(test_round_the_turn);
    RUN_TEST(test_about_quarters_and_sectors);
    RUN_TEST(test_worst_found);
    RUN_TEST(test_unit_circle_and_symmetry);
#if __STDC_HOSTED__
    RUN_TEST(test_table_is_nearest);
#endif
}

#endif

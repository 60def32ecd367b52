/* test_angle.c: moving angles, and conversion to and from radians. WH_TEST_SMALL: fewer angles. */
#include "core/angle.h"

#include "tests/scattered.h"
#include "tests/suites.h"

#if __STDC_HOSTED__
#include <math.h>
#endif

#if WH_DOUBLE

static void test_radians_are_kept(void) {
    TEST_ASSERT_TRUE(wh_angle_from_rad(123.456) == 123.456);
    TEST_ASSERT_TRUE(wh_angle_to_rad(-123.456) == -123.456);
    TEST_ASSERT_TRUE(wh_phase_from_rad(7.0) == 7.0);
    TEST_ASSERT_TRUE(wh_phase_of(7.0) == 7.0);
}

static void test_parts_of_angles(void) {
    TEST_ASSERT_TRUE(wh_phase_times(7.0, WH_FACTOR(1.5, 1U, 0U)) == 10.5);
    TEST_ASSERT_TRUE(wh_phase_times(-7.0, WH_FACTOR(0.5, 0U, 0U)) == -3.5);
}

static void test_phase_moves(void) {
    wh_phase moved = 0.0;
    TEST_ASSERT_TRUE(wh_phase_move(1.0, -2.5, &moved) && moved == -1.5);
    TEST_ASSERT_TRUE(wh_phase_move(1e6, 3.0, &moved) && moved == 1000003.0);
    const double bad[] = {WH_PHASE_STEP_MAX, -4.0, 1e300, __builtin_nan("")};
    for (unsigned i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        TEST_ASSERT_FALSE(wh_phase_move(1.0, bad[i], &moved));
        TEST_ASSERT_TRUE(moved == 1000003.0);
    }
}

SUITE(angle) {
    RUN_TEST(test_phase_moves);
    RUN_TEST(test_radians_are_kept);
    RUN_TEST(test_parts_of_angles);
}

#else

#define QUARTER (UINT32_C(1) << 30)

static void test_phase_moves(void) {
    wh_phase moved = 0;
    TEST_ASSERT_TRUE(wh_phase_move(0, 2147483392.0f, &moved));
    TEST_ASSERT_EQUAL_UINT32(2147483392, moved);
    const float bad[] = {WH_PHASE_STEP_MAX, -2147483648.0f, 1e30f, __builtin_nanf("")};
    for (unsigned i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        TEST_ASSERT_FALSE(wh_phase_move(QUARTER, bad[i], &moved));
        TEST_ASSERT_EQUAL_UINT32(2147483392, moved);
    }
}

/* The reference is in integers. Ties round to even in wh_phase_move(), away from zero in wh_phase_move_half(). */
static void test_phase_moves_to_the_nearest(void) {
    scattered_state = 9;
    unsigned ties = 0;
    for (unsigned i = 0; i < 20000; i++) {
        const uint32_t digits = (uint32_t)(scattered() & 0xffffffU);
        const int down = (int)(scattered() % 32U) - 7; /* the move: digits / 2^down steps */
        float steps = (float)digits;
        for (int k = 0; k < down; k++) {
            steps *= 0.5f;
        }
        for (int k = down; k < 0; k++) {
            steps *= 2.0f;
        }
        const uint32_t away =
            down > 0 ? (digits + (UINT32_C(1) << (down - 1))) >> down : digits << (unsigned)-down;
        const bool tie = down > 0 && (digits << (32 - down)) == UINT32_C(1) << 31;
        const uint32_t whole = tie ? away & ~UINT32_C(1) : away;
        ties += tie;
        wh_phase moved = 0;
        TEST_ASSERT_EQUAL(steps < WH_PHASE_STEP_MAX, wh_phase_move(QUARTER, steps, &moved));
        TEST_ASSERT_EQUAL_UINT32(steps < WH_PHASE_STEP_MAX ? QUARTER + whole : 0, moved);
        moved = 0;
        TEST_ASSERT_EQUAL(steps < WH_PHASE_STEP_MAX, wh_phase_move(QUARTER, -steps, &moved));
        TEST_ASSERT_EQUAL_UINT32(steps < WH_PHASE_STEP_MAX ? QUARTER - whole : 0, moved);
        if (2.0f * steps < WH_PHASE_STEP_MAX) {
            TEST_ASSERT_TRUE(wh_phase_move_half(QUARTER, 2.0f * steps, &moved));
            TEST_ASSERT_EQUAL_UINT32(QUARTER + away, moved);
            TEST_ASSERT_TRUE(wh_phase_move_half(QUARTER, -2.0f * steps, &moved));
            TEST_ASSERT_EQUAL_UINT32(QUARTER - away, moved);
        } else {
            TEST_ASSERT_FALSE(wh_phase_move_half(QUARTER, 2.0f * steps, &moved));
        }
    }
    TEST_ASSERT_TRUE(ties > 300);
}

static void test_phase_of_angle(void) {
    TEST_ASSERT_EQUAL_UINT32(QUARTER, wh_phase_of((INT64_C(1000) << 32) + QUARTER));
    TEST_ASSERT_EQUAL_UINT32(3 * QUARTER, wh_phase_of(-(int64_t)QUARTER));
}

/* Returns rad * 2^32/(2 pi), rounded, from the float's own bits: an 86-bit product. */
static int64_t angle_reference(float rad) {
    const union {
        float value;
        uint32_t bits;
    } word = {.value = rad};
    const uint64_t digits = (word.bits & 0x7fffffU) | 0x800000U;
    const int exponent = (int)((word.bits >> 23) & 0xffU) - 150; /* |rad| = digits 2^exponent */
    const uint64_t high = digits * UINT64_C(683565275);
    const uint64_t low = digits * UINT64_C(2475754827); /* 0.576431589782 * 2^32 */
    uint64_t size = 0;
    if (exponent > 0) {
        size = (high << exponent) + (low >> (32 - exponent));
    } else if (exponent > -60) {
        const uint64_t all = high + (low >> 32);
        size = exponent == 0 ? all : (all + (UINT64_C(1) << (-exponent - 1))) >> -exponent;
    }
    return rad < 0.0f ? -(int64_t)size : (int64_t)size;
}

static void expect_from_rad(float rad) {
    const int64_t wanted = angle_reference(rad);
    const int64_t angle = wh_angle_from_rad(rad);
    TEST_ASSERT_INT64_WITHIN(1, wanted, angle);
    TEST_ASSERT_EQUAL_UINT32(wh_phase_of(angle), wh_phase_from_rad(rad));
}

static void test_angle_from_rad(void) {
    TEST_ASSERT_EQUAL_INT64(0, wh_angle_from_rad(0.0f));
    const uint32_t many = WH_TEST_SMALL ? 2000 : 200000;
    const float reach[] = {1e-6f, 1e-2f, 1.0f, 6.3f, 100.0f, 1e4f, 1e6f, 9.9e8f};
    scattered_state = 4;
    for (uint32_t i = 0; i < many; i++) {
        const float fraction = (float)(int32_t)(uint32_t)(scattered() >> 20) * 0x1p-31f;
        expect_from_rad(fraction * reach[i % 8]);
    }
}

static void test_angle_from_rad_out_of_range(void) {
    const float bad[] = {
        1e9f, -1e9f, 1e30f, __builtin_inff(), -__builtin_inff(), __builtin_nanf("")};
    for (unsigned i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        TEST_ASSERT_EQUAL_INT64(0, wh_angle_from_rad(bad[i]));
        TEST_ASSERT_EQUAL_UINT32(0, wh_phase_from_rad(bad[i]));
    }
    expect_from_rad(999999936.0f); /* the largest float in range */
    expect_from_rad(-999999936.0f);
    /* out of range: the phase is invalid, so sines are NaN */
    for (unsigned i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        wh_real sine = 0.5f;
        wh_real cosine = 0.5f;
        wh_sincos_of_range(bad[i], &sine, &cosine);
        TEST_ASSERT_TRUE(sine != sine && cosine != cosine);
    }
    wh_real sine = 0.5f;
    wh_real cosine = 0.25f;
    wh_sincos_of_range(9.9e8f, &sine, &cosine);
    TEST_ASSERT_TRUE(sine == 0.5f && cosine == 0.25f);
}

static void test_angle_to_rad(void) {
    const int64_t turn = INT64_C(1) << 32;
    TEST_ASSERT_TRUE(wh_angle_to_rad(0) == 0.0f);
    TEST_ASSERT_TRUE(wh_angle_to_rad(1) == 1.46291808e-9f);
    TEST_ASSERT_TRUE(wh_angle_to_rad(-1) == -1.46291808e-9f);
    TEST_ASSERT_TRUE(wh_angle_to_rad(turn) == 6.28318531f);
    TEST_ASSERT_TRUE(wh_angle_to_rad(-turn / 4) == -1.57079633f);
    TEST_ASSERT_TRUE(wh_angle_to_rad(1000 * turn + turn / 4) == 6284.75610f);
    TEST_ASSERT_TRUE(wh_angle_to_rad(1000000 * turn + turn / 2) == 6283188.45f);
    TEST_ASSERT_TRUE(wh_angle_to_rad(INT64_MAX) == 13493037705.0f);
    TEST_ASSERT_TRUE(wh_angle_to_rad(INT64_MIN) == -13493037705.0f);
}

static void test_there_and_back(void) {
    /* The float of an angle, converted back, is within half a unit of the float's last place. */
    const uint32_t many = WH_TEST_SMALL ? 2000 : 200000;
    scattered_state = 5;
    for (uint32_t i = 0; i < many; i++) {
        const int64_t angle = (int64_t)scattered() >> (7U + i % 50U); /* up to 9e8 rad */
        const float rad = wh_angle_to_rad(angle);
        const int64_t back = wh_angle_from_rad(rad);
        const uint64_t size = (uint64_t)(angle < 0 ? -angle : angle);
        /* Half a unit in the last place is at most 2^-24 of the number. */
        TEST_ASSERT_INT64_WITHIN(1 + (size >> 24), angle, back);
    }
}

/* Reference for wh_phase_times(): bits 0 to 31 before the point of angle * factor, rounded. The 128-bit product is
 * added up bit by bit. */
static uint32_t times_reference(int64_t angle, wh_factor factor) {
    uint64_t shifted_high = angle < 0 ? UINT64_MAX : 0U;
    uint64_t shifted_low = (uint64_t)angle;
    uint64_t high = 0;
    uint64_t low = UINT64_C(1) << 63;
    for (unsigned k = 0; k < 64; k++) {
        if (factor.part >> k & 1U) {
            low += shifted_low;
            high += shifted_high + (low < shifted_low ? 1U : 0U);
        }
        shifted_high = shifted_high << 1 | shifted_low >> 63;
        shifted_low <<= 1;
    }
    for (uint32_t i = 0; i < 32; i++) {
        high += factor.whole >> i & 1U ? (uint64_t)angle << i : 0U;
    }
    return (uint32_t)high;
}

static void test_parts_of_angles(void) {
    const wh_factor less = WH_FACTOR(-0.5, UINT32_MAX, UINT64_C(1) << 63);
    TEST_ASSERT_EQUAL_UINT32(3 * QUARTER, wh_phase_times(INT64_C(1) << 31, less));
    const uint32_t many = WH_TEST_SMALL ? 500 : 100000;
    scattered_state = 8;
    for (uint32_t i = 0; i < many; i++) {
        const int64_t angle = (int64_t)scattered() >> (i % 63U);
        const wh_factor factor = {.part = scattered(), .whole = (uint32_t)scattered()};
        TEST_ASSERT_EQUAL_UINT32(times_reference(angle, factor), wh_phase_times(angle, factor));
    }
}

#if __STDC_HOSTED__
static void test_to_rad_is_nearest(void) {
    scattered_state = 7;
    for (unsigned i = 0; i < 200000; i++) {
        const int64_t angle = (int64_t)scattered() >> (i % 63U);
        const long double exact =
            (long double)angle * (6.283185307179586476925286766559L / 4294967296.0L);
        const float rad = wh_angle_to_rad(angle);
        const long double unit =
            (long double)nextafterf(fabsf(rad), INFINITY) - (long double)fabsf(rad);
        TEST_ASSERT_TRUE(fabsl((long double)rad - exact) <= 0.504L * unit);
    }
}
#endif

SUITE(angle) {
    RUN_TEST(test_phase_moves);
    RUN_TEST(test_phase_moves_to_the_nearest);
    RUN_TEST(test_phase_of_angle);
    RUN_TEST(test_angle_from_rad);
    RUN_TEST(test_angle_from_rad_out_of_range);
    RUN_TEST(test_angle_to_rad);
    RUN_TEST(test_there_and_back);
    RUN_TEST(test_parts_of_angles);
#if __STDC_HOSTED__
    RUN_TEST(test_to_rad_is_nearest);
#endif
}

#endif

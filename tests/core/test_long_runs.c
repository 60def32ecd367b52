/* test_long_runs.c: counts and times in runs of years: no count overflows, and a time has only one rounding error. */
#include "core/angle.h"
#include "core/number/sum.h"
#include "core/rig/speed.h"
#include "hand.h"

#include "tests/suites.h"

typedef struct wide {
    uint64_t high, low;
} wide;

static wide product(uint64_t a, uint64_t b) {
    const uint64_t mask = UINT32_MAX;
    const uint64_t low = (a & mask) * (b & mask);
    const uint64_t one = (a >> 32) * (b & mask) + (low >> 32);
    const uint64_t two = (a & mask) * (b >> 32) + (one & mask);
    return (wide){(a >> 32) * (b >> 32) + (one >> 32) + (two >> 32), two << 32 | (low & mask)};
}

static wide twice(wide a) { return (wide){a.high << 1 | a.low >> 63, a.low << 1}; }

static bool less(wide a, wide b) { return a.high < b.high || (a.high == b.high && a.low < b.low); }

static wide difference(wide a, wide b) {
    return less(a, b) ? difference(b, a) : (wide){a.high - b.high - (a.low < b.low), a.low - b.low};
}

/* Returns the quotient's low 64 bits, computed bit by bit. *rest gets the remainder. (Boards have no integers of 128
 * bits.) */
static uint64_t quotient(wide a, uint64_t by, uint64_t *rest) {
    uint64_t result = 0;
    *rest = 0;
    for (unsigned i = 0; i < 128; i++) {
        *rest = *rest << 1 | a.high >> 63; /* `by` is below 2^63 */
        a = twice(a);
        result <<= 1;
        if (*rest >= by) {
            *rest -= by;
            result |= 1U;
        }
    }
    return result;
}

#define DIGITS (sizeof(wh_real) == sizeof(float) ? 24 : 53)

/* True if `value`, in [0, 1), is the real nearest to part / of, with part < of < 2^30. */
static bool is_nearest(wh_real value, uint64_t part, uint64_t of) {
    int places = 0; /* value = digits / 2^places; `digits` has all digits of a real */
    if (part == 0 || !(value > WH_R(0.0))) {
        return part == 0 && value == WH_R(0.0);
    }
    while (value < (wh_real)(UINT64_C(1) << (DIGITS - 1))) {
        value *= WH_R(2.0);
        places++;
    }
    /* `value` is nearest if digits times `of` differs from part 2^places by at most half of `of`. */
    wide exact = {0, part};
    for (int i = 0; i < places; i++) {
        exact = twice(exact);
    }
    const wide off = difference(exact, product((uint64_t)value, of));
    return !less((wide){0, of}, twice(off));
}

static uint64_t random_state;

static uint64_t random_bits(void) { /* xorshift64 (Marsaglia, 2003) */
    random_state ^= random_state << 13;
    random_state ^= random_state >> 7;
    random_state ^= random_state << 17;
    return random_state;
}

/* True if the time of step `steps` is right. Beyond 2^64 s it is undefined. */
static bool time_is_right(wh_fraction step, uint64_t steps) {
    const wh_scene scene = {.step_s = (wh_real)step.numerator / (wh_real)step.denominator,
                            .step = step};
    const wh_state state = {.steps = steps};
    const wide all = product(steps, step.numerator);
    if (all.high >= step.denominator) {
        return true;
    }
    uint64_t rest;
    const uint64_t whole = quotient(all, step.denominator, &rest);
    const wh_time time = wh_scene_time(&scene, &state);
    if (time.whole_s == whole + 1) { /* the nearest real to the fraction is one */
        const wide left = product(step.denominator - rest, UINT64_C(2) << DIGITS);
        return time.fraction_s == WH_R(0.0) && !less((wide){0, step.denominator}, left);
    }
    return time.whole_s == whole &&
           (step.denominator >> 30 != 0 || is_nearest(time.fraction_s, rest, step.denominator));
}

TEST(long_runs, times_are_right_to_one_rounding) {
    static const wh_fraction known[] = {
        {1, 1000},      {1, 1000000},  {1, 1000000000},     {1, 3},         {11, 10000},
        {1, 44100},     {1001, 30000}, {3600, 1},           {1, 1U << 10U}, {999, 1000},
        {1, 536870911}, {7, 5},        {123457, 1UL << 29U}};
    static const uint64_t near[] = {0,
                                    UINT64_C(1) << 24,
                                    UINT64_C(1) << 32,
                                    UINT64_C(1) << 53,
                                    UINT64_C(1) << 63,
                                    UINT64_C(1577880000000)}; /* 50 years of milliseconds */
    const unsigned each = __STDC_HOSTED__ ? 200 : 4;
    random_state = UINT64_C(0x20261121);
    for (unsigned i = 0; i < 3 * sizeof known / sizeof known[0]; i++) {
        wh_fraction step = {random_bits() % 1000000 + 1, random_bits() % 1000000000 + 1};
        if (i % 3 == 0) { /* a count of any size */
            step.numerator = (random_bits() >> random_bits() % 63 >> 4) + 1;
            step.denominator = (random_bits() >> random_bits() % 63 >> 4) + 1;
        }
        step = i < sizeof known / sizeof known[0] ? known[i] : step;
        for (unsigned k = 0; k < sizeof near / sizeof near[0]; k++) {
            for (unsigned j = 0; j < each; j++) {
                const uint64_t off = j < 3 ? j : random_bits() % 100000;
                TEST_ASSERT_TRUE(time_is_right(step, near[k] + off));
                TEST_ASSERT_TRUE(near[k] < off || time_is_right(step, near[k] - off));
            }
        }
        for (unsigned j = 0; j < each; j++) {
            TEST_ASSERT_TRUE(time_is_right(step, random_bits() >> random_bits() % 64));
        }
    }
}

/* A fraction that rounds to one becomes the next second; all others stay below one. */
TEST(long_runs, a_fraction_stays_below_one) {
    const uint64_t in = UINT64_C(1) << 60;
    wh_scene scene = {.step_s = WH_R(1.0), .step = {1, in}};
    wh_state state = {.steps = in - 1};
    wh_time time = wh_scene_time(&scene, &state);
    TEST_ASSERT_TRUE(time.whole_s == 1 && time.fraction_s == WH_R(0.0));
    state.steps = in - (in >> 20);
    time = wh_scene_time(&scene, &state);
    TEST_ASSERT_TRUE(time.whole_s == 0 && time.fraction_s == WH_R(1.0) - WH_R(0x1p-20));
    state.steps = 1;
    time = wh_scene_time(&scene, &state);
    TEST_ASSERT_TRUE(time.whole_s == 0 && time.fraction_s == WH_R(0x1p-60));
}

/* If a scene has no exact step, its time is that of its real step. With steps of 2^k s the product is exact below 2^56
 * s: whole seconds and fraction are its bits before and after the point. */
TEST(long_runs, time_without_a_fraction) {
    random_state = UINT64_C(0x20261123);
    for (int k = -20; k <= 33; k++) {
        wh_scene scene = {.step_s = WH_R(1.0)};
        for (int i = 0; i < (k < 0 ? -k : k); i++) {
            scene.step_s *= k < 0 ? WH_R(0.5) : WH_R(2.0);
        }
        for (unsigned i = 0; i < 24; i++) {
            const uint64_t steps = i < 2 ? (UINT64_C(1) << 22) - i : random_bits() >> 42 >> i % 22;
            const wh_state state = {.steps = steps};
            const wh_time time = wh_scene_time(&scene, &state);
            const uint64_t whole = k < 0 ? steps >> -k : steps << k;
            const uint64_t below = k < 0 ? steps - (whole << -k) : 0U;
            TEST_ASSERT_TRUE(time.whole_s == whole);
            TEST_ASSERT_TRUE(time.fraction_s == (wh_real)below * scene.step_s);
        }
    }
    const wh_scene scene = {.step_s = WH_R(0x1p55)};
    const wh_state state = {.steps = 2};
    TEST_ASSERT_TRUE(wh_scene_time(&scene, &state).whole_s >= (uint64_t)UINT32_MAX << 24);
}

TEST(long_runs, steps_do_not_wrap) {
    hand_build_ball(WH_R(0.5));
    hand_start(false);
    hand_now.scene.step = (wh_fraction){1, 1000};
    hand_now.scene.steps = (UINT64_C(1) << 32) + 5;
    hand_state.steps = UINT32_MAX;
    while (hand_state.steps < hand_now.scene.steps) {
        hand_steps(1);
    }
    TEST_ASSERT_TRUE(hand_state.steps == (UINT64_C(1) << 32) + 5);
    const wh_time time = wh_scene_time(&hand_now.scene, &hand_state);
    TEST_ASSERT_TRUE(time.whole_s == 4294967 && is_nearest(time.fraction_s, 301, 1000));
}

/* Two stops one micrometre apart and a fast body: every step overruns. */
TEST(long_runs, events_and_overruns_do_not_wrap) {
    hand_build(1, WH_R(1.0), WH_R(0.0), WH_R(1.0));
    hand_add(WH_STOP, 0, WH_R(1.0), WH_R(0.0), WH_R(0.0), WH_R(1.0), WH_R(0.0));
    hand_add(WH_STOP, 0, WH_R(-1.0), WH_R(0.0), WH_R(-1e-6), WH_R(1.0), WH_R(0.0));
    hand_now.start[0] = WH_R(5e-7);
    hand_now.start[1] = WH_R(1.0);
    hand_start(false);
    hand_state.contacts->events = UINT32_MAX;
    hand_state.contacts->overruns = UINT32_MAX;
    hand_steps(1);
    TEST_ASSERT_TRUE(hand_state.contacts->overruns == UINT64_C(1) << 32);
    TEST_ASSERT_TRUE(hand_state.contacts->events >= (uint64_t)UINT32_MAX + WH_EVENTS_MAX);
}

#if !WH_DOUBLE
/* The count of turns wraps at 2^31, in whole turns, and the phase goes on. */
static void test_turns_wrap_and_the_phase_goes_on(void) {
    wh_angle angle = INT64_MAX - 100;
    wh_real carry = 0.0f;
    const wh_phase before = wh_phase_of(angle);
    wh_angle_move(&angle, 1000.0f, false, &carry);
    TEST_ASSERT_TRUE(wh_phase_of(angle) == before + 1000U);
    TEST_ASSERT_TRUE(angle == INT64_MIN + 899);
    wh_angle_move(&angle, -1000.0f, false, &carry);
    TEST_ASSERT_TRUE(angle == INT64_MAX - 100);
}
#endif

/* Sums of the ledger after 50 years of 1 ms steps (1.6e12 entries of one size): another hundred thousand entries still
 * change the sum. */
TEST(long_runs, sums_of_years_do_not_stall) {
    static const wh_real each[] = {WH_R(1.0), WH_R(-3e-7), WH_R(0.0123), WH_R(7.7e9), WH_R(-1e-20)};
    const wh_real years = WH_R(1.57788e12);
    for (unsigned i = 0; i < sizeof each / sizeof each[0]; i++) {
        const wh_real begin = each[i] * years;
        wh_real sum = begin;
        wh_real carry = WH_R(0.0);
        for (unsigned long k = 0; k < 100000UL; k++) {
            sum = wh_sum(sum, each[i], true, &carry);
        }
        const wh_real parts = ((sum - begin) + carry) / each[i];
        TEST_ASSERT_TRUE(parts > WH_R(99000.0) && parts < WH_R(101000.0));
    }
}

/* Quarter turns and pulses wrap after 2^32, six years at 330 rpm, and capture ticks after 71.6 minutes. After the wraps
 * the speed is right, no pulse counts as lost, and positions are right. */
TEST(long_runs, the_count_of_quarters_wraps) {
    static wh_speed speed;
    const uint32_t quarter_ticks = 45454U;
    uint32_t ticks = UINT32_MAX - 20U * quarter_ticks;
    wh_speed_start(&speed, WH_R(1e3));
    for (uint32_t k = 0; k < 60U; k++) {
        if (k == 8U) { /* years later at the same sensor, after a whole number of turns */
            const uint32_t on = (UINT32_MAX - 15U) - (speed.quarter & ~UINT32_C(3));
            speed.quarter += on;
            speed.seen_quarter[0] += on;
            speed.seen_quarter[1] += on;
            speed.taken = UINT32_MAX - 5U;
        }
        if (k % 4U <= 1U) { /* the slots are a quarter of a turn apart */
            TEST_ASSERT_TRUE(wh_speed_pulse(&speed, k % 4U, ticks));
            TEST_ASSERT_TRUE(speed.quarter % 4U == k % 4U);
        }
        if (k > 5U) {
            const wh_real wanted = WH_R(6.2831853) / (WH_R(4e-6) * (wh_real)quarter_ticks);
            TEST_ASSERT_TRUE(speed.known);
            TEST_ASSERT_TRUE(WH_ABS(speed.turn_radps - wanted) < WH_R(1e-4) * wanted);
        }
        ticks += quarter_ticks;
    }
    TEST_ASSERT_TRUE(speed.lost == 0 && speed.rejected == 0 && speed.restarts == 0);
    TEST_ASSERT_TRUE(speed.quarter < 100U && speed.taken < 100U); /* both counts have wrapped */
}

SUITE(long_runs) {
#if !WH_DOUBLE
    RUN_TEST(test_turns_wrap_and_the_phase_goes_on);
#endif
}

/* test_lockin.c: amplitude and phase of made-up loads whose answer is known. */
#include "core/angle.h"
#include "core/rig/datasheet.h"
#include "core/rig/lockin.h"

#include "unity.h"

void suite_lockin(void);

#define SAMPLES 1000U
#define PERIOD_TICKS UINT32_C(2000) /* an AVR's unsigned has 16 bits */
#define MARKS 12U
#define TURN_TICKS 181818U /* 330 rpm */
#define DEG WH_R(0.017453292519943295)
#define PI WH_R(3.141592653589793)

static int16_t raw[SAMPLES];
static wh_mark marks[MARKS];

static wh_real cosine_of(wh_real rad) {
    wh_real sine;
    wh_real cosine;
    wh_sincos(wh_phase_from_rad(rad), &sine, &cosine);
    return cosine;
}

static uint32_t late = 77;

/* The load mean + amplitude cos(order (theta - mark) + phase), the mark at each turn's begin. The
 * first turn begins `late` ticks after the record, whose first sample is at first_ticks. */
static wh_load_record made_up(uint32_t first_ticks, unsigned order, wh_real mean, wh_real amplitude,
                              wh_real phase_rad) {
    const wh_load_record record = {raw, SAMPLES, first_ticks, PERIOD_TICKS};
    for (unsigned i = 0; i < MARKS; i++) {
        /* the count of quarters wraps on the way, as it may */
        marks[i] = (wh_mark){first_ticks + late + i * TURN_TICKS, UINT32_MAX - 15U + 4U * i};
    }
    for (unsigned i = 0; i < SAMPLES; i++) {
        const wh_real turns = ((wh_real)(i * PERIOD_TICKS) - (wh_real)late) / (wh_real)TURN_TICKS;
        const wh_real part = turns - (wh_real)(int32_t)turns;
        const wh_real load =
            mean + amplitude * cosine_of((wh_real)order * WH_RIG_TWO_PI * part + phase_rad);
        raw[i] = (int16_t)(load + (load < WH_R(0.0) ? WH_R(-0.5) : WH_R(0.5)));
    }
    return record;
}

static void test_known_phase_and_amplitude_are_found(void) {
    static const wh_real degrees[] = {WH_R(0.0), WH_R(30.0), WH_R(-30.0), WH_R(90.0), WH_R(170.0)};
    for (unsigned i = 0; i < 5U * 4U; i++) {
        const wh_real wanted = degrees[i % 5U];
        late = 77U + (i / 5U) * 600U; /* where the turn begins between two samples */
        const wh_load_record record = made_up(0, 1, WH_R(8000.0), WH_R(6000.0), wanted * DEG);
        wh_lockin_result found;
        TEST_ASSERT_TRUE(wh_lockin(&record, marks, MARKS, WH_R(0.0), &found));
        TEST_ASSERT_EQUAL_UINT(10, found.turns);
        TEST_ASSERT_FLOAT_WITHIN(0.02f, (float)wanted, (float)(found.phase_rad / DEG));
        TEST_ASSERT_FLOAT_WITHIN(1.5f, 6000.0f, (float)found.amplitude_counts);
        TEST_ASSERT_FLOAT_WITHIN(1.5f, 8000.0f, (float)found.mean_counts);
        TEST_ASSERT_FLOAT_WITHIN(1e-6f, 0.181818f, (float)found.turn_s);
    }
    late = 77U;
}

/* A mark 5 degrees short of the sensor moves the phase by just that. */
static void test_angle_of_the_mark_counts(void) {
    const wh_load_record record = made_up(0, 1, WH_R(0.0), WH_R(6000.0), WH_R(30.0) * DEG);
    wh_lockin_result found;
    TEST_ASSERT_TRUE(wh_lockin(&record, marks, MARKS, WH_R(-5.0) * DEG, &found));
    TEST_ASSERT_FLOAT_WITHIN(0.05f, 35.0f, (float)(found.phase_rad / DEG));
}

static void test_other_orders_are_rejected(void) {
    for (unsigned order = 2; order <= 5; order++) {
        const wh_load_record record = made_up(0, order, WH_R(5000.0), WH_R(6000.0), WH_R(0.7));
        wh_lockin_result found;
        TEST_ASSERT_TRUE(wh_lockin(&record, marks, MARKS, WH_R(0.0), &found));
        TEST_ASSERT_TRUE(found.amplitude_counts < WH_R(12.0)); /* 0.2 % */
    }
}

static void test_a_constant_load_has_no_amplitude(void) {
    const wh_load_record record = made_up(0, 1, WH_R(12345.0), WH_R(0.0), WH_R(0.0));
    wh_lockin_result found;
    TEST_ASSERT_TRUE(wh_lockin(&record, marks, MARKS, WH_R(0.0), &found));
    TEST_ASSERT_FLOAT_WITHIN(0.05f, 0.0f, (float)found.amplitude_counts);
    TEST_ASSERT_FLOAT_WITHIN(0.05f, 12345.0f, (float)found.mean_counts);
}

/* No load is none at all; and a ramp's mean is that of its ends, wherever between two samples the turns begin. */
static void test_nothing_is_added_to_the_load(void) {
    wh_load_record record = made_up(0, 1, WH_R(0.0), WH_R(0.0), WH_R(0.0));
    wh_lockin_result found;
    TEST_ASSERT_TRUE(wh_lockin(&record, marks, MARKS, WH_R(0.0), &found));
    TEST_ASSERT_FLOAT_WITHIN(0.0f, 0.0f, (float)found.mean_counts);
    TEST_ASSERT_FLOAT_WITHIN(0.0f, 0.0f, (float)found.amplitude_counts);
    for (uint32_t begin = 0; begin <= PERIOD_TICKS; begin += PERIOD_TICKS / 4U) {
        for (unsigned i = 0; i < SAMPLES; i++) {
            raw[i] = (int16_t)(8 * (int)i - 4000);
        }
        for (unsigned i = 0; i < 5; i++) {
            marks[i] = (wh_mark){begin + i * 100U * PERIOD_TICKS, 4U * i};
        }
        TEST_ASSERT_TRUE(wh_lockin(&record, marks, 5, WH_R(0.0), &found));
        TEST_ASSERT_EQUAL_UINT(4, found.turns);
        const float middle = 200.0f + (float)begin / (float)PERIOD_TICKS;
        TEST_ASSERT_FLOAT_WITHIN(0.005f, 8.0f * middle - 4000.0f, (float)found.mean_counts);
    }
}

static void test_timer_may_wrap_within_the_record(void) {
    wh_lockin_result plain;
    wh_lockin_result wrapped;
    wh_load_record record = made_up(0, 1, WH_R(100.0), WH_R(6000.0), WH_R(0.5));
    TEST_ASSERT_TRUE(wh_lockin(&record, marks, MARKS, WH_R(0.0), &plain));
    record = made_up(UINT32_MAX - 900000U, 1, WH_R(100.0), WH_R(6000.0), WH_R(0.5));
    TEST_ASSERT_TRUE(marks[MARKS - 1U].ticks < marks[0].ticks);
    TEST_ASSERT_TRUE(wh_lockin(&record, marks, MARKS, WH_R(0.0), &wrapped));
    TEST_ASSERT_TRUE(plain.turns == wrapped.turns);
    TEST_ASSERT_FLOAT_WITHIN(0.0f, (float)plain.amplitude_counts, (float)wrapped.amplitude_counts);
    TEST_ASSERT_FLOAT_WITHIN(0.0f, (float)plain.phase_rad, (float)wrapped.phase_rad);
}

/* The second mark goes, then the third and so on, until only the record's first and last (the very
 * last mark lies outside) are left: the same bounds hold, as the made-up rotor turns evenly. */
static void test_missing_marks_change_nothing(void) {
    const wh_load_record record = made_up(0, 1, WH_R(8000.0), WH_R(6000.0), WH_R(30.0) * DEG);
    for (unsigned missing = 1; missing <= MARKS - 3U; missing++) {
        for (unsigned i = 1; i < MARKS - missing; i++) {
            marks[i] = marks[i + 1U];
        }
        wh_lockin_result found;
        TEST_ASSERT_TRUE(wh_lockin(&record, marks, MARKS - missing, WH_R(0.0), &found));
        TEST_ASSERT_EQUAL_UINT(10, found.turns);
        TEST_ASSERT_FLOAT_WITHIN(0.02f, 30.0f, (float)(found.phase_rad / DEG));
        TEST_ASSERT_FLOAT_WITHIN(1.5f, 6000.0f, (float)found.amplitude_counts);
        TEST_ASSERT_FLOAT_WITHIN(1e-6f, 0.181818f, (float)found.turn_s);
    }
}

static void test_less_than_a_turn_is_refused(void) {
    const wh_load_record record = made_up(0, 1, WH_R(0.0), WH_R(6000.0), WH_R(0.0));
    wh_lockin_result found;
    TEST_ASSERT_TRUE(wh_lockin(&record, marks, 2, WH_R(0.0), &found));
    TEST_ASSERT_EQUAL_UINT(1, found.turns);
    TEST_ASSERT_FALSE(wh_lockin(&record, marks, 1, WH_R(0.0), &found));
    TEST_ASSERT_FALSE(wh_lockin(&record, marks, 0, WH_R(0.0), &found));
    marks[0].ticks += 3000000U; /* outside the record */
    TEST_ASSERT_FALSE(wh_lockin(&record, marks, 1, WH_R(0.0), &found));
    marks[0].ticks = 100U; /* turns between two samples: there is no load to see */
    marks[1] = (wh_mark){600U, marks[0].quarter + 4U};
    TEST_ASSERT_FALSE(wh_lockin(&record, marks, 2, WH_R(0.0), &found));
    marks[1].ticks = PERIOD_TICKS + 600U; /* nor at one sample alone */
    TEST_ASSERT_FALSE(wh_lockin(&record, marks, 2, WH_R(0.0), &found));
    const wh_load_record empty = {raw, 0, 0, PERIOD_TICKS};
    TEST_ASSERT_FALSE(wh_lockin(&empty, marks, MARKS, WH_R(0.0), &found));
}

static void test_polar_all_around(void) {
    for (int degrees = -179; degrees <= 179; degrees++) {
        const wh_real angle = (wh_real)degrees * DEG;
        wh_real sine;
        wh_real cosine;
        wh_sincos(wh_phase_from_rad(angle), &sine, &cosine);
        wh_real radius;
        wh_real found;
        wh_polar(WH_R(42.0) * cosine, WH_R(42.0) * sine, &radius, &found);
        TEST_ASSERT_FLOAT_WITHIN(3e-5f, 42.0f, (float)radius);
        TEST_ASSERT_FLOAT_WITHIN(2e-6f, (float)angle, (float)found);
    }
    wh_real radius;
    wh_real angle;
    wh_polar(WH_R(-1.0), WH_R(0.0), &radius, &angle);
    TEST_ASSERT_FLOAT_WITHIN(1e-6f, (float)PI, (float)angle);
    wh_polar(WH_R(0.0), WH_R(0.0), &radius, &angle);
    TEST_ASSERT_FLOAT_WITHIN(0.0f, 0.0f, (float)radius);
    TEST_ASSERT_FLOAT_WITHIN(0.0f, 0.0f, (float)angle);
}

static void test_load_between_samples(void) {
    raw[0] = 100;
    raw[1] = 200;
    raw[2] = -400;
    const wh_load_record record = {raw, 3, UINT32_MAX - 1000U, PERIOD_TICKS};
    wh_real load = WH_R(0.0);
    TEST_ASSERT_TRUE(wh_load_at(&record, record.first_ticks + 500U, &load));
    TEST_ASSERT_FLOAT_WITHIN(1e-3f, 125.0f, (float)load);
    TEST_ASSERT_TRUE(wh_load_at(&record, record.first_ticks + 3000U, &load));
    TEST_ASSERT_FLOAT_WITHIN(1e-3f, -100.0f, (float)load);
    TEST_ASSERT_TRUE(wh_load_at(&record, record.first_ticks + 4000U, &load));
    TEST_ASSERT_FLOAT_WITHIN(1e-3f, -400.0f, (float)load);
    TEST_ASSERT_FALSE(wh_load_at(&record, record.first_ticks + 4001U, &load));
    TEST_ASSERT_FALSE(wh_load_at(&record, record.first_ticks - 1U, &load));
}

void suite_lockin(void) {
    RUN_TEST(test_known_phase_and_amplitude_are_found);
    RUN_TEST(test_angle_of_the_mark_counts);
    RUN_TEST(test_other_orders_are_rejected);
    RUN_TEST(test_a_constant_load_has_no_amplitude);
    RUN_TEST(test_nothing_is_added_to_the_load);
    RUN_TEST(test_timer_may_wrap_within_the_record);
    RUN_TEST(test_missing_marks_change_nothing);
    RUN_TEST(test_less_than_a_turn_is_refused);
    RUN_TEST(test_polar_all_around);
    RUN_TEST(test_load_between_samples);
}

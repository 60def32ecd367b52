/* test_rig.c: gaps between the rig's slot pulses, impossible pulses, and the load cell's counts. */
#include "core/rig/datasheet.h"
#include "core/rig/rig.h"

#include "tests/suites.h"

#define RPM WH_RIG_RADPS_PER_RPM
#define QUARTER UINT32_C(45455) /* ticks of a quarter turn at 330 rpm */

static float rpm(wh_real radps) { return (float)(radps / RPM); }

/* Gives `turns` turns of pulses at constant speed, beginning at *ticks. *ticks becomes the time of sensor 0's next
 * pulse. */
static void spin(wh_speed *speed, uint32_t *ticks, unsigned turns) {
    for (unsigned i = 0; i < turns; i++) {
        TEST_ASSERT_TRUE(wh_speed_pulse(speed, 0, *ticks));
        TEST_ASSERT_TRUE(wh_speed_pulse(speed, 1, *ticks + QUARTER));
        *ticks += 4U * QUARTER;
    }
}

/* After a whole turn without pulses the interval would show a fifth of the speed. It must not count as a speed. */
TEST(rig, gap_does_not_change_the_speed) {
    wh_speed speed;
    wh_speed_start(&speed, WH_R(800.0) * RPM);
    uint32_t ticks = 0;
    spin(&speed, &ticks, 3);
    const uint32_t last = ticks - 3U * QUARTER;
    TEST_ASSERT_FALSE(wh_speed_is_overdue(&speed, last + 3U * QUARTER));
    TEST_ASSERT_TRUE(wh_speed_is_overdue(&speed, last + 5U * QUARTER));
    CHECK_NEAR(1e-5f, 0.227275f, wh_speed_silence_s(&speed, last + 5U * QUARTER));
    ticks += 4U * QUARTER;
    TEST_ASSERT_TRUE(wh_speed_pulse(&speed, 0, ticks));
    TEST_ASSERT_EQUAL_UINT32(2, speed.lost);
    CHECK_NEAR(0.01f, 330.0f, rpm(speed.turn_radps));
    TEST_ASSERT_FALSE(wh_speed_is_overdue(&speed, ticks + 3U * QUARTER));
}

/* Three pulses in succession are lost. The same sensor fires after two turns, which would show half of the speed if it
 * were constant. With any ripple, the interval must not count as one turn. */
TEST(rig, three_lost_running_are_a_gap) {
    for (unsigned late = 0; late < 2; late++) {
        wh_speed speed;
        wh_speed_start(&speed, WH_R(800.0) * RPM);
        uint32_t ticks = 0;
        spin(&speed, &ticks, 3);
        TEST_ASSERT_TRUE(wh_speed_pulse(&speed, 0, ticks));
        ticks += 8U * QUARTER + late * 2000U - 1000U;
        TEST_ASSERT_TRUE(wh_speed_pulse(&speed, 0, ticks));
        TEST_ASSERT_EQUAL_UINT32(2, speed.lost);
        TEST_ASSERT_EQUAL_UINT32(1, speed.restarts);
        TEST_ASSERT_TRUE(speed.interval_radps == WH_R(0.0));
        CHECK_NEAR(0.01f, 330.0f, rpm(speed.turn_radps));
    }
}

TEST(rig, impossible_pulses_are_rejected) {
    wh_speed speed;
    wh_speed_start(&speed, WH_R(800.0) * RPM);
    uint32_t ticks = 0;
    spin(&speed, &ticks, 3);
    TEST_ASSERT_TRUE(wh_speed_pulse(&speed, 0, ticks));
    TEST_ASSERT_FALSE(wh_speed_pulse(&speed, 0, ticks));                /* same instant */
    TEST_ASSERT_FALSE(wh_speed_pulse(&speed, 0, ticks + 300U));         /* bounce */
    TEST_ASSERT_FALSE(wh_speed_pulse(&speed, 1, ticks + QUARTER / 3U)); /* 990 rpm */
    TEST_ASSERT_TRUE(wh_speed_pulse(&speed, 1, ticks + QUARTER));
    TEST_ASSERT_EQUAL_UINT32(3, speed.rejected);
    TEST_ASSERT_EQUAL_UINT32(0, speed.lost);
    CHECK_NEAR(0.01f, 330.0f, rpm(speed.turn_radps));
}

/* If no turn is known, no pulse can be overdue, after any time. */
TEST(rig, only_known_turns_are_overdue) {
    wh_speed speed;
    wh_speed_start(&speed, WH_R(800.0) * RPM);
    TEST_ASSERT_FALSE(wh_speed_is_overdue(&speed, UINT32_MAX));
    TEST_ASSERT_TRUE(wh_speed_pulse(&speed, 0, 1000));
    speed.turn_radps = WH_R(330.0) * RPM;
    TEST_ASSERT_FALSE(wh_speed_is_overdue(&speed, 100000000U));
    speed.known = true;
    TEST_ASSERT_TRUE(wh_speed_is_overdue(&speed, 100000000U));
    TEST_ASSERT_FALSE(wh_speed_is_overdue(&speed, 1000U + 181000U)); /* a turn takes 181818 ticks */
    TEST_ASSERT_TRUE(wh_speed_is_overdue(&speed, 1000U + 183000U));
}

/* The converter's status of a sample, and its value at full scale. */
TEST(rig, the_cells_counts_are_newtons) {
    const wh_cell_config cell = {.newton_per_count = WH_R(-0.01),
                                 .offset_N = WH_R(2.0),
                                 .delay_ticks = 300,
                                 .period_ticks = 2000,
                                 .raw_max = INT32_C(100000)};
    wh_load load = wh_cell_load(&cell, 100, INT32_C(-50000), WH_LOAD_OK);
    CHECK_NEAR(1e-4f, 498.0f, load.force_N);
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX - 199U, load.ticks);
    TEST_ASSERT_TRUE(load.status == WH_LOAD_OK);
    static const int32_t raw[] = {99999, -99999, 100000, -100000, INT32_MAX, INT32_MIN + 1};
    for (unsigned i = 0; i < 6; i++) {
        load = wh_cell_load(&cell, 100, raw[i], WH_LOAD_OK);
        TEST_ASSERT_TRUE(load.status == (i < 2 ? WH_LOAD_OK : WH_LOAD_SATURATED));
    }
    for (wh_load_status status = WH_LOAD_SATURATED; status < WH_LOAD_STATUSES; status++) {
        TEST_ASSERT_TRUE(wh_cell_load(&cell, 0, 7, status).status == status);
    }
}

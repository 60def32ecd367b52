/* test_rig.c: the rig's controller, part by part: speed, drive, cell. */
#include "core/rig/datasheet.h"
#include "core/rig/rig.h"
#include "core/root.h"

#include "tests/suites.h"

#define RPM WH_RIG_RADPS_PER_RPM
#define QUARTER UINT32_C(45455) /* ticks of a quarter turn at 330 rpm */

#define SUPPLY_V WH_R(24.0)

static double root(double x) { return (double)WH_SQRT((wh_real)x); }

static float rpm(wh_real radps) { return (float)(radps / RPM); }

/* `turns` turns of even pulses from *ticks on; leaves *ticks at the next pulse of sensor 0. */
static void spin(wh_speed *speed, uint32_t *ticks, unsigned turns) {
    for (unsigned i = 0; i < turns; i++) {
        TEST_ASSERT_TRUE(wh_speed_pulse(speed, 0, *ticks));
        TEST_ASSERT_TRUE(wh_speed_pulse(speed, 1, *ticks + QUARTER));
        *ticks += 4U * QUARTER;
    }
}

TEST(rig, speed_across_the_timers_wrap) {
    wh_speed speed;
    wh_speed_start(&speed, WH_R(800.0) * RPM);
    uint32_t ticks = UINT32_MAX - 9U * QUARTER;
    spin(&speed, &ticks, 1);
    TEST_ASSERT_FALSE(speed.known); /* not a whole turn yet */
    for (unsigned i = 0; i < 5; i++) {
        spin(&speed, &ticks, 1);
        TEST_ASSERT_TRUE(speed.known);
        TEST_ASSERT_FLOAT_WITHIN(0.01f, 330.0f, rpm(speed.turn_radps));
        TEST_ASSERT_FLOAT_WITHIN(0.01f, 330.0f, rpm(speed.interval_radps));
    }
    TEST_ASSERT_TRUE(ticks < 30U * QUARTER); /* it did wrap */
    TEST_ASSERT_EQUAL_UINT32(0, speed.lost + speed.rejected);
}

/* The rotor is fast through the bottom and slow over the top, but the mean of a whole turn must not change. */
TEST(rig, speed_of_a_turn_has_no_ripple) {
    wh_speed speed;
    wh_speed_start(&speed, WH_R(800.0) * RPM);
    uint32_t ticks = 0;
    for (unsigned i = 0; i < 6; i++) {
        wh_speed_pulse(&speed, 0, ticks);
        wh_speed_pulse(&speed, 1, ticks + QUARTER - 4000U);
        ticks += 4U * QUARTER;
    }
    TEST_ASSERT_FLOAT_WITHIN(0.01f, 330.0f, rpm(speed.turn_radps));
    TEST_ASSERT_TRUE(rpm(speed.interval_radps) > 350.0f);
}

TEST(rig, one_lost_pulse_is_counted_and_bridged) {
    for (unsigned sensor = 0; sensor < 2; sensor++) {
        wh_speed speed;
        wh_speed_start(&speed, WH_R(800.0) * RPM);
        uint32_t ticks = 123;
        spin(&speed, &ticks, 3);
        wh_speed_pulse(&speed, 1U - sensor,
                       ticks + (1U - sensor) * QUARTER); /* this sensor's pulse is lost */
        ticks += 4U * QUARTER;
        spin(&speed, &ticks, 1);
        TEST_ASSERT_EQUAL_UINT32(1, speed.lost);
        TEST_ASSERT_FLOAT_WITHIN(0.01f, 330.0f, rpm(speed.turn_radps));
    }
}

/* After a whole turn without pulses the interval looks like a fifth of the speed. It must not count as a speed. */
TEST(rig, a_gap_keeps_the_speed_and_counts) {
    wh_speed speed;
    wh_speed_start(&speed, WH_R(800.0) * RPM);
    uint32_t ticks = 0;
    spin(&speed, &ticks, 3);
    const uint32_t last = ticks - 3U * QUARTER;
    TEST_ASSERT_FALSE(wh_speed_is_overdue(&speed, last + 3U * QUARTER));
    TEST_ASSERT_TRUE(wh_speed_is_overdue(&speed, last + 5U * QUARTER));
    TEST_ASSERT_FLOAT_WITHIN(1e-5f, 0.227275f,
                             (float)wh_speed_silence_s(&speed, last + 5U * QUARTER));
    ticks += 4U * QUARTER;
    TEST_ASSERT_TRUE(wh_speed_pulse(&speed, 0, ticks));
    TEST_ASSERT_EQUAL_UINT32(2, speed.lost);
    TEST_ASSERT_FLOAT_WITHIN(0.01f, 330.0f, rpm(speed.turn_radps));
    TEST_ASSERT_FALSE(wh_speed_is_overdue(&speed, ticks + 3U * QUARTER));
}

/* Three lost pulses in a row: the same sensor fires after two turns, which at an even speed is just half of one turn's speed.
 * With any ripple, it must not count as one turn. */
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
        TEST_ASSERT_FLOAT_WITHIN(0.01f, 330.0f, rpm(speed.turn_radps));
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
    TEST_ASSERT_FALSE(wh_speed_pulse(&speed, 2, ticks + QUARTER));      /* no such sensor */
    TEST_ASSERT_TRUE(wh_speed_pulse(&speed, 1, ticks + QUARTER));
    TEST_ASSERT_EQUAL_UINT32(4, speed.rejected);
    TEST_ASSERT_EQUAL_UINT32(0, speed.lost);
    TEST_ASSERT_FLOAT_WITHIN(0.01f, 330.0f, rpm(speed.turn_radps));
}

static unsigned steps_to_target(wh_drive *drive) {
    unsigned steps = 0;
    while (!wh_drive_at_target(drive) && steps < 10000U) {
        wh_drive_step(&wh_rig_standard.run.drive, drive, drive->setpoint_radps, SUPPLY_V,
                      WH_R(0.002));
        steps++;
    }
    return steps;
}

TEST(rig, ramp_keeps_its_rate_and_arrives) {
    const wh_drive_config *config = &wh_rig_standard.run.drive;
    wh_drive drive;
    wh_drive_start(&drive, WH_R(20.0), WH_R(0.3));
    TEST_ASSERT_TRUE(wh_drive_at_target(&drive));
    /* no jump: at the take-over speed the voltage stays */
    TEST_ASSERT_FLOAT_WITHIN(
        1e-6f, 0.3f, (float)wh_drive_step(config, &drive, WH_R(20.0), SUPPLY_V, WH_R(0.002)));
    const float rate = (float)config->ramp_radps2;
    drive.target_radps = WH_R(25.0);
    TEST_ASSERT_FLOAT_WITHIN(1.5f, 5.0f / rate / 0.002f, (float)steps_to_target(&drive));
    /* a quarter of the rate at slow speed */
    drive.target_radps = config->gentle_radps;
    (void)steps_to_target(&drive);
    drive.target_radps -= WH_R(2.0);
    TEST_ASSERT_FLOAT_WITHIN(4.0f, 8.0f / rate / 0.002f, (float)steps_to_target(&drive));
    drive.target_radps = WH_R(14.0);
    wh_drive_step(config, &drive, WH_R(15.0), SUPPLY_V, WH_R(0.002));
    TEST_ASSERT_TRUE(drive.setpoint_radps > config->gentle_radps - WH_R(2.1));
}

TEST(rig, loop_leaves_no_steady_error) {
    const wh_drive_config *config = &wh_rig_standard.run.drive;
    wh_drive drive;
    wh_drive_start(&drive, WH_R(0.0), WH_R(0.0));
    drive.target_radps = WH_R(34.0);
    wh_real speed = WH_R(0.0);
    for (unsigned i = 0; i < 10000U; i++) { /* 20 s; the motor line with drag, a lag of 0.24 s */
        const wh_real volts = wh_drive_step(config, &drive, speed, SUPPLY_V, WH_R(0.002));
        speed += WH_R(0.002) / WH_R(0.24) * (WH_R(2.5) * volts - WH_R(1.5) - speed);
    }
    TEST_ASSERT_FLOAT_WITHIN(0.01f, 34.0f, (float)speed);
}

/* If a rotor was blocked for a minute, the integral must not have grown meanwhile, with any supply. */
TEST(rig, integral_does_not_wind_up) {
    const wh_drive_config *config = &wh_rig_standard.run.drive;
    static const wh_real supplies_V[] = {WH_R(12.0), WH_R(24.0), WH_R(36.0)};
    for (unsigned i = 0; i < 3; i++) {
        wh_drive drive;
        wh_drive_start(&drive, config->gentle_radps, WH_R(0.0));
        drive.target_radps = WH_R(60.0);
        wh_real volts = WH_R(0.0);
        for (unsigned step = 0; step < 30000U; step++) {
            volts = wh_drive_step(config, &drive, config->gentle_radps, supplies_V[i], WH_R(0.002));
        }
        TEST_ASSERT_TRUE(volts == supplies_V[i]);
        /* On the ramp the error is 6.28 t, the voltage 1.508 t + 3.142 t^2: full at t. The integral stands still from then on,
         * at 3.142 t^2; a mere clamp would let it rise to the supply. */
        const double full_s =
            (root(1.508 * 1.508 + 4.0 * 3.142 * (double)supplies_V[i]) - 1.508) / (2.0 * 3.142);
        const double kept_V = 3.142 * full_s * full_s;
        TEST_ASSERT_FLOAT_WITHIN(0.02f * (float)kept_V, (float)kept_V, (float)drive.integral_V);
        unsigned steps = 0;
        do {
            volts = wh_drive_step(config, &drive, WH_R(66.0), supplies_V[i], WH_R(0.002));
            steps++;
        } while (volts > WH_R(13.8) && steps < 10000U);
        /* 6 rad/s too fast: 1.44 V less at once and 6 V a second */
        const double back_s = (kept_V - 1.44 - 13.8) / 6.0;
        TEST_ASSERT_TRUE((double)steps < (back_s > 0.0 ? back_s * 500.0 : 0.0) + 25.0);
    }
}

/* When the supply breaks down, the integral falls; when the supply returns, the integral does not rise again. */
TEST(rig, the_integral_comes_back) {
    const wh_drive_config *config = &wh_rig_standard.run.drive;
    static const wh_real out_V[] = {WH_R(-1.0), WH_R(25.0), WH_R(1e6)};
    for (unsigned i = 0; i < 3; i++) {
        const wh_real bound = i == 0 ? WH_R(0.0) : SUPPLY_V;
        const wh_real side = i == 0 ? WH_R(-1.0) : WH_R(1.0);
        wh_drive drive;
        wh_drive_start(&drive, WH_R(30.0), out_V[i]);
        const wh_real volts =
            wh_drive_step(config, &drive, WH_R(30.0) + side * WH_R(0.01), SUPPLY_V, WH_R(0.002));
        TEST_ASSERT_TRUE(volts == bound && drive.integral_V == bound);
    }
    wh_drive drive;
    wh_drive_start(&drive, WH_R(30.0), WH_R(20.0));
    TEST_ASSERT_TRUE(wh_drive_step(config, &drive, WH_R(30.0), WH_R(12.0), WH_R(0.002)) ==
                     WH_R(12.0));
    TEST_ASSERT_TRUE(wh_drive_step(config, &drive, WH_R(30.0), SUPPLY_V, WH_R(0.002)) ==
                     WH_R(12.0));
}

TEST(rig, voltage_stays_in_range) {
    const wh_drive_config *config = &wh_rig_standard.run.drive;
    wh_drive drive;
    wh_drive_start(&drive, WH_R(0.0), WH_R(70.0));
    for (unsigned i = 0; i < 5000U; i++) {
        const wh_real volts = wh_drive_step(config, &drive, WH_R(500.0), SUPPLY_V, WH_R(0.002));
        TEST_ASSERT_TRUE(volts >= WH_R(0.0) && volts <= SUPPLY_V);
    }
    TEST_ASSERT_TRUE(drive.integral_V >= WH_R(0.0));
}

/* If no turn is known, no pulse can be overdue, after any time. */
TEST(rig, only_a_known_turn_can_be_overdue) {
    wh_speed speed;
    wh_speed_start(&speed, WH_R(800.0) * RPM);
    TEST_ASSERT_FALSE(wh_speed_is_overdue(&speed, UINT32_MAX));
    TEST_ASSERT_TRUE(wh_speed_pulse(&speed, 0, 1000));
    speed.turn_radps = WH_R(330.0) * RPM;
    TEST_ASSERT_FALSE(wh_speed_is_overdue(&speed, 100000000U));
    speed.known = true;
    TEST_ASSERT_TRUE(wh_speed_is_overdue(&speed, 100000000U));
    TEST_ASSERT_FALSE(wh_speed_is_overdue(&speed, 1000U + 181000U)); /* a turn takes 181818 */
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
    TEST_ASSERT_FLOAT_WITHIN(1e-4f, 498.0f, (float)load.force_N);
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX - 199U, load.ticks);
    TEST_ASSERT_TRUE(load.status == WH_LOAD_OK);
    static const int32_t raw[] = {99999, -99999, 100000, -100000, INT32_MAX, INT32_MIN + 1};
    for (unsigned i = 0; i < 6; i++) {
        load = wh_cell_load(&cell, 100, raw[i], WH_LOAD_OK);
        TEST_ASSERT_TRUE(load.status == (i < 2 ? WH_LOAD_OK : WH_LOAD_SATURATED));
    }
    for (wh_load_status status = WH_LOAD_SATURATED; status < WH_LOAD_STATUSES; status++) {
        TEST_ASSERT_TRUE(wh_cell_load(&cell, 0, 7, status).status == status);
        TEST_ASSERT_NOT_NULL(wh_load_text(status));
    }
}

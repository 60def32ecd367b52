/* test_rig.c: the rig's controller, piece by piece: speed, drive, guard. */
#include "core/rig/datasheet.h"
#include "core/rig/rig.h"

#include "unity.h"

void suite_rig(void);

#define RPM WH_RIG_RADPS_PER_RPM
#define QUARTER UINT32_C(45455) /* ticks of a quarter turn at 330 rpm */

static float rpm(wh_real radps) { return (float)(radps / RPM); }

/* --- speed -------------------------------------------------------------------------------------- */

/* `turns` turns of even pulses from *ticks on; leaves *ticks at the next pulse of sensor 0. */
static void spin(wh_speed *speed, uint32_t *ticks, unsigned turns) {
    for (unsigned i = 0; i < turns; i++) {
        TEST_ASSERT_TRUE(wh_speed_pulse(speed, 0, *ticks));
        TEST_ASSERT_TRUE(wh_speed_pulse(speed, 1, *ticks + QUARTER));
        *ticks += 4U * QUARTER;
    }
}

static void test_speed_across_the_timers_wrap(void) {
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

/* Fast through the bottom, slow over the top: the whole turn's mean must not see it. */
static void test_speed_of_a_turn_has_no_ripple(void) {
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

static void test_one_lost_pulse_is_counted_and_bridged(void) {
    for (unsigned sensor = 0; sensor < 2; sensor++) {
        wh_speed speed;
        wh_speed_start(&speed, WH_R(800.0) * RPM);
        uint32_t ticks = 123;
        spin(&speed, &ticks, 3);
        wh_speed_pulse(&speed, 1U - sensor, ticks + (1U - sensor) * QUARTER); /* sensor's is lost */
        ticks += 4U * QUARTER;
        spin(&speed, &ticks, 1);
        TEST_ASSERT_EQUAL_UINT32(1, speed.lost);
        TEST_ASSERT_FLOAT_WITHIN(0.01f, 330.0f, rpm(speed.turn_radps));
    }
}

/* A whole turn without pulses looks like a fifth of the speed: it must not pass for one. */
static void test_a_gap_keeps_the_speed_and_counts(void) {
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

/* Three lost running: the same sensor fires after two turns, which at an even speed is just half of
 * what one turn would need. Whatever the ripple, it must not pass for one turn. */
static void test_three_lost_running_are_a_gap(void) {
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

static void test_impossible_pulses_are_rejected(void) {
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

/* --- drive -------------------------------------------------------------------------------------- */

static void test_ramp_keeps_its_rate_and_arrives(void) {
    const wh_drive_config *config = &wh_rig_standard.drive;
    wh_drive drive;
    wh_drive_start(config, &drive, WH_R(10.0), WH_R(0.3));
    TEST_ASSERT_TRUE(wh_drive_at_target(&drive));
    /* no bump: at the take-over speed the duty stays */
    TEST_ASSERT_FLOAT_WITHIN(1e-6f, 0.3f,
                             (float)wh_drive_step(config, &drive, WH_R(10.0), WH_R(0.002)));
    drive.target_radps = WH_R(15.0);
    unsigned steps = 0;
    while (!wh_drive_at_target(&drive) && steps < 10000U) {
        wh_drive_step(config, &drive, drive.setpoint_radps, WH_R(0.002));
        steps++;
    }
    const float expected = 5.0f / (float)config->ramp_radps2 / 0.002f;
    TEST_ASSERT_FLOAT_WITHIN(1.5f, expected, (float)steps);
    drive.target_radps = WH_R(14.0);
    wh_drive_step(config, &drive, WH_R(15.0), WH_R(0.002));
    TEST_ASSERT_TRUE(drive.setpoint_radps < WH_R(15.0) && drive.setpoint_radps > WH_R(14.9));
}

static void test_loop_leaves_no_steady_error(void) {
    const wh_drive_config *config = &wh_rig_standard.drive;
    wh_drive drive;
    wh_drive_start(config, &drive, WH_R(0.0), WH_R(0.0));
    drive.target_radps = WH_R(34.0);
    wh_real speed = WH_R(0.0);
    for (unsigned i = 0; i < 10000U; i++) { /* 20 s; the motor line with drag, a lag of 0.24 s */
        const wh_real duty = wh_drive_step(config, &drive, speed, WH_R(0.002));
        speed += WH_R(0.002) / WH_R(0.24) * (WH_R(60.0) * duty - WH_R(1.5) - speed);
    }
    TEST_ASSERT_FLOAT_WITHIN(0.01f, 34.0f, (float)speed);
}

/* A rotor held for a minute must not find a minute of integral when it comes free. */
static void test_integral_does_not_wind_up(void) {
    const wh_drive_config *config = &wh_rig_standard.drive;
    wh_drive drive;
    wh_drive_start(config, &drive, WH_R(0.0), WH_R(0.0));
    drive.target_radps = WH_R(34.0);
    wh_real duty = WH_R(0.0);
    for (unsigned i = 0; i < 30000U; i++) {
        duty = wh_drive_step(config, &drive, WH_R(0.0), WH_R(0.002));
    }
    TEST_ASSERT_FLOAT_WITHIN(1e-6f, 1.0f, (float)duty);
    /* On the ramp the error is 6.28 t, the duty 0.0628 t + 0.132 t^2: full at 2.52 s, and the integral
     * stands still from then on, at 0.132 * 2.52^2. A mere clamp would let it go on to 1. */
    TEST_ASSERT_FLOAT_WITHIN(0.01f, 0.84f, (float)drive.integral);
    unsigned steps = 0;
    do {
        duty = wh_drive_step(config, &drive, WH_R(40.0), WH_R(0.002));
        steps++;
    } while (duty > WH_R(0.574) && steps < 10000U);
    TEST_ASSERT_TRUE(steps < 450U); /* (0.84 - 0.06 - 0.574) / (0.042 * 6): 0.82 s */
}

/* An integral that is out of its bounds, by whatever, comes back into them. */
static void test_the_integral_comes_back(void) {
    const wh_drive_config *config = &wh_rig_standard.drive;
    const wh_real bounds[] = {config->duty_min, config->duty_max};
    for (unsigned i = 0; i < 2; i++) {
        const wh_real side = i == 0 ? WH_R(-1.0) : WH_R(1.0);
        wh_drive drive;
        wh_drive_start(config, &drive, WH_R(30.0), WH_R(0.5));
        drive.integral = bounds[i] + side;
        const wh_real duty =
            wh_drive_step(config, &drive, WH_R(30.0) + side * WH_R(0.01), WH_R(0.002));
        TEST_ASSERT_TRUE(duty == bounds[i] && drive.integral == bounds[i]);
    }
}

static void test_duty_stays_in_range(void) {
    const wh_drive_config *config = &wh_rig_standard.drive;
    wh_drive drive;
    wh_drive_start(config, &drive, WH_R(0.0), WH_R(7.0));
    TEST_ASSERT_FLOAT_WITHIN(0.0f, 1.0f, (float)drive.integral);
    for (unsigned i = 0; i < 5000U; i++) {
        const wh_real duty = wh_drive_step(config, &drive, WH_R(500.0), WH_R(0.002));
        TEST_ASSERT_TRUE(duty >= WH_R(0.0) && duty <= WH_R(1.0));
    }
    TEST_ASSERT_TRUE(drive.integral >= WH_R(0.0));
}

/* --- guard -------------------------------------------------------------------------------------- */

/* docs/rig.md: reversed bending at the bearing, 1 in from the arm, notch factor 2, safety 2, against
 * the corrected endurance limit of steel with 440 MPa tensile strength. */
static void test_speed_limit_follows_from_the_shaft(void) {
    const wh_real pi = WH_R(3.14159265);
    const wh_real endurance_Pa = WH_R(220e6) * WH_R(0.899) * WH_R(0.753);
    const wh_real d_m = WH_R(0.25) * WH_R(0.0254);
    const wh_real section_m3 = pi * d_m * d_m * d_m / WH_R(32.0);
    const wh_real carried_N = endurance_Pa / (WH_R(2.0) * WH_R(2.0)) * section_m3 / WH_R(0.0254);
    const wh_real others_N =
        WH_R(1.34) + WH_R(2.10); /* one set's weight; its share of the ripple */
    const wh_real limit = wh_rig_standard.guard.limit_radps;
    const wh_real at_limit_N = WH_RIG_MASS_MOMENT_KGM / WH_R(2.0) * limit * limit + others_N;
    TEST_ASSERT_TRUE(at_limit_N < carried_N);
    TEST_ASSERT_TRUE(at_limit_N > WH_R(0.85) * carried_N); /* and no lower than it need be */
    TEST_ASSERT_TRUE(wh_rig_standard.guard.target_max_radps < limit);
    TEST_ASSERT_TRUE(WH_RIG_NOMINAL_RPM * RPM < wh_rig_standard.guard.target_max_radps);
}

static void test_guard_refuses_set_points(void) {
    const wh_guard_config *config = &wh_rig_standard.guard;
    TEST_ASSERT_TRUE(wh_guard_allows(config, WH_R(330.0) * RPM));
    TEST_ASSERT_TRUE(wh_guard_allows(config, config->target_min_radps));
    TEST_ASSERT_TRUE(wh_guard_allows(config, config->target_max_radps));
    TEST_ASSERT_FALSE(wh_guard_allows(config, WH_R(361.0) * RPM));
    TEST_ASSERT_FALSE(wh_guard_allows(config, WH_R(169.0) * RPM));
    TEST_ASSERT_FALSE(wh_guard_allows(config, WH_R(0.0)));
    TEST_ASSERT_FALSE(wh_guard_allows(config, WH_R(-1.0)));
    TEST_ASSERT_FALSE(wh_guard_allows(config, (wh_real)__builtin_nanf("")));
}

static wh_trip trip_at(wh_real turn_rpm, wh_real interval_rpm, unsigned pulses) {
    wh_guard guard;
    wh_guard_start(&guard, 0);
    wh_speed speed;
    wh_speed_start(&speed, WH_R(800.0) * RPM);
    speed.known = true;
    speed.turn_radps = turn_rpm * RPM;
    speed.interval_radps = interval_rpm * RPM;
    for (unsigned i = 0; i < pulses; i++) {
        speed.taken++;
        wh_guard_speed(&wh_rig_standard.guard, &guard, &speed, 0);
        wh_guard_speed(&wh_rig_standard.guard, &guard, &speed, 0); /* no new pulse: no new count */
    }
    return guard.trip;
}

static void test_over_speed_trips(void) {
    TEST_ASSERT_TRUE(trip_at(WH_R(399.0), WH_R(430.0), 5) == WH_TRIP_NONE);
    TEST_ASSERT_TRUE(trip_at(wh_rig_standard.guard.limit_radps / RPM, WH_R(400.0), 5) ==
                     WH_TRIP_NONE); /* the limit itself is allowed */
    TEST_ASSERT_TRUE(trip_at(WH_R(401.0), WH_R(400.0), 1) == WH_TRIP_OVERSPEED);
    TEST_ASSERT_TRUE(trip_at(WH_R(350.0), WH_R(450.0), 1) == WH_TRIP_NONE); /* a disturbance? */
    TEST_ASSERT_TRUE(trip_at(WH_R(350.0), WH_R(450.0), 2) == WH_TRIP_OVERSPEED);
}

/* Without a turn known nothing is overdue, however long it takes. */
static void test_only_a_known_turn_can_be_overdue(void) {
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

static void test_lost_pulses_and_silence_trip(void) {
    const wh_guard_config *config = &wh_rig_standard.guard;
    wh_guard guard;
    wh_guard_start(&guard, 0);
    wh_speed speed;
    wh_speed_start(&speed, WH_R(800.0) * RPM);
    speed.lost = 5;
    guard.lost_before = 2;
    wh_guard_speed(config, &guard, &speed, 0);
    TEST_ASSERT_TRUE(guard.trip == WH_TRIP_NONE);
    speed.lost = 6;
    wh_guard_speed(config, &guard, &speed, 0);
    TEST_ASSERT_TRUE(guard.trip == WH_TRIP_PULSES);
    wh_guard_trip(&guard, WH_TRIP_OVERSPEED);
    TEST_ASSERT_TRUE(guard.trip == WH_TRIP_PULSES); /* the first reason stays */

    wh_guard_start(&guard, 0);
    wh_speed_start(&speed, WH_R(800.0) * RPM);
    wh_speed_pulse(&speed, 0, 1000U);
    wh_guard_speed(config, &guard, &speed, 1000U + 499000U);
    TEST_ASSERT_TRUE(guard.trip == WH_TRIP_NONE);
    wh_guard_speed(config, &guard, &speed, 1000U + 501000U);
    TEST_ASSERT_TRUE(guard.trip == WH_TRIP_PULSES);
}

/* Load samples that swing by `swing_N` about 50 N, a slot pulse with every 20th, at 330 rpm. */
static wh_trip trip_on_swing(wh_real swing_N, bool turning, unsigned samples) {
    const wh_guard_config *config = &wh_rig_standard.guard;
    wh_guard guard;
    wh_guard_start(&guard, 0);
    wh_speed speed;
    wh_speed_start(&speed, WH_R(800.0) * RPM);
    speed.turn_radps = WH_R(330.0) * RPM;
    for (unsigned i = 0; i < samples; i++) {
        speed.taken = i / 20U;
        const wh_load load = {.ticks = i * UINT32_C(2000),
                              .force_N = WH_R(50.0) + (i % 2U == 0 ? swing_N : -swing_N)};
        wh_guard_load(config, &guard, &speed, &load, turning);
    }
    return guard.trip;
}

static void test_a_stuck_load_cell_trips(void) {
    const unsigned enough = (unsigned)(20U * wh_rig_standard.guard.stuck_pulses + 1U);
    TEST_ASSERT_TRUE(trip_on_swing(WH_R(0.0), false, 1000) ==
                     WH_TRIP_NONE); /* at rest it may stand still */
    TEST_ASSERT_TRUE(trip_on_swing(WH_R(0.0), true, enough - 1U) == WH_TRIP_NONE);
    TEST_ASSERT_TRUE(trip_on_swing(WH_R(0.0), true, enough) == WH_TRIP_LOAD_CELL);
    /* noise on a dead cell; a tenth of the masses' 42 N is what a load that lives shows at least */
    TEST_ASSERT_TRUE(trip_on_swing(WH_R(2.0), true, enough) == WH_TRIP_LOAD_CELL);
    TEST_ASSERT_TRUE(trip_on_swing(WH_R(2.2), true, 1000) == WH_TRIP_NONE);
}

/* What the converter says of a sample, and what it shows at full scale. */
static void test_the_cells_counts_are_newtons(void) {
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

static void test_an_overloaded_or_disconnected_load_cell_trips(void) {
    const wh_speed speed = {.taken = 7};
    for (wh_load_status status = WH_LOAD_OK; status < WH_LOAD_STATUSES; status++) {
        wh_guard guard;
        wh_guard_start(&guard, 0);
        const wh_load load = {.status = status};
        wh_guard_load(&wh_rig_standard.guard, &guard, &speed, &load, false);
        const bool fails = status == WH_LOAD_SATURATED || status == WH_LOAD_DISCONNECTED;
        TEST_ASSERT_TRUE(guard.trip == (fails ? WH_TRIP_LOAD_CELL : WH_TRIP_NONE));
    }
}

/* load_silence_max_s: ten periods of 2 ms, across the timer's wrap; the same sample again is none. */
static void test_a_silent_load_cell_trips(void) {
    const wh_guard_config *config = &wh_rig_standard.guard;
    const uint32_t last = UINT32_MAX - 4000U;
    const wh_speed speed = {.taken = 7};
    for (unsigned sampled = 0; sampled < 2; sampled++) {
        wh_guard guard;
        wh_guard_start(&guard, sampled == 0 ? last : 0);
        if (sampled == 1) {
            wh_load load = {.ticks = last, .force_N = WH_R(1.0)};
            wh_guard_load(config, &guard, &speed, &load, false);
            load.ticks += 10000U;
            load.status = WH_LOAD_REPEATED;
            wh_guard_load(config, &guard, &speed, &load, false);
        }
        wh_guard_load_silence(config, &guard, last - 100U); /* read before the sample */
        wh_guard_load_silence(config, &guard, last + 19900U);
        TEST_ASSERT_TRUE(guard.trip == WH_TRIP_NONE);
        wh_guard_load_silence(config, &guard, last + 20100U);
        TEST_ASSERT_TRUE(guard.trip == WH_TRIP_LOAD_CELL);
    }
}

void suite_rig(void) {
    RUN_TEST(test_speed_across_the_timers_wrap);
    RUN_TEST(test_speed_of_a_turn_has_no_ripple);
    RUN_TEST(test_one_lost_pulse_is_counted_and_bridged);
    RUN_TEST(test_a_gap_keeps_the_speed_and_counts);
    RUN_TEST(test_three_lost_running_are_a_gap);
    RUN_TEST(test_impossible_pulses_are_rejected);
    RUN_TEST(test_ramp_keeps_its_rate_and_arrives);
    RUN_TEST(test_loop_leaves_no_steady_error);
    RUN_TEST(test_integral_does_not_wind_up);
    RUN_TEST(test_the_integral_comes_back);
    RUN_TEST(test_duty_stays_in_range);
    RUN_TEST(test_speed_limit_follows_from_the_shaft);
    RUN_TEST(test_guard_refuses_set_points);
    RUN_TEST(test_over_speed_trips);
    RUN_TEST(test_only_a_known_turn_can_be_overdue);
    RUN_TEST(test_lost_pulses_and_silence_trip);
    RUN_TEST(test_a_stuck_load_cell_trips);
    RUN_TEST(test_the_cells_counts_are_newtons);
    RUN_TEST(test_an_overloaded_or_disconnected_load_cell_trips);
    RUN_TEST(test_a_silent_load_cell_trips);
}

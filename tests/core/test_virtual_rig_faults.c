/* test_virtual_rig_faults.c: the whole rig on its model, with failures. */
#include "on_plant.h"

#include "unity.h"

void suite_virtual_rig_faults(void);

#define RUNAWAY_RPM 470.0f /* highest speed, settled or in the record */

/* docs/rig.md: the shaft's safety factor is 2 at 416 rpm and falls with the square. */
static void test_a_runaway_does_not_break_the_shaft(void) {
    const float fast = 416.0f / RUNAWAY_RPM;
    TEST_ASSERT_FLOAT_WITHIN(0.005f, 1.57f, 2.0f * fast * fast);
}

#if !WH_DOUBLE

static on_plant on;

/* Without the limit: the slowest set-point has a reserve and is not mere caution. */
static void test_slower_set_points_end_at_the_top(void) {
    static const float targets_rpm[] = {100.0f, 140.0f, 150.0f};
    for (unsigned i = 0; i < 3; i++) {
        plant_arm(&on);
        on.config.guard.target_min_radps = 0.0f;
        TEST_ASSERT_TRUE(plant_order(&on, WH_EVENT_START, targets_rpm[i] * RPM) == WH_ALLOWED);
        plant_go_on_to_the_end(&on);
        TEST_ASSERT_TRUE(on.rig.guard.trip == (i < 2 ? WH_TRIP_PULSES : WH_TRIP_NONE));
        plant_check_stopped(&on);
    }
}

static void test_a_silent_load_cell_stops_the_rig(void) {
    plant_begin(&on, 330.0f);
    plant_go_on_until(&on, WH_PHASE_RECORD);
    hal_virtual_rig_instance()->faults.lose_samples = ~0U;
    plant_go_on_to_the_end(&on);
    TEST_ASSERT_TRUE(on.rig.guard.trip == WH_TRIP_LOAD_CELL);
    plant_check_stopped(&on);
}

static void test_dead_sensors_stop_the_rig(void) {
    for (unsigned both = 0; both < 2; both++) {
        plant_begin(&on, 330.0f);
        plant_go_on_until(&on, WH_PHASE_SETTLE);
        hal_virtual_rig_instance()->faults.dead_sensor[0] = true;
        hal_virtual_rig_instance()->faults.dead_sensor[1] = both == 1;
        plant_go_on_to_the_end(&on);
        TEST_ASSERT_TRUE(on.rig.guard.trip == WH_TRIP_PULSES);
        TEST_ASSERT_TRUE(on.fastest_radps < 400.0f * RPM); /* blind, it did not run away */
        plant_check_stopped(&on);
    }
}

/* Once a pulse is overdue the speed is unknown: the voltage freezes, though the ramp goes on. */
static void test_voltage_is_held_while_a_pulse_is_overdue(void) {
    plant_begin(&on, 330.0f);
    plant_go_on_until(&on, WH_PHASE_RAMP);
    for (unsigned i = 0; i < 800U; i++) {
        plant_control(&on);
    }
    TEST_ASSERT_TRUE(on.rig.run.phase == WH_PHASE_RAMP);
    hal_virtual_rig_instance()->faults.dead_sensor[0] = true;
    hal_virtual_rig_instance()->faults.dead_sensor[1] = true;
    unsigned held = 0;
    float held_V = 0.0f;
    while (on.rig.guard.trip == WH_TRIP_NONE && held < 1000U) {
        if (wh_speed_is_overdue(&on.rig.pulses.speed, hal_clock_ticks())) {
            held_V = held == 0 ? on.rig.run.volts : held_V;
            TEST_ASSERT_FLOAT_WITHIN(0.0f, held_V, on.rig.run.volts);
            held++;
        }
        plant_control(&on);
    }
    TEST_ASSERT_TRUE(held > 50U && held < 1000U);
    TEST_ASSERT_TRUE(on.rig.guard.trip == WH_TRIP_PULSES);
}

static void test_stuck_load_cell_stops_the_rig(void) {
    plant_begin(&on, 330.0f);
    plant_go_on_until(&on, WH_PHASE_SETTLE);
    hal_virtual_rig_instance()->faults.stuck_load_cell = true;
    plant_go_on_to_the_end(&on);
    TEST_ASSERT_TRUE(on.rig.guard.trip == WH_TRIP_LOAD_CELL);
    plant_check_stopped(&on);
}

/* A drive stage stuck at full supply ignores the voltage: the guard trips, the enable cuts. The rotor's speed depends on the
 * angle at the fault. docs/rig.md: the shaft's safety factor is 2 at 416 rpm and falls with the square, to 1.57 at 470 rpm. */
static void test_runaway_is_caught(void) {
    for (unsigned i = 0; i < 10U; i++) {
        const bool recording = i % 2U == 1;
        plant_begin(&on, 330.0f);
        plant_go_on_until(&on, recording ? WH_PHASE_RECORD : WH_PHASE_SETTLE);
        for (unsigned step = 0; step < i * 9U; step++) {
            plant_control(&on);
        }
        on.fastest_radps = 0.0f;
        hal_virtual_rig_instance()->faults.stuck = 1.0f;
        plant_go_on_to_the_end(&on);
        if (!recording) { /* a record does not wait for over-speed */
            TEST_ASSERT_EQUAL_INT(WH_TRIP_OVERSPEED, on.rig.guard.trip);
            TEST_ASSERT_TRUE(on.fastest_radps > 400.0f * RPM);
        }
        TEST_ASSERT_TRUE(on.rig.guard.trip != WH_TRIP_NONE);
        TEST_ASSERT_TRUE(on.fastest_radps < RUNAWAY_RPM * RPM);
        TEST_ASSERT_FALSE(hal_virtual_rig_instance()->enabled || hal_watchdog_has_cut());
        plant_check_stopped(&on);
    }
}

/* Off by an interrupt, in each driving phase: no later command drives, and the run ends with a reason. */
static void test_off_from_an_interrupt_stays(void) {
    for (wh_rig_phase phase = WH_PHASE_SPIN_UP; phase <= WH_PHASE_RAMP_DOWN; phase++) {
        plant_begin(&on, 330.0f);
        plant_go_on_until(&on, phase);
        for (unsigned k = 0; k < 100; k++) {
            plant_control(&on);
        }
        TEST_ASSERT_TRUE(on.command.way == WH_MOTOR_DRIVES && hal_virtual_rig_instance()->enabled);
        hal_motor_off(HAL_MOTOR_COAST);
        for (plant_control(&on); on.command.way == WH_MOTOR_DRIVES; plant_control(&on)) {
            TEST_ASSERT_FALSE(hal_virtual_rig_instance()->enabled);
        }
        plant_go_on_to_the_end(&on);
        TEST_ASSERT_TRUE(phase == WH_PHASE_RAMP_DOWN || on.rig.guard.trip != WH_TRIP_NONE);
        plant_check_stopped(&on);
    }
}

/* Stop for less than a control step, in each driving phase: the stage switches itself off, and the run ends as by stop. */
static void test_a_short_stop_is_seen(void) {
    for (wh_rig_phase phase = WH_PHASE_SPIN_UP; phase <= WH_PHASE_RAMP_DOWN; phase++) {
        plant_begin(&on, 330.0f);
        plant_go_on_until(&on, phase);
        hal_virtual_rig_instance()->stop_cuts = true;
        plant_control(&on);
        TEST_ASSERT_TRUE(on.command.way != WH_MOTOR_DRIVES);
        plant_go_on_to_the_end(&on);
        TEST_ASSERT_TRUE(on.rig.guard.trip == WH_TRIP_NONE);
        TEST_ASSERT_TRUE(on.rig.state == WH_RIG_IDLE);
        plant_check_stopped(&on);
    }
}

static void test_watchdog_cuts_the_motor(void) {
    plant_begin(&on, 330.0f);
    plant_go_on_until(&on, WH_PHASE_RECORD);
    TEST_ASSERT_FALSE(hal_watchdog_has_cut());
    const uint32_t silent = hal_clock_ticks();
    hal_clock_wait_until(silent + 9U * CONTROL_TICKS);
    TEST_ASSERT_FALSE(hal_watchdog_has_cut());
    hal_clock_wait_until(silent + 11U * CONTROL_TICKS);
    TEST_ASSERT_TRUE(hal_watchdog_has_cut());
    hal_watchdog_kick();
    TEST_ASSERT_EQUAL(HAL_MOTOR_CUT, hal_motor_start());
    hal_motor_set_voltage(HAL_VIRTUAL_RATED_V);
    hal_clock_wait_until(silent + 45000U * CONTROL_TICKS);
    TEST_ASSERT_FLOAT_WITHIN(0.1f, 0.0f, hal_virtual_rig_speed_radps(hal_virtual_rig_instance()));
    plant_go_on_to_the_end(&on);
    TEST_ASSERT_TRUE(on.rig.guard.trip == WH_TRIP_WATCHDOG);
    plant_check_stopped(&on);
}

static void test_too_slow_and_too_fast_targets_are_refused(void) {
    static const float targets_rpm[] = {120.0f, 400.0f};
    for (unsigned i = 0; i < 2; i++) {
        plant_arm(&on);
        TEST_ASSERT_TRUE(plant_order(&on, WH_EVENT_START, targets_rpm[i] * RPM) ==
                         WH_REFUSED_TARGET);
        for (unsigned step = 0; step < 1000U; step++) {
            plant_control(&on);
        }
        TEST_ASSERT_FLOAT_WITHIN(0.001f, 0.0f, on.fastest_radps);
        TEST_ASSERT_TRUE(plant_order(&on, WH_EVENT_STOP, 0.0f) == WH_ALLOWED);
        plant_check_stopped(&on);
    }
}

#endif

void suite_virtual_rig_faults(void) {
    RUN_TEST(test_a_runaway_does_not_break_the_shaft);
#if !WH_DOUBLE
    RUN_TEST(test_slower_set_points_end_at_the_top);
    RUN_TEST(test_a_silent_load_cell_stops_the_rig);
    RUN_TEST(test_dead_sensors_stop_the_rig);
    RUN_TEST(test_voltage_is_held_while_a_pulse_is_overdue);
    RUN_TEST(test_stuck_load_cell_stops_the_rig);
    RUN_TEST(test_runaway_is_caught);
    RUN_TEST(test_off_from_an_interrupt_stays);
    RUN_TEST(test_a_short_stop_is_seen);
    RUN_TEST(test_watchdog_cuts_the_motor);
    RUN_TEST(test_too_slow_and_too_fast_targets_are_refused);
#endif
}

/* test_virtual_rig.c: the whole rig on its model: the dissertation's measurement, and its failures.
 *
 * The virtual rig computes in single precision only, so the double build has just the formula. */
#include <stddef.h>

#include "core/rig/datasheet.h"
#include "core/rig/rig.h"

#include "tests/scattered.h"
#include "unity.h"

void suite_virtual_rig(void);

#define RPM WH_RIG_RADPS_PER_RPM

/* I.3.2.1's formula in the units it is written in, weights over g, inches: 9.44 lbf at 330 rpm. */
static void test_mass_moment_gives_the_dissertations_force(void) {
    const wh_real omega = WH_R(5.5) * WH_RIG_TWO_PI;
    const wh_real g_inps2 = WH_R(386.0886);
    const wh_real force_lbf = omega * omega / g_inps2 *
                              (WH_R(0.152) * (WH_R(7.25) / WH_R(2.0)) + WH_R(0.15) * WH_R(6.5)) *
                              WH_R(2.0);
    const wh_real force_N = WH_RIG_MASS_MOMENT_KGM * omega * omega;
    TEST_ASSERT_FLOAT_WITHIN(0.005f, 9.44f, (float)force_lbf);
    TEST_ASSERT_FLOAT_WITHIN(0.001f, (float)force_lbf, (float)(force_N * WH_RIG_LBF_PER_N));
    TEST_ASSERT_FLOAT_WITHIN(0.05f, 42.0f, (float)force_N);
}

#if !WH_DOUBLE

#include "hal/clock.h"
#include "hal/loadcell.h"
#include "hal/motor.h"
#include "hal/slots.h"
#include "hal/virtual/virtual_rig.h"
#include "hal/watchdog.h"

#define CONTROL_TICKS UINT32_C(2000) /* an AVR's unsigned has 16 bits */

static wh_rig rig;
static wh_rig_config config;
static wh_rig_command command;
static float fastest_radps; /* of the rotor itself, not as measured */
static float noise_N;       /* standard deviation of what is added to each sample */

/* A normal number, nearly: twelve even ones. */
static float normal(void) {
    float sum = -6.0f;
    for (unsigned i = 0; i < 12; i++) {
        sum += (float)(scattered() >> 40) / 16777216.0f;
    }
    return sum;
}

/* One control step, as boards/programs/rig.c does it. */
static void control(void) {
    hal_clock_wait_until(hal_clock_ticks() + CONTROL_TICKS);
    hal_slot_pulse pulse;
    while (hal_slots_take(&pulse)) {
        wh_rig_pulse(&config, &rig, pulse.sensor, pulse.ticks);
    }
    hal_load_sample sample;
    while (hal_loadcell_take(&sample)) {
        if (noise_N > 0.0f) {
            sample.raw += (int32_t)(noise_N * normal() / HAL_LOADCELL_N_PER_COUNT);
        }
        wh_rig_load(&config, &rig, sample.ticks, sample.raw, (wh_load_status)sample.status);
    }
    const wh_rig_inputs inputs = {.now_ticks = hal_clock_ticks(),
                                  .supply_V = hal_motor_supply_V(),
                                  .watchdog_has_cut = hal_watchdog_has_cut()};
    command = wh_rig_step(&config, &rig, &inputs);
    if (command.way == WH_MOTOR_DRIVES) {
        hal_motor_set_voltage(command.volts);
    } else {
        hal_motor_off(command.way == WH_MOTOR_BRAKES ? HAL_MOTOR_BRAKE : HAL_MOTOR_COAST);
    }
    hal_watchdog_kick(); /* tripped too */
    const float speed = hal_virtual_rig_speed_radps(hal_virtual_rig_instance());
    fastest_radps = speed > fastest_radps ? speed : fastest_radps;
}

static wh_refusal order(wh_rig_event event, float value) {
    TEST_ASSERT_TRUE(wh_rig_post(&rig, event, value));
    control();
    return rig.answer;
}

/* The hardware and its controller, armed. */
static void arm(void) {
    config = wh_rig_standard;
    config.measure.cell = (wh_cell_config){.newton_per_count = HAL_LOADCELL_N_PER_COUNT,
                                           .period_ticks = HAL_LOADCELL_PERIOD_TICKS,
                                           .raw_max = HAL_LOADCELL_RAW_MAX};
    wh_rig_slots(&config, HAL_SLOT_LEAD_DEG / WH_RIG_DEG_PER_RAD);
    fastest_radps = 0.0f;
    noise_N = 0.0f;
    TEST_ASSERT_TRUE(hal_clock_start());
    wh_rig_start(&config, &rig, hal_clock_ticks(), NULL);
    hal_watchdog_start(10U * CONTROL_TICKS);
    for (unsigned i = 0; i < 1000U && !rig.guard.quiet; i++) {
        control();
    }
    TEST_ASSERT_TRUE(order(WH_EVENT_ARM, 0.0f) == WH_ALLOWED);
}

static void begin(float target_rpm) {
    arm();
    TEST_ASSERT_TRUE(order(WH_EVENT_START, target_rpm * RPM) == WH_ALLOWED);
}

/* Nothing is left to wait for: idle, or tripped and at rest. */
static bool is_over(void) {
    return rig.state == WH_LIFE_IDLE || (rig.state == WH_LIFE_TRIPPED && rig.rested);
}

/* Control until `phase` is reached or the run is over; a run that does neither is stopped. */
static void go_on_until(wh_rig_phase phase) {
    for (unsigned i = 0; i < 90000U && rig.run.phase != phase && !is_over(); i++) {
        control();
    }
}

static void go_on_to_the_end(void) { go_on_until(WH_PHASES); }

/* The rotor ends at rest, hanging, with the motor off. */
static void check_stopped(void) {
    TEST_ASSERT_TRUE(is_over());
    TEST_ASSERT_TRUE(command.way != WH_MOTOR_DRIVES);
    TEST_ASSERT_FLOAT_WITHIN(0.0f, 0.0f, command.volts);
    TEST_ASSERT_FLOAT_WITHIN(0.1f, 0.0f, hal_virtual_rig_speed_radps(hal_virtual_rig_instance()));
}

static bool is_done(void) {
    return rig.state == WH_LIFE_IDLE && rig.has_result && rig.guard.trip == WH_TRIP_NONE;
}

/* The run is done and measured S <w^2>: within 2 rpm, and within 0.1 % of what the mean speed and the speed's swing,
 * here from the model's own inertia, make of it; the phase within 0.1 degrees of 0, which it is for every rotor that
 * comes round at the speed it went with (docs/rig.md). */
static void check_measurement(float target_rpm) {
    TEST_ASSERT_TRUE(is_done());
    const wh_measured *force = &rig.result.force;
    const float omega = target_rpm * RPM;
    const float swing =
        WH_RIG_MASS_MOMENT_KGM * WH_RIG_GRAVITY_MPS2 / (WH_RIG_INERTIA_KGM2 * omega * omega);
    const float wanted_N = WH_RIG_MASS_MOMENT_KGM * omega * omega * (1.0f + 1.5f * swing * swing);
    TEST_ASSERT_FLOAT_WITHIN(2.0f, target_rpm, force->speed_radps / RPM);
    /* the speed itself, the damping's part of the swing */
    TEST_ASSERT_FLOAT_WITHIN(0.005f * wanted_N, wanted_N, force->amplitude_N);
    TEST_ASSERT_FLOAT_WITHIN(0.001f * wanted_N, force->expected_N, force->amplitude_N);
    TEST_ASSERT_FLOAT_WITHIN(0.1f, 0.0f, force->phase_rad * WH_RIG_DEG_PER_RAD);
    TEST_ASSERT_TRUE(force->quality == WH_GOOD);
    TEST_ASSERT_FLOAT_WITHIN(0.02f * WH_RIG_INERTIA_KGM2, WH_RIG_INERTIA_KGM2, force->inertia_kgm2);
}

static void test_measurement_of_the_force(void) {
    begin(330.0f);
    go_on_to_the_end();
    check_measurement(330.0f);
    check_stopped();
    const wh_rig_result *result = &rig.result;
    TEST_ASSERT_EQUAL_UINT32(10, result->force.turns);
    TEST_ASSERT_EQUAL_UINT32(0, result->lost + result->rejected);
    /* what moves in circles has no mean acceleration: the tare must come out */
    TEST_ASSERT_FLOAT_WITHIN(0.1f, 0.0f, result->force.mean_N);
    /* 12 lb of frame and 0.604 lb of arms and discs */
    TEST_ASSERT_FLOAT_WITHIN(0.01f, 12.604f * 4.4482216f, result->tare_N);
}

/* The cell's own noise (cell_noise of the model has 0.07 N), and far more: at the tare, while the guard watches, and in
 * what is measured, which says how much worse it is and is no further off than that, by a good margin here. */
static void test_a_noisy_cell_is_no_fault(void) {
    static const float noises_N[] = {0.07f, 0.5f, 1.0f, 3.0f};
    scattered_state = UINT64_C(0x5eed0041);
    float before_N = 0.0f;
    for (unsigned i = 0; i < 4; i++) {
        begin(330.0f);
        noise_N = noises_N[i];
        go_on_to_the_end();
        const wh_rig_result *result = &rig.result;
        TEST_ASSERT_TRUE(is_done() && result->force.quality == WH_GOOD);
        TEST_ASSERT_FLOAT_WITHIN(2.0f * result->force.amplitude_half_N, 42.15f,
                                 result->force.amplitude_N);
        TEST_ASSERT_FLOAT_WITHIN(2.0f * result->force.phase_half_rad, 0.0f,
                                 result->force.phase_rad);
        TEST_ASSERT_FLOAT_WITHIN(0.25f * noises_N[i], noises_N[i], result->force.residual_N);
        TEST_ASSERT_FLOAT_WITHIN(0.015f * noises_N[i], noises_N[i] / 15.8f, result->tare_error_N);
        TEST_ASSERT_TRUE(result->force.amplitude_half_N > before_N);
        before_N = result->force.amplitude_half_N;
    }
}

/* Gravity speeds the arms up on the way down: both peaks lie 2 S^2 g / I = 4.2 N off the formula,
 * towards the bottom. Sensor 1's spike sits on the upper peak, sensor 2's near the zero. */
static void test_gravity_shows_in_the_peaks_and_spikes(void) {
    const wh_rig_result *result = &rig.result;
    TEST_ASSERT_FLOAT_WITHIN(0.5f, 42.0f + 4.2f, result->high_N);
    TEST_ASSERT_FLOAT_WITHIN(0.5f, -42.0f + 4.2f, result->low_N);
    TEST_ASSERT_FLOAT_WITHIN(0.2f, result->high_N, result->force.at_mark_N[0]);
    TEST_ASSERT_FLOAT_WITHIN(2.5f, 0.0f, result->force.at_mark_N[1]);
}

/* Once settled, each pulse stands where the rotor is: the phase at the step after it, less what
 * the rotor turned since. */
static void test_pulses_stand_at_their_angles(void) {
    begin(330.0f);
    go_on_until(WH_PHASE_RECORD);
    TEST_ASSERT_TRUE(rig.run.phase == WH_PHASE_RECORD);
    hal_virtual_rig *plant = hal_virtual_rig_instance();
    unsigned pulses = 0;
    for (unsigned i = 0; i < 2000U; i++) {
        hal_clock_wait_until(hal_clock_ticks() + 1000U);
        hal_watchdog_kick();
        hal_slot_pulse pulse;
        while (hal_slots_take(&pulse)) {
            const float since_s = (float)(hal_clock_ticks() - pulse.ticks) * 1e-6f;
            const float speed = hal_virtual_rig_speed_radps(plant);
            const float turned = speed * since_s * WH_PHASE_PER_RAD;
            const uint32_t stand = pulse.sensor * 0x40000000U;
            const float off = (float)(int32_t)(hal_virtual_rig_phase(plant) - stand) - turned;
            const float off_deg = off / WH_PHASE_PER_RAD * WH_RIG_DEG_PER_RAD;
            TEST_ASSERT_FLOAT_WITHIN(0.005f, -HAL_SLOT_LEAD_DEG, off_deg);
            pulses++;
        }
    }
    TEST_ASSERT_TRUE(pulses >= 21U && pulses <= 23U); /* two a turn, 5.5 turns a second */
}

/* In the middle of the record, where the lock-in's turns lie: each costs its turn and, with the first, the next. */
static void test_lost_pulses_do_not_spoil_the_run(void) {
    for (unsigned lost = 1; lost <= wh_rig_standard.guard.lost_max; lost++) {
        begin(330.0f);
        go_on_until(WH_PHASE_RECORD);
        for (unsigned i = 0; i < 250U; i++) {
            control();
        }
        hal_virtual_rig_instance()->faults.lose_pulses[lost == 1 ? 0 : 1] = lost;
        go_on_to_the_end();
        check_measurement(330.0f);
        TEST_ASSERT_EQUAL_UINT32(lost, rig.result.lost);
        TEST_ASSERT_EQUAL_UINT32(lost == 1 ? 8 : 10, rig.result.force.turns);
        TEST_ASSERT_EQUAL_UINT32(lost == 1 ? 2 : 0, rig.result.force.left_out);
    }
}

/* Also at both ends of the range of set-points. */
static void test_slowest_and_fastest_set_points_run(void) {
    static const wh_real targets_rpm[] = {WH_RIG_TARGET_MIN_RPM, WH_RIG_TARGET_MAX_RPM};
    for (unsigned i = 0; i < 2; i++) {
        begin(targets_rpm[i]);
        go_on_to_the_end();
        check_measurement(targets_rpm[i]);
        check_stopped();
    }
}

/* With the limit taken away: the slowest set-point has a reserve, and is no mere caution. */
static void test_slower_set_points_end_at_the_top(void) {
    static const float targets_rpm[] = {100.0f, 140.0f, 150.0f};
    for (unsigned i = 0; i < 3; i++) {
        arm();
        config.guard.target_min_radps = 0.0f;
        TEST_ASSERT_TRUE(order(WH_EVENT_START, targets_rpm[i] * RPM) == WH_ALLOWED);
        go_on_to_the_end();
        TEST_ASSERT_TRUE(rig.guard.trip == (i < 2 ? WH_TRIP_PULSES : WH_TRIP_NONE));
        check_stopped();
    }
}

static void test_a_silent_load_cell_stops_the_rig(void) {
    begin(330.0f);
    go_on_until(WH_PHASE_RECORD);
    hal_virtual_rig_instance()->faults.lose_samples = ~0U;
    go_on_to_the_end();
    TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_LOAD_CELL);
    check_stopped();
}

static void test_dead_sensors_stop_the_rig(void) {
    for (unsigned both = 0; both < 2; both++) {
        begin(330.0f);
        go_on_until(WH_PHASE_SETTLE);
        hal_virtual_rig_instance()->faults.dead_sensor[0] = true;
        hal_virtual_rig_instance()->faults.dead_sensor[1] = both == 1;
        go_on_to_the_end();
        TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_PULSES);
        TEST_ASSERT_TRUE(fastest_radps < 400.0f * RPM); /* blind, it did not run away */
        check_stopped();
    }
}

/* Once a pulse is overdue the speed is hearsay: the voltage stands still, though the ramp goes on. */
static void test_voltage_is_held_while_a_pulse_is_overdue(void) {
    begin(330.0f);
    go_on_until(WH_PHASE_RAMP);
    for (unsigned i = 0; i < 800U; i++) {
        control();
    }
    TEST_ASSERT_TRUE(rig.run.phase == WH_PHASE_RAMP);
    hal_virtual_rig_instance()->faults.dead_sensor[0] = true;
    hal_virtual_rig_instance()->faults.dead_sensor[1] = true;
    unsigned held = 0;
    float held_V = 0.0f;
    while (rig.guard.trip == WH_TRIP_NONE && held < 1000U) {
        if (wh_speed_is_overdue(&rig.pulses.speed, hal_clock_ticks())) {
            held_V = held == 0 ? rig.run.volts : held_V;
            TEST_ASSERT_FLOAT_WITHIN(0.0f, held_V, rig.run.volts);
            held++;
        }
        control();
    }
    TEST_ASSERT_TRUE(held > 50U && held < 1000U);
    TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_PULSES);
}

static void test_stuck_load_cell_stops_the_rig(void) {
    begin(330.0f);
    go_on_until(WH_PHASE_SETTLE);
    hal_virtual_rig_instance()->faults.stuck_load_cell = true;
    go_on_to_the_end();
    TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_LOAD_CELL);
    check_stopped();
}

/* A drive stage stuck at full supply obeys no voltage: the guard trips, the enable cuts. How fast the
 * rotor gets depends on where in a turn it happens. docs/rig.md: the shaft's safety factor is 2 at
 * 416 rpm and falls with the square, to 1.28 at 520 rpm and 1.5 at 480. */
static void test_runaway_is_caught(void) {
    for (unsigned i = 0; i < 10U; i++) {
        const bool recording = i % 2U == 1;
        begin(330.0f);
        go_on_until(recording ? WH_PHASE_RECORD : WH_PHASE_SETTLE);
        for (unsigned step = 0; step < i * 9U; step++) {
            control();
        }
        fastest_radps = 0.0f;
        hal_virtual_rig_instance()->faults.runaway_motor = true;
        go_on_to_the_end();
        if (!recording) { /* a record does not wait for over-speed */
            TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_OVERSPEED);
            TEST_ASSERT_TRUE(fastest_radps > 400.0f * RPM);
        }
        TEST_ASSERT_TRUE(rig.guard.trip != WH_TRIP_NONE);
        TEST_ASSERT_TRUE(fastest_radps < (recording ? 480.0f : 520.0f) * RPM);
        TEST_ASSERT_FALSE(hal_virtual_rig_instance()->enabled || hal_watchdog_has_cut());
        check_stopped();
    }
}

/* A controller that falls silent: within 10 control steps the motor is cut, and stays cut. */
static void test_watchdog_cuts_the_motor(void) {
    begin(330.0f);
    go_on_until(WH_PHASE_RECORD);
    TEST_ASSERT_FALSE(hal_watchdog_has_cut());
    const uint32_t silent = hal_clock_ticks();
    hal_clock_wait_until(silent + 9U * CONTROL_TICKS);
    TEST_ASSERT_FALSE(hal_watchdog_has_cut());
    hal_clock_wait_until(silent + 11U * CONTROL_TICKS);
    TEST_ASSERT_TRUE(hal_watchdog_has_cut());
    hal_watchdog_kick();
    hal_motor_set_voltage(HAL_VIRTUAL_RATED_V);
    hal_clock_wait_until(silent + 2500U * CONTROL_TICKS);
    TEST_ASSERT_FLOAT_WITHIN(0.1f, 0.0f, hal_virtual_rig_speed_radps(hal_virtual_rig_instance()));
    go_on_to_the_end();
    TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_WATCHDOG);
    check_stopped();
}

static void test_too_slow_and_too_fast_targets_are_refused(void) {
    static const float targets_rpm[] = {120.0f, 400.0f};
    for (unsigned i = 0; i < 2; i++) {
        arm();
        TEST_ASSERT_TRUE(order(WH_EVENT_START, targets_rpm[i] * RPM) == WH_REFUSED_TARGET);
        for (unsigned step = 0; step < 1000U; step++) {
            control();
        }
        TEST_ASSERT_FLOAT_WITHIN(0.001f, 0.0f, fastest_radps);
        TEST_ASSERT_TRUE(order(WH_EVENT_STOP, 0.0f) == WH_ALLOWED);
        check_stopped();
    }
}

/* The controller's data sheet and the model are written down apart: they must say the same. */
static void test_data_sheet_agrees_with_the_model(void) {
    wh_real output[8];
    wh_state state;
    static uint64_t memory[WH_STATE_WORDS(1, 1, 1)];
    TEST_ASSERT_EQUAL_UINT(3, rig_fixed.outputs);
    TEST_ASSERT_TRUE(wh_scene_start(&rig_fixed, &state, memory, sizeof memory) == WH_OK);
    state.real[0] = 10.0f;
    rig_fixed.observe(&rig_fixed, &state, output);
    TEST_ASSERT_FLOAT_WITHIN(1e-5f, 100.0f * WH_RIG_MASS_MOMENT_KGM, output[2]);
    TEST_ASSERT_FLOAT_WITHIN(1e-5f, output[2], output[1]); /* mass on the axis: all of it shows */
    /* level, the force is S times what the speed changes by: gravity, and the damping with the speed */
    state.angle[0] = wh_angle_from_rad(0.25f * WH_RIG_TWO_PI);
    state.real[0] = 0.0f;
    state.input[0] = 0.0f;
    rig_fixed.observe(&rig_fixed, &state, output);
    const float falls = WH_RIG_MASS_MOMENT_KGM * WH_RIG_GRAVITY_MPS2 / WH_RIG_INERTIA_KGM2;
    TEST_ASSERT_FLOAT_WITHIN(1e-5f, -WH_RIG_MASS_MOMENT_KGM * falls, output[1]);
    state.real[0] = 20.0f;
    rig_fixed.observe(&rig_fixed, &state, output);
    const float slows = WH_RIG_DAMPING_NMS * 20.0f / WH_RIG_INERTIA_KGM2;
    TEST_ASSERT_FLOAT_WITHIN(1e-5f, -WH_RIG_MASS_MOMENT_KGM * (falls + slows), output[1]);
}

static void test_a_foreign_scene_is_refused(void) {
    static hal_virtual_rig other;
    wh_scene scene = rig_fixed;
    scene.inputs = 2;
    TEST_ASSERT_FALSE(hal_virtual_rig_start(&other, &scene));
    TEST_ASSERT_TRUE(hal_virtual_rig_start(&other, &rig_fixed));
}

#endif

void suite_virtual_rig(void) {
    RUN_TEST(test_mass_moment_gives_the_dissertations_force);
#if !WH_DOUBLE
    RUN_TEST(test_measurement_of_the_force);
    RUN_TEST(test_gravity_shows_in_the_peaks_and_spikes);
    RUN_TEST(test_a_noisy_cell_is_no_fault);
    RUN_TEST(test_pulses_stand_at_their_angles);
    RUN_TEST(test_lost_pulses_do_not_spoil_the_run);
    RUN_TEST(test_slowest_and_fastest_set_points_run);
    RUN_TEST(test_slower_set_points_end_at_the_top);
    RUN_TEST(test_a_silent_load_cell_stops_the_rig);
    RUN_TEST(test_dead_sensors_stop_the_rig);
    RUN_TEST(test_voltage_is_held_while_a_pulse_is_overdue);
    RUN_TEST(test_stuck_load_cell_stops_the_rig);
    RUN_TEST(test_runaway_is_caught);
    RUN_TEST(test_watchdog_cuts_the_motor);
    RUN_TEST(test_too_slow_and_too_fast_targets_are_refused);
    RUN_TEST(test_data_sheet_agrees_with_the_model);
    RUN_TEST(test_a_foreign_scene_is_refused);
#endif
}

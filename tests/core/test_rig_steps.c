/* test_rig_steps.c: the rig's run step by step: the exact duration and end of each phase (docs/rig.md), and the result
 * of a full record. */
#include <stddef.h>

#include "even_rig.h"
#include "tests/suites.h"

#define RPM EVEN_RPM
#define STEP_TICKS EVEN_STEP_TICKS
#define STEPS_PER_S 500U

static wh_rig rig;
static wh_rig_config config;
static wh_rig_inputs inputs;
static wh_rig_command command;

static void begin(void) {
    config = even_config();
    /* the timer wraps during the run */
    inputs = (wh_rig_inputs){.now_ticks = UINT32_MAX - 3000000U, .supply_V = WH_RIG_RATED_V};
    wh_rig_start(&config, &rig, inputs.now_ticks, NULL);
    rig.state = WH_RIG_RUNNING;
    wh_run_start(&rig.run, WH_R(330.0) * RPM, inputs.now_ticks);
}

/* Puts the rig into this phase at the target speed. No check of the guard trips. */
static void stand_in(wh_rig_phase phase) {
    begin();
    rig.state = phase == WH_PHASE_NONE       ? WH_RIG_IDLE
                : phase < WH_PHASE_RAMP_DOWN ? WH_RIG_RUNNING
                                             : WH_RIG_STOPPING;
    rig.run.phase = phase;
    rig.pulses.speed.known = true;
    rig.pulses.speed.running = true;
    rig.pulses.alternate = WH_GUARD_COASTS; /* the rotor turns */
    rig.pulses.speed.turn_radps = WH_R(330.0) * RPM;
    rig.run.drive.setpoint_radps = rig.run.drive.target_radps = rig.run.target_radps;
    rig.run.off_radps = WH_R(330.0) * RPM;
    for (rig.run.turns = 0; rig.run.turns < WH_RUN_TURNS; rig.run.turns++) {
        rig.run.turn_radps[rig.run.turns] = rig.run.mean_radps = rig.run.target_radps;
    }
    wh_measure_record(&config.measure, &rig.measure, rig.run.target_radps, inputs.now_ticks);
}

static void stand_tripped(wh_trip trip) {
    stand_in(WH_PHASE_NONE);
    rig.state = WH_RIG_TRIPPED;
    wh_guard_trip(&rig.guard, trip);
}

static void step(void) {
    inputs.now_ticks += STEP_TICKS;
    command = wh_rig_step(&config, &rig, &inputs);
}

/* Does a step with the pulse that the guard expects. */
static void step_on(void) {
    rig.pulses.speed.ticks = inputs.now_ticks + STEP_TICKS;
    step();
}

/* Does steps, with regular pulses and loads, until the phase changes, but at most `steps`. Returns their number. */
static unsigned stay(wh_real speed_rpm, unsigned steps) {
    const wh_rig_phase phase = rig.run.phase;
    unsigned done = 0;
    while (done < steps && rig.run.phase == phase) {
        rig.pulses.speed.turn_radps = speed_rpm * RPM;
        /* The first WH_RUN_TURNS steps count as pulses, so that the mean over the turns is this speed. */
        rig.pulses.speed.taken += done < WH_RUN_TURNS ? 1U : 0U;
        wh_rig_load(&config, &rig, inputs.now_ticks + STEP_TICKS, done % 2U == 0 ? 0 : 450,
                    WH_LOAD_OK);
        step_on();
        done++;
    }
    return done;
}

static bool same_text(const char *x, const char *y) {
    while (*x != 0 && *x == *y) {
        x++;
        y++;
    }
    return *x == *y;
}

typedef const char *words_of(int number);

static const char *life_text(int number) { return wh_rig_state_text((wh_rig_state)number); }
static const char *phase_text(int number) { return wh_phase_text((wh_rig_phase)number); }
static const char *event_text(int number) { return wh_rig_event_text((wh_rig_event)number); }
static const char *refusal_text(int number) { return wh_refusal_text((wh_refusal)number); }
static const char *why_text(int number) { return wh_why_text((wh_why)number); }
static const char *quality_text(int number) { return wh_quality_text((wh_quality)number); }
static const char *swing_text(int number) { return wh_swing_text((wh_swing_why)number); }

/* Returns the words of a trip's number. Number 1 is no trip. */
static const char *trip_text(int number) {
    return wh_trip_text(number == 0 ? WH_TRIP_NONE : (wh_trip)(number + 1));
}

static void check_words(words_of *words, int count) {
    for (int i = 0; i <= count; i++) {
        TEST_ASSERT_NOT_NULL(words(i));
        for (int k = 0; k < i; k++) {
            TEST_ASSERT_FALSE(same_text(words(i), words(k)));
        }
    }
}

TEST(rig_steps, states_and_reasons_have_unique_words) {
    check_words(life_text, (int)WH_RIG_STATES);
    check_words(phase_text, (int)WH_PHASES);
    check_words(event_text, (int)WH_EVENTS);
    check_words(refusal_text, (int)WH_REFUSALS);
    check_words(why_text, (int)WH_WHYS);
    check_words(quality_text, (int)WH_REFUSED + 1);
    check_words(swing_text, (int)WH_SWING_WHYS);
    check_words(trip_text, (int)WH_TRIP_UNBRAKED);
}

TEST(rig_steps, pulse_of_no_sensor_is_rejected) {
    stand_in(WH_PHASE_SETTLE);
    const wh_rig before = rig;
    for (unsigned sensor = WH_RIG_SENSORS; sensor < 260U; sensor++) {
        wh_rig_pulse(&config, &rig, sensor, inputs.now_ticks);
    }
    TEST_ASSERT_EQUAL_UINT32(before.pulses.rejected + 258U, rig.pulses.rejected);
    rig.pulses.rejected = before.pulses.rejected;
    TEST_ASSERT_EQUAL_MEMORY(&before, &rig, sizeof rig);
}

TEST(rig_steps, tare_is_the_mean_of_samples) {
    begin();
    TEST_ASSERT_EQUAL_UINT(250, stay(WH_R(0.0), 1000)); /* half a second */
    TEST_ASSERT_TRUE(rig.run.phase == WH_PHASE_SPIN_UP);
    CHECK_NEAR(1e-5f, 2.25f, rig.measure.tare.mean_N); /* mean of 0 and 450 counts */
    CHECK_NEAR(1e-6f, 9.6f, command.volts);
    TEST_ASSERT_FALSE(rig.pulses.speed.running); /* the pulses so far are discarded */
    /* Next case: invalid samples, which do not count. */
    begin();
    for (unsigned i = 0; i < 500; i++) {
        wh_rig_load(&config, &rig, inputs.now_ticks, 9, WH_LOAD_LATE);
    }
    TEST_ASSERT_EQUAL_UINT(250, stay(WH_R(0.0), 1000));
    CHECK_NEAR(1e-5f, 2.25f, rig.measure.tare.mean_N);
    /* as many pulses as jitter makes, or one more */
    for (unsigned pulses = 2; pulses <= 3; pulses++) {
        begin();
        for (unsigned i = 0; i < pulses; i++) {
            inputs.now_ticks += 100000U;
            wh_rig_load(&config, &rig, inputs.now_ticks, 0, WH_LOAD_OK);
            wh_rig_pulse(&config, &rig, 0, inputs.now_ticks);
        }
        stay(WH_R(0.0), 1000);
        TEST_ASSERT_TRUE(rig.guard.trip == (pulses == 2U ? WH_TRIP_NONE : WH_TRIP_MOVING));
    }
}

TEST(rig_steps, loop_closes_at_its_speed) {
    stand_in(WH_PHASE_SPIN_UP);
    rig.pulses.speed.lost = 3;
    TEST_ASSERT_EQUAL_UINT(100, stay(WH_R(149.9), 100));
    rig.pulses.speed.known = false;
    TEST_ASSERT_EQUAL_UINT(100, stay(WH_R(200.0), 100));
    rig.pulses.speed.known = true;
    TEST_ASSERT_EQUAL_UINT(1, stay(WH_R(150.1), 100));
    TEST_ASSERT_TRUE(rig.run.phase == WH_PHASE_RAMP);
    TEST_ASSERT_EQUAL_UINT32(3, rig.guard.lost_before);
    CHECK_NEAR(1e-3f, 150.1f, rig.run.drive.setpoint_radps / RPM);
    /* The voltage does not jump. */
    CHECK_NEAR(1e-6f, command.volts, rig.run.drive.integral_V);
    TEST_ASSERT_EQUAL_UINT(1, stay(WH_R(150.1), 1));
    CHECK_NEAR(1e-3f, 330.0f, rig.run.drive.target_radps / RPM);

    stand_in(WH_PHASE_SPIN_UP); /* the spin-up takes at most eight seconds */
    TEST_ASSERT_EQUAL_UINT(8U * STEPS_PER_S + 1U, stay(WH_R(100.0), 10000));
    TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_STALLED);
}

/* The voltage starts at 9.6 V and rises by 2 V per second, up to the rated voltage and to the supply. */
TEST(rig_steps, spin_up_voltage_rises) {
    static const wh_real supplies_V[] = {WH_R(12.0), WH_R(24.0), WH_R(36.0)};
    for (unsigned i = 0; i < 3; i++) {
        stand_in(WH_PHASE_SPIN_UP);
        inputs.supply_V = supplies_V[i];
        for (unsigned k = 1; k < 4000U; k++) {
            TEST_ASSERT_EQUAL_UINT(1, stay(WH_R(100.0), 1));
            const float asked = 9.6f + 2.0f * (float)k / (float)STEPS_PER_S;
            const float most = i == 0 ? 12.0f : 24.0f;
            CHECK_NEAR(1e-4f, asked < most ? asked : most, command.volts);
        }
    }
}

/* The ramp has 60 rpm per second: three seconds from 150 to 330 rpm. */
TEST(rig_steps, ramp_has_its_rate) {
    stand_in(WH_PHASE_RAMP);
    rig.run.drive.setpoint_radps = WH_R(150.0) * RPM;
    const unsigned steps = stay(WH_R(330.0), 10000);
    TEST_ASSERT_TRUE(rig.run.phase == WH_PHASE_SETTLE);
    TEST_ASSERT_TRUE(steps >= 3U * STEPS_PER_S - 1U && steps <= 3U * STEPS_PER_S + 1U);
}

TEST(rig_steps, the_speed_settles_within_its_band) {
    static const wh_real inside_rpm[] = {WH_R(330.0), WH_R(330.49), WH_R(329.51)};
    static const wh_real outside_rpm[] = {WH_R(330.51), WH_R(329.49)};
    for (unsigned i = 0; i < 3; i++) {
        stand_in(WH_PHASE_SETTLE);
        TEST_ASSERT_EQUAL_UINT(5U * STEPS_PER_S / 2U, stay(inside_rpm[i], 10000));
        TEST_ASSERT_TRUE(rig.run.phase == WH_PHASE_RECORD);
    }
    for (unsigned i = 0; i < 2; i++) { /* a mean outside the band restarts the time */
        stand_in(WH_PHASE_SETTLE);
        TEST_ASSERT_EQUAL_UINT(1000, stay(WH_R(330.0), 1000));
        TEST_ASSERT_EQUAL_UINT(WH_RUN_TURNS, stay(outside_rpm[i], WH_RUN_TURNS));
        TEST_ASSERT_EQUAL_UINT(5U * STEPS_PER_S / 2U, stay(WH_R(330.0), 10000));
        stand_in(WH_PHASE_SETTLE); /* within twenty seconds the rig must settle */
        TEST_ASSERT_EQUAL_UINT(20U * STEPS_PER_S + 1U, stay(outside_rpm[i], 20000));
        TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_UNSETTLED);
    }
}

TEST(rig_steps, speed_outside_the_band_trips) {
    static const wh_real rpm[] = {WH_R(331.99), WH_R(328.01), WH_R(332.01), WH_R(327.99)};
    for (unsigned i = 0; i < 4; i++) {
        stand_in(WH_PHASE_RECORD);
        const bool good = i < 2;
        TEST_ASSERT_EQUAL_UINT(good ? 900 : 1, stay(rpm[i], 900));
        TEST_ASSERT_TRUE(rig.guard.trip == (good ? WH_TRIP_NONE : WH_TRIP_UNSETTLED));
    }
}

/* A rotor without a pulse for 1.5 s counts as at rest. The rig waits for rest for at most two minutes, or 20 s after a
 * trip. */
TEST(rig_steps, rest_is_waited_for) {
    for (unsigned i = 0; i < 4; i++) {
        const bool trips = i % 2U == 1;
        const bool pulses = i >= 2U;
        if (trips) {
            stand_tripped(WH_TRIP_OVERSPEED);
        } else {
            stand_in(WH_PHASE_OFF);
        }
        const wh_rig_state state = rig.state;
        uint32_t steps = 0;
        for (; steps < 70000U && rig.state == state && !rig.rested; steps++) {
            if (pulses ? steps % 150U == 0 : steps == 0) { /* pulses at 200 rpm */
                wh_rig_pulse(&config, &rig, 0, inputs.now_ticks + STEP_TICKS);
            }
            step();
            TEST_ASSERT_TRUE(command.way != WH_MOTOR_DRIVES);
            CHECK_NEAR(0.0f, 0.0f, command.volts);
        }
        if (pulses) {
            TEST_ASSERT_EQUAL_UINT32((trips ? 20U : 120U) * STEPS_PER_S + 1U, steps);
            TEST_ASSERT_TRUE(rig.guard.trip == (trips ? WH_TRIP_OVERSPEED : WH_TRIP_RUNS_ON));
        } else {
            TEST_ASSERT_EQUAL_UINT32(3U * STEPS_PER_S / 2U + 1U, steps);
            TEST_ASSERT_TRUE(trips ? rig.rested : rig.state == WH_RIG_IDLE);
        }
    }
    stand_in(WH_PHASE_OFF); /* without any pulse, the time is counted from the begin of the phase */
    rig.pulses.speed.running = false;
    unsigned steps = 0;
    for (; steps < 20000U && rig.state == WH_RIG_STOPPING; steps++) {
        step();
    }
    TEST_ASSERT_EQUAL_UINT(3U * STEPS_PER_S / 2U, steps);
    TEST_ASSERT_TRUE(rig.state == WH_RIG_IDLE && rig.run.phase == WH_PHASE_NONE);
}

/* Time differences wrap after 71.6 minutes. A rig at rest after a trip stays at rest through two wraps. */
TEST(rig_steps, rest_outlasts_a_timer_wrap) {
    const wh_trip trips[] = {WH_TRIP_WATCHDOG,
                             WH_TRIP_PULSES}; /* after this trip, only the time shows rest */
    for (unsigned i = 0; i < 2; i++) {
        stand_tripped(trips[i]);
        const uint32_t begins = inputs.now_ticks;
        uint32_t waited = 0;
        for (; waited < 70000U && !rig.rested; waited++) {
            step();
        }
        TEST_ASSERT_TRUE(waited > STEPS_PER_S && waited < 70000U);
        for (unsigned k = 0; k < 9000U; k++) { /* slightly more than a second each: 2.6 hours */
            inputs.now_ticks += 1048573U - STEP_TICKS;
            step();
            TEST_ASSERT_TRUE(rig.rested && rig.guard.quiet);
        }
        inputs.now_ticks = begins - STEP_TICKS;
        for (unsigned k = 0; k < 3000U; k++) { /* single steps just after the next wrap */
            step();
            TEST_ASSERT_TRUE(rig.rested && rig.guard.quiet);
        }
    }
}

/* In any phase a late controller or over-speed ends the run. With the motor off, over-speed has another trip. */
TEST(rig_steps, trips_in_each_phase) {
    for (wh_rig_phase phase = WH_PHASE_NONE; phase < WH_PHASES; phase++) {
        stand_in(phase);
        rig.rested = true; /* the rotor was at rest before the fault */
        inputs.watchdog_has_cut = true;
        step_on();
        TEST_ASSERT_TRUE(rig.state == WH_RIG_TRIPPED && rig.guard.trip == WH_TRIP_WATCHDOG);
        TEST_ASSERT_FALSE(rig.rested);
        for (unsigned unknown = 0; unknown < 2; unknown++) {
            stand_in(phase);
            rig.run.drive.setpoint_radps = WH_R(0.0); /* far from the target: the ramp goes on */
            rig.run.off_radps = unknown == 1 ? config.guard.limit_radps : WH_R(0.0);
            rig.pulses.speed.turn_radps = WH_R(401.0) * RPM;
            step_on();
            const bool drives = phase >= WH_PHASE_SPIN_UP && phase <= WH_PHASE_RAMP_DOWN;
            TEST_ASSERT_TRUE(rig.state == WH_RIG_TRIPPED);
            TEST_ASSERT_TRUE(rig.guard.trip ==
                             (drives || unknown == 1 ? WH_TRIP_OVERSPEED : WH_TRIP_RUNS_ON));
        }
    }
}

/* The run gets turns with a known load as results of the lock-in. The record ends after its time. */
TEST(rig_steps, results_of_a_record) {
    stand_in(WH_PHASE_SETTLE);
    rig.measure.tare.mean_N = WH_R(0.4);
    rig.pulses.speed.lost = 5;
    rig.guard.lost_before = 3;
    rig.pulses.rejected = 4;
    rig.run.volts = WH_R(12.0);
    /* A turn has 91 samples of a triangular load with a mean of 10.45 N. */
    const uint32_t turn = 91U * STEP_TICKS;
    uint32_t first = inputs.now_ticks + STEP_TICKS;
    unsigned sample = 0;
    while (rig.run.phase <= WH_PHASE_RECORD && sample < 5000U) {
        inputs.now_ticks += STEP_TICKS;
        rig.pulses.speed.turn_radps = WH_R(330.0) * RPM;
        rig.pulses.speed.ticks = inputs.now_ticks;
        const uint32_t part = (inputs.now_ticks - first) % turn;
        if (part == 0) {
            wh_lockin_pulse(&rig.measure.lockin, 0, inputs.now_ticks - 1000U,
                            4U * ((inputs.now_ticks - first) / turn));
        } else if (part == 23U * STEP_TICKS) {
            wh_lockin_pulse(&rig.measure.lockin, 1, inputs.now_ticks - 1000U,
                            4U * ((inputs.now_ticks - first) / turn) + 1U);
        }
        const unsigned k = sample % 91U;
        wh_rig_load(&config, &rig, inputs.now_ticks, (int32_t)(1040 + 40 * (k < 46U ? k : 91U - k)),
                    WH_LOAD_OK);
        command = wh_rig_step(&config, &rig, &inputs);
        sample++;
    }
    TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_NONE && rig.run.phase == WH_PHASE_RAMP_DOWN);
    const wh_rig_result *result = &rig.result;
    TEST_ASSERT_EQUAL_UINT32(10, result->force.turns);
    CHECK_NEAR(1e-3f, 60.0f / 0.182f, result->force.speed_radps / RPM);
    CHECK_NEAR(1e-5f, 0.4f, result->tare_N);
    CHECK_NEAR(1e-4f, 10.0f, result->low_N);
    CHECK_NEAR(1e-4f, 28.0f, result->high_N);
    /* Sensor 1's pulse is half a sample before the turn's first sample, sensor 2's half a sample before its 23rd. */
    CHECK_NEAR(2e-3f, 10.2f, result->force.at_pulse_N[0]);
    CHECK_NEAR(2e-3f, 19.0f, result->force.at_pulse_N[1]);
    /* The mean of the load is 2 (0 + ... + 45) 0.4 / 91. */
    CHECK_NEAR(0.01f, 10.0f + 9.0989f, result->force.mean_N);
    TEST_ASSERT_TRUE(result->force.quality ==
                     WH_REFUSED); /* 8 N is not the force of these masses */
    TEST_ASSERT_EQUAL_UINT32(2, result->lost);
    TEST_ASSERT_EQUAL_UINT32(4, result->rejected);
    CHECK_NEAR(1e-3f, 200.0f, rig.run.drive.target_radps / RPM);
    TEST_ASSERT_TRUE(result->volts >= WH_R(0.0) && result->volts <= WH_RIG_RATED_V);
}

TEST(rig_steps, a_record_without_turns_trips) {
    stand_in(WH_PHASE_RECORD);
    TEST_ASSERT_EQUAL_UINT(1009, stay(WH_R(330.0), 5000));
    TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_RECORD);
    stand_in(WH_PHASE_RECORD); /* the lock-in waits for samples that do not come */
    rig.measure.lockin.stage = WH_LOCKIN_SUMS;
    rig.measure.lockin.next.begin_ticks = inputs.now_ticks + 100000000U;
    TEST_ASSERT_EQUAL_UINT(1259, stay(WH_R(330.0), 5000));
    TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_RECORD);
}

TEST(rig_steps, edges_belong_to_the_bands) {
    for (int side = -1; side <= 1; side += 2) {
        stand_in(WH_PHASE_SETTLE);
        config.run.settle_band_radps = WH_R(0.5);
        config.run.record_band_radps = WH_R(1.0);
        rig.run.target_radps = WH_R(32.0);
        TEST_ASSERT_EQUAL_UINT(1250, stay((WH_R(32.0) + (wh_real)side * WH_R(0.5)) / RPM, 10000));
        TEST_ASSERT_TRUE(rig.run.phase == WH_PHASE_RECORD);
        TEST_ASSERT_EQUAL_UINT(8, stay((WH_R(32.0) + (wh_real)side) / RPM, 8));
        TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_NONE);
    }
}

/* test_rig_run.c: a whole run of the rig on an imitated rotor of constant speed, with disturbances. */
#include "draw.h"
#include "even_rig.h"

#include "tests/suites.h"

static even_rig even;

static void begin(wh_real target_rpm, even_failure failing) {
    even_begin(&even, target_rpm, &failing);
}

static void run(wh_real target_rpm, even_failure failing) { even_run(&even, target_rpm, &failing); }

static void go_on_until(wh_rig_phase phase) { even_go_on_until(&even, phase); }

static void check_trip(wh_trip trip) {
    TEST_ASSERT_EQUAL_INT(trip, even.rig.guard.trip);
    TEST_ASSERT_TRUE(trip == WH_TRIP_NONE || even.rig.state == WH_RIG_TRIPPED);
}

/* Checks that the imitated load is measured as accurately as by the lock-in in test_lockin.c. The speed within a turn
 * is constant to one tick, 6e-6 of a turn. */
static void check_measured(unsigned turns_wanted) {
    check_trip(WH_TRIP_NONE);
    TEST_ASSERT_TRUE(even_is_done(&even));
    const wh_measured *result = &even.rig.result.force;
    TEST_ASSERT_EQUAL_UINT32(turns_wanted, result->turns);
    TEST_ASSERT_TRUE(result->quality == WH_GOOD && result->why == WH_WHY_NONE);
    TEST_ASSERT_TRUE(result->amplitude_half_N > WH_R(0.0) && result->amplitude_half_N < WH_R(0.02));
    TEST_ASSERT_TRUE(result->phase_half_rad > WH_R(0.0) && result->phase_half_rad < WH_R(5e-4));
    CHECK_NEAR(0.003f, 330.0f, result->speed_radps / EVEN_RPM);
    CHECK_NEAR(0.011f, EVEN_LOAD_N, result->amplitude_N);
    CHECK_NEAR(0.02f, 0.0f, result->phase_rad * WH_RIG_DEG_PER_RAD);
    CHECK_NEAR(0.011f, 0.0f, result->mean_N);
}

static void check_result(void) { check_measured(10); }

TEST(rig_run, a_faultless_run_finds_the_load) {
    run(WH_R(330.0), (even_failure){.in = EVEN_NEVER});
    check_result();
    TEST_ASSERT_EQUAL_UINT32(0, even.rig.result.lost + even.rig.result.rejected);
}

/* From the middle of the record on, one or both sensors lose pulses: as many as the guard tolerates, but never two in
 * succession. If the begin or end of a turn is unknown, the turn is not used. */
TEST(rig_run, turns_with_lost_pulses_are_skipped) {
    for (unsigned lost = 1; lost <= wh_rig_standard.guard.lost_max; lost++) {
        for (unsigned sensor = 0; sensor < WH_RIG_SENSORS; sensor++) {
            even_failure failing = {.in = WH_PHASE_RECORD, .after_ticks = 700000U};
            failing.lose[sensor] = lost;
            run(WH_R(330.0), failing);
            if (sensor == 0 && lost > 1) {
                /* Too many turns are not used, because sensor 1 begins and ends the turns. */
                TEST_ASSERT_TRUE(even.rig.result.force.quality == WH_DOUBTFUL);
                TEST_ASSERT_TRUE(even.rig.result.force.why == WH_WHY_LEFT_OUT);
            } else {
                check_measured(sensor == 0 ? 8U : 10U);
            }
            TEST_ASSERT_EQUAL_UINT32(sensor == 0 ? lost + 1U : 0U, even.rig.result.force.left_out);
            TEST_ASSERT_EQUAL_UINT32(lost, even.rig.result.lost);
        }
    }
}

/* After two lost pulses in succession the count of turns restarts, and the turns in the gap are not used. */
TEST(rig_run, turns_in_a_gap_are_skipped) {
    run(WH_R(330.0), (even_failure){.in = WH_PHASE_RECORD, .after_ticks = 700000U, .lose = {1, 1}});
    check_measured(8);
    TEST_ASSERT_EQUAL_UINT32(1, even.rig.result.force.left_out);
    run(WH_R(330.0), (even_failure){.in = WH_PHASE_RECORD, .after_ticks = 700000U, .lose = {2, 2}});
    check_measured(7);
}

TEST(rig_run, a_gap_before_the_record_is_bridged) {
    run(WH_R(330.0), (even_failure){.in = WH_PHASE_SETTLE, .after_ticks = 700000U, .lose = {1, 1}});
    check_result();
    TEST_ASSERT_EQUAL_UINT32(2, even.rig.result.lost);
}

/* A false pulse anywhere in a turn of the record is rejected. */
TEST(rig_run, extra_pulse_changes_no_result) {
    for (unsigned part = 0; part < 40U; part++) {
        even_failure failing = {.in = WH_PHASE_RECORD, .after_ticks = 700000U + part / 2U * 9000U};
        failing.adds[part % 2U] = true;
        run(WH_R(330.0), failing);
        check_result();
        TEST_ASSERT_EQUAL_UINT32(1, even.rig.result.rejected);
    }
}

/* The rotor hangs with its slot at sensor 1, where jitter makes pulses. */
TEST(rig_run, pulse_during_the_tare_is_ignored) {
    for (uint32_t after = 0; after <= 490000U; after += 490000U) {
        run(WH_R(330.0),
            (even_failure){.in = WH_PHASE_TARE, .after_ticks = after, .adds = {true, false}});
        check_result();
    }
}

/* With swapped cables or a reversed motor the phase would be wrong: the rig trips. */
TEST(rig_run, sensors_in_the_wrong_order_trip) {
    static const wh_real targets_rpm[] = {WH_R(170.0), WH_R(240.0), WH_R(330.0)};
    for (unsigned i = 0; i < 3; i++) {
        run(targets_rpm[i], (even_failure){.in = EVEN_NEVER, .swapped = true});
        check_trip(WH_TRIP_ORDER);
    }
}

TEST(rig_run, a_dead_sensor_trips) {
    for (unsigned sensor = 0; sensor < WH_RIG_SENSORS; sensor++) {
        for (wh_rig_phase in = WH_PHASE_SPIN_UP; in <= WH_PHASE_RECORD; in++) {
            even_failure failing = {.in = in};
            failing.lose[sensor] = EVEN_ALWAYS;
            run(WH_R(330.0), failing);
            check_trip(WH_TRIP_PULSES);
        }
    }
}

/* The load of a jammed rotor is constant, too, but the trip must not blame the cell. */
TEST(rig_run, jammed_rotor_is_blamed_on_pulses) {
    for (wh_rig_phase in = WH_PHASE_SPIN_UP; in <= WH_PHASE_RECORD; in++) {
        run(WH_R(330.0), (even_failure){.in = in, .after_ticks = 200000U, .jams = true});
        check_trip(WH_TRIP_PULSES);
    }
}

static uint64_t seed;

static wh_real between(wh_real least, wh_real most) {
    return least + (most - least) * draw_whole(&seed, 0, 65535) / WH_R(65535.0);
}

/* Jitter of up to 150 us (standard deviation, uniform) does not count as a change of speed: the run settles and
 * records, and its intervals contain the true values. The phase's interval also covers the mean delay. */
TEST(rig_run, jitter_settles) {
    seed = 61;
    for (unsigned i = 0; i < 60U; i++) {
        /* Half of the speeds are near 330 rpm, to which the imitated load belongs. */
        const wh_real target_rpm =
            i % 2U == 0 ? between(WH_R(324.0), WH_R(336.0)) : between(WH_R(170.0), WH_R(360.0));
        const wh_real jitter_s = i < 10U ? WH_R(120e-6) : between(WH_R(0.0), WH_R(150e-6));
        const uint32_t width = (uint32_t)(jitter_s * WH_R(3.4641e6));
        even_begin(&even, i < 10U ? WH_R(330.0) : target_rpm,
                   &(even_failure){.in = EVEN_NEVER, .jitter_ticks = width});
        even.seed = 1000U + i;
        even_go_on_until(&even, EVEN_NEVER);
        check_trip(WH_TRIP_NONE);
        TEST_ASSERT_TRUE(even_is_done(&even));
        const wh_measured *result = &even.rig.result.force;
        TEST_ASSERT_TRUE(result->quality == WH_GOOD || (i >= 10U && i % 2U != 0));
        const wh_real late_rad =
            WH_R(0.5) * (wh_real)width / (wh_real)WH_RIG_TICKS_PER_S * result->speed_radps;
        TEST_ASSERT_TRUE(WH_ABS(result->phase_rad - late_rad) <=
                         WH_R(2.0) * result->phase_half_rad);
        TEST_ASSERT_TRUE(WH_ABS(result->amplitude_N - EVEN_LOAD_N) <=
                         WH_R(2.0) * result->amplitude_half_N + WH_R(0.02));
    }
}

/* A speed that oscillates by 1 rpm or more with a period of 2 to 8 s, or drifts by 0.6 rpm/s or more, does not settle,
 * with any jitter. */
TEST(rig_run, unsteady_speed_does_not_settle) {
    unsigned unsettled = 0;
    seed = 62;
    for (unsigned i = 0; i < 40U; i++) {
        even_failure failing = {.in = EVEN_NEVER, .jitter_ticks = (uint32_t)between(0, 400)};
        if (i % 2U == 0) {
            failing.hunts_rpm = between(WH_R(1.0), WH_R(4.0));
            failing.hunts_Hz = between(WH_R(0.125), WH_R(0.5));
        } else {
            failing.drifts_rpm_s =
                (i % 4U == 1U ? WH_R(1.0) : WH_R(-1.0)) * between(WH_R(0.6), WH_R(2.0));
        }
        even_begin(&even, between(WH_R(200.0), WH_R(320.0)), &failing);
        even.seed = 2000U + i;
        even_go_on_until(&even, EVEN_NEVER);
        TEST_ASSERT_TRUE(even.rig.guard.trip != WH_TRIP_NONE && !even.rig.has_result);
        unsettled += even.rig.guard.trip == WH_TRIP_UNSETTLED ? 1U : 0U;
    }
    /* These runs do not settle. In the others the drive's voltage reached its limit. */
    TEST_ASSERT_TRUE(unsettled >= 20U);
}

/* A cell stops giving samples. In every state that needs the cell, the run ends within 10 sample periods and a step. */
TEST(rig_run, silent_load_cell_trips) {
    for (wh_rig_phase in = WH_PHASE_TARE; in <= WH_PHASE_RAMP_DOWN; in++) {
        begin(WH_R(330.0), (even_failure){.in = in, .lose_samples = EVEN_ALWAYS});
        go_on_until(in);
        const uint32_t silent = even.inputs.now_ticks;
        for (unsigned step = 0; step < 100U && even.rig.state != WH_RIG_TRIPPED; step++) {
            even_step(&even);
        }
        check_trip(WH_TRIP_LOAD_CELL);
        TEST_ASSERT_TRUE(even.inputs.now_ticks - silent <= 11U * EVEN_STEP_TICKS);
        TEST_ASSERT_TRUE(even.command.way == WH_MOTOR_COASTS);
        CHECK_NEAR(0.0f, 0.0f, even.command.volts);
    }
    run(WH_R(330.0), (even_failure){.in = WH_PHASE_OFF, .lose_samples = EVEN_ALWAYS});
    check_result();
}

/* One missing sample is bridged. If more are missing, their turn does not count. */
TEST(rig_run, samples_missing_in_the_record) {
    for (unsigned lost = 1; lost <= 9; lost += 4) {
        run(WH_R(330.0),
            (even_failure){.in = WH_PHASE_RECORD, .after_ticks = 700000U, .lose_samples = lost});
        check_measured(lost == 1U ? 10U : 9U);
        TEST_ASSERT_EQUAL_UINT32(lost == 1U ? 0U : 1U, even.rig.result.force.left_out);
    }
    run(WH_R(330.0),
        (even_failure){.in = WH_PHASE_SETTLE, .after_ticks = 700000U, .lose_samples = 9});
    check_result(); /* outside the record a missing sample has no effect on the result */
}

/* The converter gives each sample a status. "Disconnected" stops the run; late samples do not count. */
TEST(rig_run, converter_status_is_used) {
    for (wh_load_status status = WH_LOAD_SATURATED; status < WH_LOAD_STATUSES; status++) {
        run(WH_R(330.0),
            (even_failure){.in = WH_PHASE_RECORD, .after_ticks = 700000U, .status = status});
        TEST_ASSERT_EQUAL_INT(status == WH_LOAD_LATE ? WH_TRIP_NONE : WH_TRIP_LOAD_CELL,
                              even.rig.guard.trip);
    }
    /* Samples are late from 0.7 s on. Three whole turns remain, the others have gaps. */
    run(WH_R(330.0),
        (even_failure){.in = WH_PHASE_RECORD, .after_ticks = 700000U, .status = WH_LOAD_LATE});
    TEST_ASSERT_TRUE(even.rig.result.force.why == WH_WHY_LEFT_OUT);
}

/* A dead cell shows only the converter's noise. In half a turn, a live load changes by far more. */
TEST(rig_run, a_dead_load_cell_trips) {
    for (wh_rig_phase in = WH_PHASE_RAMP; in <= WH_PHASE_RECORD; in++) {
        run(WH_R(330.0), (even_failure){.in = in, .shows = 30}); /* plus or minus 0.3 N */
        check_trip(WH_TRIP_LOAD_CELL);
    }
}

/* The ramp down ends at slow_radps, 200 rpm. From 330 rpm the set-point falls to it; from 180 rpm it never rises. */
TEST(rig_run, ramp_down_never_speeds_up) {
    static const wh_real targets_rpm[] = {WH_R(180.0), WH_R(330.0)};
    for (unsigned i = 0; i < 2; i++) {
        begin(targets_rpm[i], (even_failure){.in = EVEN_NEVER});
        go_on_until(WH_PHASE_RAMP_DOWN);
        TEST_ASSERT_TRUE(even.rig.run.phase == WH_PHASE_RAMP_DOWN);
        while (even.rig.run.phase == WH_PHASE_RAMP_DOWN) {
            TEST_ASSERT_TRUE(even.rig.run.drive.setpoint_radps <= targets_rpm[i] * EVEN_RPM);
            even_step(&even);
        }
        const float lowest = i == 0 ? 180.0f : 200.0f;
        CHECK_NEAR(0.001f, lowest, even.rig.run.drive.setpoint_radps / EVEN_RPM);
        TEST_ASSERT_TRUE(even.rig.run.phase == WH_PHASE_OFF);
    }
}

TEST(rig_run, a_rotor_that_does_not_start_trips) {
    begin(WH_R(330.0), (even_failure){.in = WH_PHASE_SPIN_UP, .jams = true});
    go_on_until(WH_PHASE_SPIN_UP);
    TEST_ASSERT_TRUE(even.command.volts > WH_R(0.0));
    CHECK_NEAR(1e-3f, (float)EVEN_TARE_RAW / 100.0f, even.rig.measure.tare.mean_N);
    go_on_until(EVEN_NEVER);
    check_trip(WH_TRIP_STALLED);
    TEST_ASSERT_TRUE(even_is_over(&even));
}

/* Slow changes refuse the tare: a drift of the load, or a pulse, which shows that the rotor is not hanging at rest.
 * Noise does not refuse it, even a hundred times that of the converter. */
TEST(rig_run, a_moving_rig_gets_no_tare) {
    run(WH_R(330.0), (even_failure){.in = WH_PHASE_TARE, .creeps = 80}); /* 0.4 N in total */
    check_trip(WH_TRIP_MOVING);
    run(WH_R(330.0), (even_failure){.in = WH_PHASE_TARE, .creeps = 8});
    check_trip(WH_TRIP_NONE);
    run(WH_R(330.0), (even_failure){.in = WH_PHASE_TARE, .adds = {false, true}});
    check_trip(WH_TRIP_MOVING);
    begin(WH_R(330.0), (even_failure){.in = WH_PHASE_TARE, .shows = 20});
    go_on_until(WH_PHASE_SPIN_UP);
    TEST_ASSERT_TRUE(even.rig.run.phase == WH_PHASE_SPIN_UP);
    /* plus or minus 0.2 N, 250 samples */
    CHECK_NEAR(2e-4f, 0.01267f, wh_tare_error_N(&even.rig.measure.tare));
    run(WH_R(330.0), (even_failure){.in = WH_PHASE_TARE,
                                    .shows = 500}); /* the error of the mean is above 0.25 N */
    check_trip(WH_TRIP_MOVING);
}

/* The rig works but its numbers cannot be right: the run is completed, and the result is not good. */
TEST(rig_run, impossible_results_are_not_good) {
    begin(WH_R(330.0), (even_failure){.in = EVEN_NEVER});
    even.config.measure.cell.newton_per_count =
        -even.config.measure.cell.newton_per_count; /* a cell mounted in reverse */
    go_on_until(EVEN_NEVER);
    TEST_ASSERT_TRUE(even.rig.result.force.why == WH_WHY_POLARITY);
    static const wh_real gains[] = {WH_R(0.5),  WH_R(0.9), WH_R(0.96),
                                    WH_R(1.04), WH_R(1.1), WH_R(2.0)};
    for (unsigned i = 0; i < 6; i++) {
        begin(WH_R(330.0), (even_failure){.in = EVEN_NEVER});
        even.config.measure.cell.newton_per_count *= gains[i];
        go_on_until(EVEN_NEVER);
        const bool wrong = i == 0 || i == 5;
        const bool off = i == 1 || i == 4;
        TEST_ASSERT_TRUE(even.rig.result.force.why == (wrong ? WH_WHY_AMPLITUDE
                                                       : off ? WH_WHY_AMPLITUDE_OFF
                                                             : WH_WHY_NONE));
        TEST_ASSERT_TRUE(even.rig.result.force.quality == (wrong ? WH_REFUSED
                                                           : off ? WH_DOUBTFUL
                                                                 : WH_GOOD));
    }
    static const wh_real leads_deg[] = {WH_R(3.0), WH_R(-7.0), WH_R(8.0), WH_R(-25.0), WH_R(30.0)};
    for (unsigned i = 0; i < 5; i++) {
        begin(WH_R(330.0), (even_failure){.in = EVEN_NEVER});
        wh_rig_slots(&even.config, leads_deg[i] / WH_RIG_DEG_PER_RAD);
        go_on_until(EVEN_NEVER);
        TEST_ASSERT_TRUE(even.rig.result.force.why == (i == 0  ? WH_WHY_NONE
                                                       : i < 3 ? WH_WHY_PHASE_OFF
                                                               : WH_WHY_PHASE));
    }
    /* The zero of the cell drifts. */
    run(WH_R(330.0), (even_failure){.in = WH_PHASE_RECORD, .creeps = 500});
    TEST_ASSERT_TRUE(even.rig.result.force.quality != WH_GOOD);
}

/* test_rig_run.c: the rig's whole run on a made-up rotor that turns evenly, and what may spoil it.
 *
 * The made-up rotor stands still during the tare, turns at the target from a tenth of a second of
 * spin-up on whatever the duty, and stops with the motor. Its load is LOAD_N cos(theta), so the right answer is known. */
#include "core/angle.h"
#include "core/rig/datasheet.h"
#include "core/rig/rig.h"

#include "unity.h"

void suite_rig_run(void);

#define RPM WH_RIG_RADPS_PER_RPM
#define STEP_TICKS 2000U
#define START_TICKS (UINT32_MAX - 5000000U) /* the timer wraps on the way */
#define TARE_RAW 5000
#define LOAD_N WH_R(42.0)
#define COUNTS_PER_N WH_R(100.0)
#define ALWAYS (~0U)

/* What fails, from the time `after_ticks` into the state `in` on. */
typedef struct failure {
    wh_rig_state in;
    uint32_t after_ticks;
    unsigned lose[WH_SPEED_SENSORS]; /* pulses */
    unsigned lose_samples;
    bool swapped;                /* the sensors, from the beginning */
    bool jams;                   /* the rotor, for good */
    int shows;                   /* the cell: so many counts to and fro, whatever the load */
    int creeps;                  /* so many counts a second more */
    wh_load_status status;       /* of all samples */
    bool adds[WH_SPEED_SENSORS]; /* one pulse that is none */
} failure;

static wh_rig rig;
static wh_rig_config config;
static failure fails;
static wh_rig_state last_state;
static uint32_t state_ticks; /* the present state began */
static uint32_t now;
static uint32_t turn_ticks;
static uint32_t from_ticks; /* the rotor's angle is 0, and it turns from here on */
static bool turns;
static uint32_t due_pulse; /* number of the next pulse */

static void begin(wh_real target_rpm, failure failing) {
    config = wh_rig_standard;
    config.cell = (wh_cell_config){.newton_per_count = WH_R(1.0) / COUNTS_PER_N,
                                   .period_ticks = STEP_TICKS,
                                   .raw_max = INT32_C(32767)};
    config.rotor.gravity_mps2 = WH_R(0.0); /* the made-up rotor turns evenly */
    wh_rig_slots(&config, WH_R(0.0));
    fails = failing;
    now = START_TICKS;
    state_ticks = now;
    turn_ticks = (uint32_t)(WH_R(60.0) * (wh_real)WH_RIG_TICKS_PER_S / target_rpm);
    turns = false;
    due_pulse = 0;
    wh_rig_start(&config, &rig, target_rpm * RPM, now);
    last_state = rig.state;
}

static bool has_failed(void) {
    return rig.state > fails.in ||
           (rig.state == fails.in && now - state_ticks >= fails.after_ticks);
}

static void give_pulses(void) {
    while (turns) {
        unsigned sensor = due_pulse % 2U;
        const uint32_t ticks = from_ticks + due_pulse / 2U * turn_ticks + sensor * turn_ticks / 4U;
        if ((int32_t)(now - ticks) < 0) {
            break;
        }
        due_pulse++;
        if (has_failed() && fails.lose[sensor] > 0) {
            fails.lose[sensor]--;
            continue;
        }
        sensor = fails.swapped ? 1U - sensor : sensor;
        wh_rig_pulse(&rig, sensor, ticks);
    }
    for (unsigned sensor = 0; sensor < WH_SPEED_SENSORS; sensor++) {
        if (has_failed() && fails.adds[sensor]) {
            fails.adds[sensor] = false;
            wh_rig_pulse(&rig, sensor, now);
        }
    }
}

static void give_load(void) {
    if (has_failed() && fails.lose_samples > 0) {
        fails.lose_samples -= fails.lose_samples == ALWAYS ? 0U : 1U;
        return;
    }
    wh_real load = WH_R(0.0);
    if (turns && (int32_t)(now - from_ticks) >= 0) {
        wh_real sine;
        wh_real cosine;
        const wh_real turned = (wh_real)((now - from_ticks) % turn_ticks) / (wh_real)turn_ticks;
        wh_sincos(wh_phase_from_rad(WH_RIG_TWO_PI * turned), &sine, &cosine);
        load = LOAD_N * COUNTS_PER_N * cosine;
    }
    if (has_failed() && fails.shows != 0) {
        load = (wh_real)(now / STEP_TICKS % 2U == 0 ? fails.shows : -fails.shows);
    }
    if (has_failed()) {
        load += (wh_real)fails.creeps * (wh_real)(now - state_ticks) / WH_R(1e6);
    }
    const int rounded = (int)(load + (load < WH_R(0.0) ? WH_R(-0.5) : WH_R(0.5)));
    wh_rig_load(&config, &rig, now, (int32_t)TARE_RAW + rounded,
                has_failed() ? fails.status : WH_LOAD_OK);
}

static void control(void) {
    now += STEP_TICKS;
    if (has_failed() && fails.jams) {
        turns = false;
    }
    give_pulses();
    give_load();
    wh_rig_step(&config, &rig, now, false);
    if (rig.state != last_state) {
        last_state = rig.state;
        state_ticks = now;
        if (rig.state == WH_RIG_SPIN_UP) {
            turns = true;
            from_ticks = now + 100000U;
        }
    }
    turns = turns && rig.state < WH_RIG_COAST;
}

static void go_on_until(wh_rig_state state) {
    for (unsigned i = 0; i < 30000U && rig.state != state && !wh_rig_is_over(&rig); i++) {
        control();
    }
}

static void run(wh_real target_rpm, failure failing) {
    begin(target_rpm, failing);
    go_on_until(WH_RIG_DONE);
    TEST_ASSERT_TRUE(wh_rig_is_over(&rig));
    TEST_ASSERT_FLOAT_WITHIN(0.0f, 0.0f, (float)rig.duty);
}

/* The made-up load, as near as test_lockin.c finds the lock-in to be. The rotor is even to a tick a turn, 6e-6. */
static void check_measured(unsigned turns_wanted) {
    TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_NONE);
    TEST_ASSERT_TRUE(rig.state == WH_RIG_DONE);
    const wh_measured *result = &rig.result.force;
    TEST_ASSERT_EQUAL_UINT32(turns_wanted, result->turns);
    TEST_ASSERT_TRUE(result->quality == WH_GOOD && result->why == WH_WHY_NONE);
    TEST_ASSERT_TRUE(result->amplitude_half_N > WH_R(0.0) && result->amplitude_half_N < WH_R(0.02));
    TEST_ASSERT_TRUE(result->phase_half_rad > WH_R(0.0) && result->phase_half_rad < WH_R(5e-4));
    TEST_ASSERT_FLOAT_WITHIN(0.003f, 330.0f, (float)(result->speed_radps / RPM));
    TEST_ASSERT_FLOAT_WITHIN(0.011f, (float)LOAD_N, (float)result->amplitude_N);
    TEST_ASSERT_FLOAT_WITHIN(0.02f, 0.0f, (float)(result->phase_rad * WH_RIG_DEG_PER_RAD));
    TEST_ASSERT_FLOAT_WITHIN(0.011f, 0.0f, (float)result->mean_N);
}

static void check_result(void) { check_measured(10); }

static void test_a_faultless_run_finds_the_load(void) {
    run(WH_R(330.0), (failure){.in = WH_RIG_DONE});
    check_result();
    TEST_ASSERT_EQUAL_UINT32(0, rig.result.lost + rig.result.rejected);
}

/* --- slot pulses -------------------------------------------------------------------------------- */

/* From the middle of the record on, one sensor's pulses or both's, as many as the guard lets pass,
 * but never two running. A turn whose begin or end is not known is left out. */
static void test_lost_pulses_in_the_record_cost_their_turns(void) {
    for (unsigned lost = 1; lost <= wh_rig_standard.guard.lost_max; lost++) {
        for (unsigned sensor = 0; sensor < WH_SPEED_SENSORS; sensor++) {
            failure failing = {.in = WH_RIG_RECORD, .after_ticks = 700000U};
            failing.lose[sensor] = lost;
            run(WH_R(330.0), failing);
            if (sensor == 0 && lost > 1) { /* the turns between them are too many, then */
                TEST_ASSERT_TRUE(rig.result.force.quality == WH_DOUBTFUL);
                TEST_ASSERT_TRUE(rig.result.force.why == WH_WHY_LEFT_OUT);
            } else {
                check_measured(sensor == 0 ? 8U : 10U);
            }
            TEST_ASSERT_EQUAL_UINT32(sensor == 0 ? lost + 1U : 0U, rig.result.force.left_out);
            TEST_ASSERT_EQUAL_UINT32(lost, rig.result.lost);
        }
    }
}

/* Two running: the count of turns begins afresh, and what lies between is left out. */
static void test_a_gap_in_the_record_costs_its_turns(void) {
    run(WH_R(330.0), (failure){.in = WH_RIG_RECORD, .after_ticks = 700000U, .lose = {1, 1}});
    check_measured(8);
    TEST_ASSERT_EQUAL_UINT32(1, rig.result.force.left_out);
    run(WH_R(330.0), (failure){.in = WH_RIG_RECORD, .after_ticks = 700000U, .lose = {2, 2}});
    check_measured(7);
}

/* Before the record a gap does no harm. */
static void test_a_gap_before_the_record_is_bridged(void) {
    run(WH_R(330.0), (failure){.in = WH_RIG_SETTLE, .after_ticks = 700000U, .lose = {1, 1}});
    check_result();
    TEST_ASSERT_EQUAL_UINT32(2, rig.result.lost);
}

/* A disturbance that looks like a pulse, anywhere in a turn of the record: rejected, or accepted and
 * the speed is then seen to be wrong. */
static void test_a_pulse_too_many_spoils_no_result(void) {
    unsigned reported = 0;
    for (unsigned part = 0; part < 40U; part++) {
        failure failing = {.in = WH_RIG_RECORD, .after_ticks = 700000U + part / 2U * 9000U};
        failing.adds[part % 2U] = true;
        run(WH_R(330.0), failing);
        if (rig.guard.trip == WH_TRIP_NONE) {
            check_result();
            TEST_ASSERT_EQUAL_UINT32(1, rig.result.rejected);
            reported++;
        }
    }
    TEST_ASSERT_TRUE(reported > 0 && reported < 40U); /* both happened */
}

/* A shiver of the hanging rotor, whose slot stands at sensor 1. */
static void test_a_pulse_during_the_tare_is_forgotten(void) {
    for (uint32_t after = 0; after <= 490000U; after += 490000U) {
        run(WH_R(330.0), (failure){.in = WH_RIG_TARE, .after_ticks = after, .adds = {true, false}});
        check_result();
    }
}

/* Cables changed over, or a motor that turns backwards: the phase would be wrong. */
static void test_sensors_in_the_wrong_order_trip(void) {
    static const wh_real targets_rpm[] = {WH_R(170.0), WH_R(240.0), WH_R(330.0)};
    for (unsigned i = 0; i < 3; i++) {
        run(targets_rpm[i], (failure){.in = WH_RIG_DONE, .swapped = true});
        TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_PULSES);
    }
}

static void test_a_dead_sensor_trips(void) {
    for (unsigned sensor = 0; sensor < WH_SPEED_SENSORS; sensor++) {
        for (wh_rig_state in = WH_RIG_SPIN_UP; in <= WH_RIG_RECORD; in++) {
            failure failing = {.in = in};
            failing.lose[sensor] = ALWAYS;
            run(WH_R(330.0), failing);
            TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_PULSES);
        }
    }
}

/* A jammed rotor's load stands still too, but it is not the cell that failed. */
static void test_a_jammed_rotor_trips_for_its_pulses(void) {
    for (wh_rig_state in = WH_RIG_SPIN_UP; in <= WH_RIG_RECORD; in++) {
        run(WH_R(330.0), (failure){.in = in, .after_ticks = 200000U, .jams = true});
        TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_PULSES);
    }
}

/* --- load cell ---------------------------------------------------------------------------------- */

/* In whatever state the run needs the cell: it ends within 10 periods and a step. */
static void test_a_load_cell_that_falls_silent_trips(void) {
    for (wh_rig_state in = WH_RIG_TARE; in <= WH_RIG_RAMP_DOWN; in++) {
        begin(WH_R(330.0), (failure){.in = in, .lose_samples = ALWAYS});
        go_on_until(in);
        const uint32_t silent = now;
        go_on_until(WH_RIG_TRIPPED);
        TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_LOAD_CELL);
        TEST_ASSERT_TRUE(now - silent <= 11U * STEP_TICKS);
        TEST_ASSERT_FLOAT_WITHIN(0.0f, 0.0f, (float)rig.duty);
    }
    run(WH_R(330.0), (failure){.in = WH_RIG_COAST, .lose_samples = ALWAYS});
    check_result();
}

/* One missing sample is bridged, more cost their turn. */
static void test_samples_missing_in_the_record(void) {
    for (unsigned lost = 1; lost <= 9; lost += 4) {
        run(WH_R(330.0),
            (failure){.in = WH_RIG_RECORD, .after_ticks = 700000U, .lose_samples = lost});
        check_measured(lost == 1U ? 10U : 9U);
        TEST_ASSERT_EQUAL_UINT32(lost == 1U ? 0U : 1U, rig.result.force.left_out);
    }
    run(WH_R(330.0), (failure){.in = WH_RIG_SETTLE, .after_ticks = 700000U, .lose_samples = 9});
    check_result(); /* outside the record nothing is measured */
}

/* Samples that the converter itself does not trust: of a disconnected cell they stop the run, of one that has nothing new
 * they are none. */
static void test_the_converters_word_counts(void) {
    for (wh_load_status status = WH_LOAD_SATURATED; status < WH_LOAD_STATUSES; status++) {
        run(WH_R(330.0), (failure){.in = WH_RIG_RECORD, .after_ticks = 700000U, .status = status});
        TEST_ASSERT_EQUAL_INT(status == WH_LOAD_LATE ? WH_TRIP_NONE : WH_TRIP_LOAD_CELL,
                              rig.guard.trip);
    }
    /* late ones from 0.7 s on: three whole turns are left, each of the others is a gap */
    run(WH_R(330.0),
        (failure){.in = WH_RIG_RECORD, .after_ticks = 700000U, .status = WH_LOAD_LATE});
    TEST_ASSERT_TRUE(rig.result.force.why == WH_WHY_LEFT_OUT);
}

/* A cell that feels nothing shows its converter's noise: half a turn must move it by far more. */
static void test_a_dead_load_cell_trips(void) {
    for (wh_rig_state in = WH_RIG_RAMP; in <= WH_RIG_RECORD; in++) {
        run(WH_R(330.0), (failure){.in = in, .shows = 30}); /* 0.3 N, either way */
        TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_LOAD_CELL);
    }
}

/* --- set-points --------------------------------------------------------------------------------- */

/* slow_radps is 200 rpm: the way down to it from 330, but from 180 no way up. */
static void test_ramp_down_never_speeds_up(void) {
    static const wh_real targets_rpm[] = {WH_R(180.0), WH_R(330.0)};
    for (unsigned i = 0; i < 2; i++) {
        begin(targets_rpm[i], (failure){.in = WH_RIG_DONE});
        go_on_until(WH_RIG_RAMP_DOWN);
        TEST_ASSERT_TRUE(rig.state == WH_RIG_RAMP_DOWN);
        while (rig.state == WH_RIG_RAMP_DOWN) {
            TEST_ASSERT_TRUE(rig.drive.setpoint_radps <= targets_rpm[i] * RPM);
            control();
        }
        const float lowest = i == 0 ? 180.0f : 200.0f;
        TEST_ASSERT_FLOAT_WITHIN(0.001f, lowest, (float)(rig.drive.setpoint_radps / RPM));
        TEST_ASSERT_TRUE(rig.state == WH_RIG_COAST);
    }
}

static void test_a_refused_target_never_moves_the_motor(void) {
    static const wh_real targets_rpm[] = {WH_R(0.0), WH_R(120.0), WH_R(400.0)};
    for (unsigned i = 0; i < 3; i++) {
        begin(WH_R(330.0), (failure){.in = WH_RIG_DONE});
        wh_rig_start(&config, &rig, targets_rpm[i] * RPM, now);
        for (unsigned step = 0; step < 1000U; step++) {
            control();
            TEST_ASSERT_FLOAT_WITHIN(0.0f, 0.0f, (float)rig.duty);
        }
        TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_TARGET);
        TEST_ASSERT_TRUE(wh_rig_is_over(&rig));
    }
}

/* --- before the motor --------------------------------------------------------------------------- */

static void test_a_rotor_that_does_not_start_trips(void) {
    begin(WH_R(330.0), (failure){.in = WH_RIG_SPIN_UP, .jams = true});
    go_on_until(WH_RIG_SPIN_UP);
    TEST_ASSERT_TRUE(rig.duty > WH_R(0.0));
    TEST_ASSERT_FLOAT_WITHIN(1e-3f, (float)TARE_RAW / 100.0f, (float)rig.tare.mean_N);
    go_on_until(WH_RIG_DONE);
    TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_STALLED);
    TEST_ASSERT_TRUE(wh_rig_is_over(&rig));
}

/* What moves slowly is no noise: a load that creeps, or a pulse of the sensor where a hanging rotor is not. Noise is no
 * motion, also where it is a hundred times the converter's. */
static void test_a_moving_rig_gets_no_tare(void) {
    run(WH_R(330.0), (failure){.in = WH_RIG_TARE, .creeps = 80}); /* 0.4 N in all */
    TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_MOVING);
    run(WH_R(330.0), (failure){.in = WH_RIG_TARE, .creeps = 8});
    TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_NONE);
    run(WH_R(330.0), (failure){.in = WH_RIG_TARE, .adds = {false, true}});
    TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_MOVING);
    begin(WH_R(330.0), (failure){.in = WH_RIG_TARE, .shows = 20});
    go_on_until(WH_RIG_SPIN_UP);
    TEST_ASSERT_TRUE(rig.state == WH_RIG_SPIN_UP);
    /* 0.2 N either way, 250 times */
    TEST_ASSERT_FLOAT_WITHIN(2e-4f, 0.01267f, (float)wh_tare_error_N(&rig.tare));
    run(WH_R(330.0),
        (failure){.in = WH_RIG_TARE, .shows = 500}); /* a mean that is not known to 0.25 N */
    TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_MOVING);
}

/* Healthy, but wrong: the run is done, and what was measured is not called good. */
static void test_what_cannot_be_is_not_called_good(void) {
    begin(WH_R(330.0), (failure){.in = WH_RIG_DONE});
    config.cell.newton_per_count = -config.cell.newton_per_count; /* the cell the other way round */
    go_on_until(WH_RIG_DONE);
    TEST_ASSERT_TRUE(rig.result.force.why == WH_WHY_POLARITY);
    static const wh_real gains[] = {WH_R(0.5),  WH_R(0.9), WH_R(0.96),
                                    WH_R(1.04), WH_R(1.1), WH_R(2.0)};
    for (unsigned i = 0; i < 6; i++) {
        begin(WH_R(330.0), (failure){.in = WH_RIG_DONE});
        config.cell.newton_per_count *= gains[i];
        go_on_until(WH_RIG_DONE);
        const bool wrong = i == 0 || i == 5;
        const bool off = i == 1 || i == 4;
        TEST_ASSERT_TRUE(rig.result.force.why == (wrong ? WH_WHY_AMPLITUDE
                                                  : off ? WH_WHY_AMPLITUDE_OFF
                                                        : WH_WHY_NONE));
        TEST_ASSERT_TRUE(rig.result.force.quality == (wrong ? WH_REFUSED
                                                      : off ? WH_DOUBTFUL
                                                            : WH_GOOD));
    }
    static const wh_real leads_deg[] = {WH_R(3.0), WH_R(-7.0), WH_R(8.0), WH_R(-25.0), WH_R(30.0)};
    for (unsigned i = 0; i < 5; i++) {
        begin(WH_R(330.0), (failure){.in = WH_RIG_DONE});
        wh_rig_slots(&config, leads_deg[i] / WH_RIG_DEG_PER_RAD);
        go_on_until(WH_RIG_DONE);
        TEST_ASSERT_TRUE(rig.result.force.why == (i == 0  ? WH_WHY_NONE
                                                  : i < 3 ? WH_WHY_PHASE_OFF
                                                          : WH_WHY_PHASE));
    }
    /* a cell that freezes for a tenth of a second, and one that loses its tare */
    run(WH_R(330.0), (failure){.in = WH_RIG_RECORD, .creeps = 500});
    TEST_ASSERT_TRUE(rig.result.force.quality != WH_GOOD);
}

void suite_rig_run(void) {
    RUN_TEST(test_a_faultless_run_finds_the_load);
    RUN_TEST(test_lost_pulses_in_the_record_cost_their_turns);
    RUN_TEST(test_a_gap_in_the_record_costs_its_turns);
    RUN_TEST(test_a_gap_before_the_record_is_bridged);
    RUN_TEST(test_a_pulse_too_many_spoils_no_result);
    RUN_TEST(test_a_pulse_during_the_tare_is_forgotten);
    RUN_TEST(test_sensors_in_the_wrong_order_trip);
    RUN_TEST(test_a_dead_sensor_trips);
    RUN_TEST(test_a_jammed_rotor_trips_for_its_pulses);
    RUN_TEST(test_a_load_cell_that_falls_silent_trips);
    RUN_TEST(test_samples_missing_in_the_record);
    RUN_TEST(test_the_converters_word_counts);
    RUN_TEST(test_a_dead_load_cell_trips);
    RUN_TEST(test_ramp_down_never_speeds_up);
    RUN_TEST(test_a_refused_target_never_moves_the_motor);
    RUN_TEST(test_a_rotor_that_does_not_start_trips);
    RUN_TEST(test_a_moving_rig_gets_no_tare);
    RUN_TEST(test_what_cannot_be_is_not_called_good);
}

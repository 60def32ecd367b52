/* test_rig_steps.c: the rig's state machine, one step at a time: how long each state lasts and what ends it, to the
 * step, from the numbers that docs/rig.md gives; what a full record comes to; its parts against a plain model. */
#include "core/rig/datasheet.h"
#include "core/rig/rig.h"

#include "tests/scattered.h"
#include "unity.h"

void suite_rig_steps(void);

#define RPM WH_RIG_RADPS_PER_RPM
#define STEP_TICKS UINT32_C(2000) /* an AVR's unsigned has 16 bits */
#define STEPS_PER_S 500U
#define TURN_TICKS 181818U /* 330 rpm */

static wh_rig rig;
static wh_rig_config config;
static uint32_t now;

static void begin(void) {
    config = wh_rig_standard;
    config.cell = (wh_cell_config){
        .newton_per_count = WH_R(0.01), .period_ticks = STEP_TICKS, .raw_max = INT32_C(32767)};
    config.rotor.gravity_mps2 = WH_R(0.0);
    wh_rig_slots(&config, WH_R(0.0));
    now = UINT32_MAX - 3000000U; /* the timer wraps on the way */
    wh_rig_start(&config, &rig, WH_R(330.0) * RPM, now);
}

/* In this state since now, at the target's speed, with all that the guard looks for in order. */
static void stand_in(wh_rig_state state) {
    begin();
    rig.state = state;
    rig.since_ticks = now;
    rig.band_ticks = now;
    rig.speed.known = true;
    rig.speed.running = true;
    rig.speed.turn_radps = WH_R(330.0) * RPM;
    rig.drive.setpoint_radps = rig.drive.target_radps = rig.target_radps;
}

/* `steps` steps at a speed, whose pulses and loads come as they should, while the state stays. */
static unsigned stay(wh_real speed_rpm, unsigned steps) {
    const wh_rig_state state = rig.state;
    unsigned done = 0;
    while (done < steps && rig.state == state) {
        now += STEP_TICKS;
        rig.speed.turn_radps = speed_rpm * RPM;
        rig.speed.ticks = now;
        wh_rig_load(&config, &rig, now, done % 2U == 0 ? 0 : 8, WH_LOAD_OK);
        wh_rig_step(&config, &rig, now, false);
        done++;
    }
    return done;
}

/* --- words ------------------------------------------------------------------------------------------- */

static bool same_text(const char *x, const char *y) {
    while (*x != 0 && *x == *y) {
        x++;
        y++;
    }
    return *x == *y;
}

static void test_every_state_and_reason_has_words_of_its_own(void) {
    for (int i = 0; i <= (int)WH_RIG_TRIPPED + 1; i++) {
        TEST_ASSERT_NOT_NULL(wh_rig_state_text((wh_rig_state)i));
        for (int k = 0; k < i; k++) {
            TEST_ASSERT_FALSE(
                same_text(wh_rig_state_text((wh_rig_state)i), wh_rig_state_text((wh_rig_state)k)));
        }
    }
    for (int i = 0; i <= (int)WH_TRIP_RUNS_ON + 1; i++) {
        TEST_ASSERT_NOT_NULL(wh_trip_text((wh_trip)i));
        for (int k = 0; k < i; k++) {
            TEST_ASSERT_FALSE(same_text(wh_trip_text((wh_trip)i), wh_trip_text((wh_trip)k)));
        }
    }
}

/* --- how long each state lasts ------------------------------------------------------------------------- */

static void test_the_tare_takes_its_samples(void) {
    begin();
    TEST_ASSERT_EQUAL_UINT(250, stay(WH_R(0.0), 1000)); /* half a second */
    TEST_ASSERT_TRUE(rig.state == WH_RIG_SPIN_UP);
    TEST_ASSERT_FLOAT_WITHIN(1e-6f, 0.04f, (float)rig.tare.mean_N); /* of 0 and 8 counts */
    TEST_ASSERT_FLOAT_WITHIN(1e-6f, 0.4f, (float)rig.duty);
    TEST_ASSERT_FALSE(rig.speed.running); /* what was seen before is forgotten */
    begin();                              /* samples that are none do not count */
    for (unsigned i = 0; i < 500; i++) {
        wh_rig_load(&config, &rig, now, 9, WH_LOAD_LATE);
    }
    TEST_ASSERT_EQUAL_UINT(250, stay(WH_R(0.0), 1000));
    TEST_ASSERT_FLOAT_WITHIN(1e-6f, 0.04f, (float)rig.tare.mean_N);
    for (unsigned pulses = 2; pulses <= 3; pulses++) { /* the hanging rotor's shiver, or more */
        begin();
        for (unsigned i = 0; i < pulses; i++) {
            now += 100000U;
            wh_rig_load(&config, &rig, now, 0, WH_LOAD_OK);
            wh_rig_pulse(&rig, 0, now);
        }
        stay(WH_R(0.0), 1000);
        TEST_ASSERT_TRUE(rig.guard.trip == (pulses == 2U ? WH_TRIP_NONE : WH_TRIP_MOVING));
    }
}

static void test_the_loop_takes_over_at_its_speed(void) {
    stand_in(WH_RIG_SPIN_UP);
    rig.duty = config.spin_up_duty;
    rig.speed.lost = 3;
    TEST_ASSERT_EQUAL_UINT(100, stay(WH_R(149.9), 100));
    rig.speed.known = false;
    TEST_ASSERT_EQUAL_UINT(100, stay(WH_R(200.0), 100));
    rig.speed.known = true;
    TEST_ASSERT_EQUAL_UINT(1, stay(WH_R(150.1), 100));
    TEST_ASSERT_TRUE(rig.state == WH_RIG_RAMP);
    TEST_ASSERT_EQUAL_UINT32(3, rig.guard.lost_before);
    TEST_ASSERT_FLOAT_WITHIN(1e-3f, 150.1f, (float)(rig.drive.setpoint_radps / RPM));
    TEST_ASSERT_FLOAT_WITHIN(1e-3f, 330.0f, (float)(rig.drive.target_radps / RPM));
    TEST_ASSERT_FLOAT_WITHIN(1e-6f, 0.4f, (float)rig.drive.integral); /* no jump of the duty */

    stand_in(WH_RIG_SPIN_UP); /* five seconds for that, and no longer */
    TEST_ASSERT_EQUAL_UINT(5U * STEPS_PER_S + 1U, stay(WH_R(100.0), 10000));
    TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_STALLED);
}

/* 60 rpm a second: three seconds from 150 to 330. */
static void test_the_ramp_takes_its_time(void) {
    stand_in(WH_RIG_RAMP);
    rig.drive.setpoint_radps = WH_R(150.0) * RPM;
    const unsigned steps = stay(WH_R(330.0), 10000);
    TEST_ASSERT_TRUE(rig.state == WH_RIG_SETTLE);
    TEST_ASSERT_TRUE(steps >= 3U * STEPS_PER_S - 1U && steps <= 3U * STEPS_PER_S + 1U);
}

static void test_the_speed_settles_within_its_band(void) {
    static const wh_real inside_rpm[] = {WH_R(330.0), WH_R(330.49), WH_R(329.51)};
    static const wh_real outside_rpm[] = {WH_R(330.51), WH_R(329.49)};
    for (unsigned i = 0; i < 3; i++) {
        stand_in(WH_RIG_SETTLE);
        TEST_ASSERT_EQUAL_UINT(5U * STEPS_PER_S / 2U, stay(inside_rpm[i], 10000));
        TEST_ASSERT_TRUE(rig.state == WH_RIG_RECORD);
    }
    for (unsigned i = 0; i < 2; i++) { /* a step outside, and the time begins anew */
        stand_in(WH_RIG_SETTLE);
        TEST_ASSERT_EQUAL_UINT(1000, stay(WH_R(330.0), 1000));
        TEST_ASSERT_EQUAL_UINT(1, stay(outside_rpm[i], 1));
        TEST_ASSERT_EQUAL_UINT(5U * STEPS_PER_S / 2U, stay(WH_R(330.0), 10000));
        stand_in(WH_RIG_SETTLE); /* twenty seconds are enough */
        TEST_ASSERT_EQUAL_UINT(20U * STEPS_PER_S + 1U, stay(outside_rpm[i], 20000));
        TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_UNSETTLED);
    }
}

static void test_the_speed_stays_while_it_is_recorded(void) {
    static const wh_real rpm[] = {WH_R(331.99), WH_R(328.01), WH_R(332.01), WH_R(327.99)};
    for (unsigned i = 0; i < 4; i++) {
        stand_in(WH_RIG_RECORD);
        const bool good = i < 2;
        TEST_ASSERT_EQUAL_UINT(good ? 900 : 1, stay(rpm[i], 900));
        TEST_ASSERT_TRUE(rig.guard.trip == (good ? WH_TRIP_NONE : WH_TRIP_UNSETTLED));
    }
}

/* 1.5 s without a pulse are rest; after ten it will not come. */
static void test_rest_is_waited_for(void) {
    static const wh_rig_state states[] = {WH_RIG_COAST, WH_RIG_TRIPPED};
    for (unsigned i = 0; i < 4; i++) {
        stand_in(states[i % 2U]);
        const bool pulses = i >= 2U;
        if (states[i % 2U] == WH_RIG_TRIPPED) {
            wh_guard_trip(&rig.guard, WH_TRIP_OVERSPEED);
        }
        unsigned steps = 0;
        for (; steps < 20000U && !wh_rig_is_over(&rig) && rig.state == states[i % 2U]; steps++) {
            now += STEP_TICKS;
            rig.speed.ticks = pulses || steps == 0 ? now : rig.speed.ticks;
            TEST_ASSERT_FLOAT_WITHIN(0.0f, 0.0f, (float)wh_rig_step(&config, &rig, now, false));
        }
        if (pulses) {
            TEST_ASSERT_EQUAL_UINT(10U * STEPS_PER_S + 1U, steps);
            TEST_ASSERT_TRUE(
                rig.guard.trip ==
                (states[i % 2U] == WH_RIG_COAST ? WH_TRIP_RUNS_ON : WH_TRIP_OVERSPEED));
        } else {
            TEST_ASSERT_EQUAL_UINT(3U * STEPS_PER_S / 2U + 1U, steps);
            TEST_ASSERT_TRUE(wh_rig_is_over(&rig));
        }
    }
    stand_in(WH_RIG_COAST); /* never a pulse: the state's own time counts */
    rig.speed.running = false;
    unsigned steps = 0;
    for (; steps < 20000U && rig.state == WH_RIG_COAST; steps++) {
        now += STEP_TICKS;
        wh_rig_step(&config, &rig, now, false);
    }
    TEST_ASSERT_EQUAL_UINT(3U * STEPS_PER_S / 2U, steps);
    TEST_ASSERT_TRUE(rig.state == WH_RIG_DONE);
}

/* The times since then wrap after 71.6 minutes, and with them what follows from them; a rig that came to rest after a trip
 * stays at rest through two wraps. */
static void test_a_rig_at_rest_stays_so_when_the_timer_wraps(void) {
    const wh_trip trips[] = {WH_TRIP_WATCHDOG,
                             WH_TRIP_PULSES}; /* the second waits for its time alone */
    for (unsigned i = 0; i < 2; i++) {
        stand_in(WH_RIG_TRIPPED);
        rig.guard.trip = trips[i];
        rig.speed.ticks = now;
        const uint32_t begin = now;
        unsigned waited = 0;
        for (; waited < 20000U && !wh_rig_is_over(&rig); waited++) {
            now += STEP_TICKS;
            wh_rig_step(&config, &rig, now, false);
        }
        TEST_ASSERT_TRUE(waited > STEPS_PER_S && waited < 20000U);
        for (unsigned k = 0; k < 9000U; k++) { /* a second and a bit each: 2.6 hours */
            now += 1048573U;
            wh_rig_step(&config, &rig, now, false);
            TEST_ASSERT_TRUE(wh_rig_is_over(&rig));
        }
        for (unsigned k = 0; k < 3000U; k++) { /* and right behind the next wrap, step by step */
            now = begin + k * STEP_TICKS;
            wh_rig_step(&config, &rig, now, false);
            TEST_ASSERT_TRUE(wh_rig_is_over(&rig));
        }
    }
}

/* In any state a late controller, and from spin-up to the ramp down too high a speed, end the run. */
static void test_what_trips_in_which_state(void) {
    for (wh_rig_state state = WH_RIG_TARE; state <= WH_RIG_DONE; state++) {
        stand_in(state);
        rig.at_rest = true; /* as before the fault */
        now += STEP_TICKS;
        rig.speed.ticks = now;
        wh_rig_step(&config, &rig, now, true);
        TEST_ASSERT_TRUE(rig.state == WH_RIG_TRIPPED && rig.guard.trip == WH_TRIP_WATCHDOG);
        TEST_ASSERT_FALSE(rig.at_rest);
        stand_in(state);
        rig.drive.setpoint_radps = WH_R(0.0); /* stay on the ramp */
        now += STEP_TICKS;
        rig.speed.ticks = now;
        rig.speed.turn_radps = WH_R(401.0) * RPM;
        wh_rig_step(&config, &rig, now, false);
        const bool drives = state >= WH_RIG_SPIN_UP && state <= WH_RIG_RAMP_DOWN;
        TEST_ASSERT_TRUE((rig.guard.trip == WH_TRIP_OVERSPEED) == drives);
    }
}

/* --- the record ------------------------------------------------------------------------------------------ */

/* Turns of a load that is known, given to the run as a lock-in would that finds them; the record ends after its time. */
static void test_what_a_record_comes_to(void) {
    stand_in(WH_RIG_SETTLE);
    rig.tare.mean_N = WH_R(0.4);
    rig.speed.lost = 5;
    rig.guard.lost_before = 3;
    rig.speed.rejected = 4;
    rig.duty = WH_R(0.5);
    /* 91 samples a turn, of which the load is a triangle: its mean 10.45 N */
    const uint32_t turn = 91U * STEP_TICKS;
    uint32_t first = now + STEP_TICKS;
    unsigned sample = 0;
    while (rig.state <= WH_RIG_RECORD && sample < 5000U) {
        now += STEP_TICKS;
        rig.speed.turn_radps = WH_R(330.0) * RPM;
        rig.speed.ticks = now;
        const uint32_t part = (now - first) % turn;
        if (part == 0) {
            wh_lockin_mark(&rig.lockin, 0, now - 1000U, 4U * ((now - first) / turn));
        } else if (part == 23U * STEP_TICKS) {
            wh_lockin_mark(&rig.lockin, 1, now - 1000U, 4U * ((now - first) / turn) + 1U);
        }
        const unsigned k = sample % 91U;
        wh_rig_load(&config, &rig, now, (int32_t)(1040 + 40 * (k < 46U ? k : 91U - k)), WH_LOAD_OK);
        wh_rig_step(&config, &rig, now, false);
        sample++;
    }
    TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_NONE && rig.state == WH_RIG_RAMP_DOWN);
    const wh_rig_result *result = &rig.result;
    TEST_ASSERT_EQUAL_UINT32(10, result->force.turns);
    TEST_ASSERT_FLOAT_WITHIN(1e-3f, 60.0f / 0.182f, (float)(result->force.speed_radps / RPM));
    TEST_ASSERT_FLOAT_WITHIN(1e-5f, 0.4f, (float)result->tare_N);
    TEST_ASSERT_FLOAT_WITHIN(1e-4f, 10.0f, (float)result->low_N);
    TEST_ASSERT_FLOAT_WITHIN(1e-4f, 28.0f, (float)result->high_N);
    /* half a sample before the turn's first sample, and before its 23rd */
    TEST_ASSERT_FLOAT_WITHIN(2e-3f, 10.2f, (float)result->force.at_mark_N[0]);
    TEST_ASSERT_FLOAT_WITHIN(2e-3f, 19.0f, (float)result->force.at_mark_N[1]);
    /* 2 (0 + ... + 45) 0.4 / 91 of them */
    TEST_ASSERT_FLOAT_WITHIN(0.01f, 10.0f + 9.0989f, (float)result->force.mean_N);
    TEST_ASSERT_TRUE(result->force.quality ==
                     WH_REFUSED); /* 8 N, against the masses: not the rig's */
    TEST_ASSERT_EQUAL_UINT32(2, result->lost);
    TEST_ASSERT_EQUAL_UINT32(4, result->rejected);
    TEST_ASSERT_FLOAT_WITHIN(1e-3f, 200.0f, (float)(rig.drive.target_radps / RPM));
    TEST_ASSERT_TRUE(result->duty >= WH_R(0.0) && result->duty <= WH_R(1.0));
}

/* Without a turn there is no result. */
static void test_a_record_without_turns_trips(void) {
    stand_in(WH_RIG_RECORD);
    TEST_ASSERT_EQUAL_UINT(1003, stay(WH_R(330.0), 5000));
    TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_RECORD);
    stand_in(WH_RIG_RECORD); /* a lock-in that waits for samples which never come */
    rig.lockin.stage = WH_LOCKIN_SUMS;
    rig.lockin.next.begin_ticks = now + 100000000U;
    TEST_ASSERT_EQUAL_UINT(1253, stay(WH_R(330.0), 5000));
    TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_RECORD);
}

/* A band's edge belongs to it. */
static void test_edges_belong_to_the_bands(void) {
    for (int side = -1; side <= 1; side += 2) {
        stand_in(WH_RIG_SETTLE);
        config.settle_band_radps = WH_R(0.5);
        config.record_band_radps = WH_R(1.0);
        rig.target_radps = WH_R(32.0);
        TEST_ASSERT_EQUAL_UINT(1250, stay((WH_R(32.0) + (wh_real)side * WH_R(0.5)) / RPM, 10000));
        TEST_ASSERT_TRUE(rig.state == WH_RIG_RECORD);
        rig.speed.turn_radps = WH_R(32.0) + (wh_real)side;
        now += STEP_TICKS;
        rig.speed.ticks = now;
        wh_rig_load(&config, &rig, now, 1, WH_LOAD_OK);
        wh_rig_step(&config, &rig, now, false);
        TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_NONE);
    }
}

/* Two lost running: no speed of that interval, and the turn's stays until there is a new one. */
static void test_a_gap_has_no_speed_of_its_own(void) {
    wh_speed speed;
    wh_speed_start(&speed, config.impossible_radps);
    uint32_t ticks = 500;
    for (unsigned i = 0; i < 8; i++, ticks += TURN_TICKS) {
        wh_speed_pulse(&speed, 0, ticks);
        wh_speed_pulse(&speed, 1, ticks + TURN_TICKS / 4U);
    }
    const wh_real before = speed.turn_radps;
    TEST_ASSERT_TRUE(wh_speed_pulse(&speed, 0, ticks + TURN_TICKS));
    TEST_ASSERT_EQUAL_UINT32(1, speed.restarts);
    TEST_ASSERT_FLOAT_WITHIN(0.0f, 0.0f, (float)speed.interval_radps);
    TEST_ASSERT_FLOAT_WITHIN(0.0f, (float)before, (float)speed.turn_radps);
}

/* --- the drive, against its law written down once more --------------------------------------------------- */

static double between(double low, double high) {
    return low + (high - low) * (double)(scattered() >> 11) * 0x1p-53;
}

static double limited(double value) { return value < 0.0 ? 0.0 : value > 1.0 ? 1.0 : value; }

static void test_the_drive_keeps_its_law(void) {
    scattered_state = UINT64_C(0x5eed0011);
    const wh_drive_config *law = &wh_rig_standard.drive;
    unsigned held = 0;
    for (unsigned i = 0; i < 2000U; i++) {
        wh_drive drive;
        wh_drive_start(law, &drive, (wh_real)between(0.0, 40.0), (wh_real)between(-0.5, 1.5));
        TEST_ASSERT_TRUE(wh_drive_at_target(&drive));
        double setpoint = (double)drive.setpoint_radps;
        double integral = (double)drive.integral;
        TEST_ASSERT_TRUE(integral >= 0.0 && integral <= 1.0);
        drive.target_radps = (wh_real)(setpoint + between(-0.03, 0.03));
        const double target = (double)drive.target_radps;
        TEST_ASSERT_FALSE(wh_drive_at_target(&drive));
        for (unsigned step = 0; step < 4; step++) {
            const double speed = setpoint + between(-60.0, 60.0);
            const double most = (double)law->ramp_radps2 * 0.002;
            setpoint = target > setpoint + most   ? setpoint + most
                       : target < setpoint - most ? setpoint - most
                                                  : target;
            const double error = setpoint - speed;
            const double wanted = 0.010 * error + integral;
            const bool further = (wanted > 1.0 && error > 0.0) || (wanted < 0.0 && error < 0.0);
            const wh_real duty = wh_drive_step(law, &drive, (wh_real)speed, WH_R(0.002));
            integral = further ? integral : limited(integral + 0.042 * error * 0.002);
            held += further;
            TEST_ASSERT_FLOAT_WITHIN(2e-5f, (float)limited(wanted), (float)duty);
            TEST_ASSERT_FLOAT_WITHIN(2e-5f, (float)integral, (float)drive.integral);
            TEST_ASSERT_FLOAT_WITHIN(2e-5f, (float)setpoint, (float)drive.setpoint_radps);
        }
        TEST_ASSERT_TRUE(
            wh_drive_at_target(&drive)); /* 0.03 rad/s are less than three steps' way */
    }
    TEST_ASSERT_GREATER_THAN_UINT(500, held);
}

void suite_rig_steps(void) {
    RUN_TEST(test_every_state_and_reason_has_words_of_its_own);
    RUN_TEST(test_the_tare_takes_its_samples);
    RUN_TEST(test_the_loop_takes_over_at_its_speed);
    RUN_TEST(test_the_ramp_takes_its_time);
    RUN_TEST(test_the_speed_settles_within_its_band);
    RUN_TEST(test_the_speed_stays_while_it_is_recorded);
    RUN_TEST(test_rest_is_waited_for);
    RUN_TEST(test_a_rig_at_rest_stays_so_when_the_timer_wraps);
    RUN_TEST(test_what_trips_in_which_state);
    RUN_TEST(test_what_a_record_comes_to);
    RUN_TEST(test_a_record_without_turns_trips);
    RUN_TEST(test_edges_belong_to_the_bands);
    RUN_TEST(test_a_gap_has_no_speed_of_its_own);
    RUN_TEST(test_the_drive_keeps_its_law);
}

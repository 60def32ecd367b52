/* test_rig_lead.c: a runaway motor is detected early from the pulses. Rotors may also slow down later than their
 * set-point, because the drive stage does not brake or the inertia is up to six times larger. Then the guard does not
 * trip for over-speed, but it still detects a runaway drive. */
#include <stddef.h>

#include "draw.h"
#include "even_rig.h"
#include "rotor.h"
#include "tests/suites.h"

static wh_rig rig;
static wh_rig_config config;
static rotor_kind kind;
static rotor_state rotor;
static wh_real fastest_radps; /* the rotor's largest speed since the last reset */

static void draw_rotor(uint64_t *seed) {
    kind = rotor_nominal();
    kind.inertia_kgm2 *= draw_broken(seed, 1, 6);
    kind.friction_Nm = WH_R(0.01) * draw_whole(seed, 0, 4);
    kind.freewheels = !draw_one_in(seed, 4);
    kind.jitter_s = WH_R(60e-6);
    rotor = (rotor_state){.ticks = UINT32_MAX - 3000000U, .seed = draw_bits(seed)};
    fastest_radps = WH_R(0.0);
}

static void begin(wh_rig_phase phase, wh_real target_radps) {
    config = even_config();
    wh_rig_start(&config, &rig, rotor.ticks, NULL);
    wh_run_start(&rig.run, target_radps, rotor.ticks);
    rig.state = WH_RIG_RUNNING;
    rig.run.phase = phase;
    rig.run.closed_ticks = rotor.ticks - 5U * WH_RIG_TICKS_PER_S;
}

static void turn(wh_real drive) {
    rotor_turn(&kind, &rotor, drive, EVEN_STEP_TICKS);
    for (unsigned i = 0; i < rotor.pulses; i++) {
        wh_rig_pulse(&config, &rig, rotor.pulse_sensor[i], rotor.pulse_ticks[i]);
    }
}

/* Steps with the fixed drive `drive`, or with the commanded one if `drive` is negative. */
static void go_on(wh_real drive, unsigned steps) {
    wh_rig_inputs inputs = {.supply_V = WH_RIG_RATED_V};
    for (unsigned step = 0; step < steps && rig.state == WH_RIG_RUNNING; step++) {
        turn(drive < WH_R(0.0) ? rig.command.volts / WH_RIG_RATED_V : drive);
        fastest_radps = rotor.speed_radps > fastest_radps ? rotor.speed_radps : fastest_radps;
        inputs.now_ticks = rotor.ticks;
        wh_rig_load(&config, &rig, rotor.ticks, step % 2U == 0 ? 3000 : -3000, WH_LOAD_OK);
        rig.command = wh_rig_step(&config, &rig, &inputs);
    }
}

#define AS_ASKED WH_R(-1.0)

static void turns_at(wh_real speed_radps) {
    const wh_real torque_Nm = kind.drag_Nms * speed_radps + kind.friction_Nm;
    const wh_real volts =
        WH_RIG_RATED_V * (speed_radps / kind.no_load_radps + torque_Nm / kind.stall_Nm);
    rotor.speed_radps = speed_radps;
    begin(WH_PHASE_SETTLE, speed_radps);
    rig.run.volts = volts;
    wh_drive_start(&rig.run.drive, speed_radps, volts);
    rig.command = (wh_rig_command){WH_MOTOR_DRIVES, volts};
    go_on(AS_ASKED, 700);
    TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_NONE);
}

static void leads_to(wh_real target_radps) {
    TEST_ASSERT_TRUE(wh_rig_post(&rig, WH_EVENT_SET, target_radps));
}

TEST(rig_lead, slow_rotor_is_no_runaway) {
    uint64_t seed = 11;
    unsigned left_behind = 0;
    for (unsigned trial = 0; trial < 40U; trial++) {
        draw_rotor(&seed);
        turns_at(draw_broken(&seed, 250, 360) * EVEN_RPM);
        const wh_real target_radps = draw_broken(&seed, 170, 240) * EVEN_RPM;
        leads_to(target_radps);
        go_on(AS_ASKED, 2500);
        TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_NONE);
        /* Counts the runs whose rotor is faster than the bound that the set-point alone would give. */
        left_behind +=
            rig.pulses.speed.turn_radps >
                    wh_guard_bound_radps(&config.guard, rig.run.drive.setpoint_radps, true)
                ? 1U
                : 0U;
    }
    TEST_ASSERT_TRUE(left_behind >= 4U);
}

TEST(rig_lead, fast_spin_up_is_no_runaway) {
    uint64_t seed = 12;
    for (unsigned trial = 0; trial < draw_cases(40); trial++) {
        draw_rotor(&seed);
        kind.friction_Nm = WH_R(0.0);
        const wh_real target_radps = draw_broken(&seed, 170, 190) * EVEN_RPM;
        begin(WH_PHASE_SPIN_UP, target_radps);
        rig.run.volts = config.run.spin_up_V;
        rig.command = (wh_rig_command){WH_MOTOR_DRIVES, rig.run.volts};
        go_on(AS_ASKED, 6000);
        TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_NONE || rig.guard.trip == WH_TRIP_UNSETTLED);
        TEST_ASSERT_TRUE(fastest_radps < config.guard.limit_radps);
    }
}

/* The bounds of docs/rig.md hold for a rotor whose set-point falls, whether the rotor follows or not. */
TEST(rig_lead, runaway_on_the_way_down_trips) {
    uint64_t seed = 13;
    for (unsigned trial = 0; trial < draw_cases(60); trial++) {
        draw_rotor(&seed);
        turns_at(WH_RIG_NOMINAL_RPM * EVEN_RPM);
        leads_to(WH_R(200.0) * EVEN_RPM);
        go_on(AS_ASKED, (unsigned)(draw_bits(&seed) % 1000U));
        TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_NONE);
        const uint32_t begins_ticks = rotor.ticks;
        const bool slow = rotor.speed_radps < WH_R(250.0) * EVEN_RPM;
        fastest_radps = WH_R(0.0);
        go_on(WH_R(1.0), 1000);
        TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_OVERSPEED);
        TEST_ASSERT_TRUE(fastest_radps < WH_R(470.0) * EVEN_RPM);
        if (kind.inertia_kgm2 < WH_R(1.5) * WH_RIG_INERTIA_KGM2) {
            TEST_ASSERT_TRUE(rotor.ticks - begins_ticks <= (slow ? 350000U : 250000U));
        }
    }
}

/* The bound does not rise with the rotor's speed: a rotor driven to no more than 390 rpm is detected too. */
TEST(rig_lead, slow_runaway_going_down_trips) {
    uint64_t seed = 14;
    for (unsigned trial = 0; trial < 20U; trial++) {
        draw_rotor(&seed);
        kind.freewheels = false;
        turns_at(WH_R(300.0) * EVEN_RPM);
        leads_to(WH_R(180.0) * EVEN_RPM);
        go_on(AS_ASKED, 900U + (unsigned)(draw_bits(&seed) % 500U));
        TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_NONE);
        fastest_radps = WH_R(0.0);
        go_on(WH_R(0.65), 2000);
        TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_OVERSPEED);
        TEST_ASSERT_TRUE(fastest_radps < WH_R(350.0) * EVEN_RPM);
    }
}

static const wh_real nominal_radps = WH_RIG_NOMINAL_RPM * EVEN_RPM;

static void stand_at(wh_rig_phase phase, rotor_state where) {
    rotor = where;
    begin(phase, nominal_radps);
    rig.run.volts = wh_run_needs_V(&config.run, nominal_radps);
    wh_drive_start(&rig.run.drive, nominal_radps, rig.run.volts);
}

/* Applies full voltage to the rotor, whatever the command. From rest, this looks like a motor that is faster than its
 * settings. */
static void run_away(wh_real most_s) {
    const uint32_t begins_ticks = rotor.ticks;
    go_on(WH_R(1.0), 500);
    TEST_ASSERT_TRUE(rig.guard.trip ==
                     (rig.record.phase == WH_PHASE_SPIN_UP ? WH_TRIP_FASTER : WH_TRIP_OVERSPEED));
    TEST_ASSERT_TRUE((wh_real)(rotor.ticks - begins_ticks) <= most_s * (wh_real)WH_RIG_TICKS_PER_S);
}

TEST(rig_lead, runaway_at_any_angle_trips) {
    uint64_t seed = 7;
    kind = rotor_nominal();
    const wh_real drive =
        nominal_radps / kind.no_load_radps + kind.drag_Nms * nominal_radps / kind.stall_Nm;
    for (unsigned place = 0; place < 46U; place++) { /* 46 instants over a turn, 4 ms apart */
        stand_at(WH_PHASE_SETTLE, (rotor_state){.ticks = UINT32_MAX - 2000000U,
                                                .speed_radps = nominal_radps,
                                                .seed = draw_bits(&seed)});
        for (unsigned step = 0; step < 1000U + 2U * place; step++) {
            turn(drive);
        }
        rig.run.since_ticks = rig.run.band_ticks = rig.run.ample_ticks = rotor.ticks;
        run_away(WH_R(0.25));
        /* the limit that docs/rig.md states */
        TEST_ASSERT_TRUE(rotor.speed_radps < WH_R(475.0) * EVEN_RPM);
    }
}

TEST(rig_lead, a_runaway_from_rest_is_seen) {
    uint64_t seed = 8;
    kind = rotor_nominal();
    for (int place = -2; place <= 2; place++) {
        /* Within a few degrees of the hanging position, where friction may hold the rotor. */
        const wh_real off_rad = WH_R(0.04) * (wh_real)place;
        stand_at(WH_PHASE_SPIN_UP,
                 (rotor_state){.ticks = UINT32_MAX - 100000U,
                               .angle_rad = place < 0 ? WH_RIG_TWO_PI + off_rad : off_rad,
                               .seed = draw_bits(&seed)});
        rig.run.volts = config.run.spin_up_V;
        run_away(WH_R(0.35));
    }
}

/* A friction of up to 0.1 N m vanishes at some instant, and the rotor becomes faster. With at least 0.7 times the
 * inertia the rig must not trip: the control loop corrects the speed. */
TEST(rig_lead, vanishing_load_is_no_runaway) {
    uint64_t seed = 9;
    for (unsigned trial = 0; trial < 60U; trial++) {
        kind = rotor_nominal();
        kind.inertia_kgm2 *=
            WH_R(0.7) + WH_R(0.05) * (wh_real)(trial % 20U) * (wh_real)(trial % 6U);
        kind.friction_Nm = WH_R(0.02) + WH_R(0.02) * (wh_real)(trial % 5U);
        stand_at(WH_PHASE_SETTLE, (rotor_state){.ticks = UINT32_MAX - 1500000U,
                                                .speed_radps = nominal_radps,
                                                .seed = draw_bits(&seed)});
        rig.run.volts += kind.friction_Nm / kind.stall_Nm * WH_RIG_RATED_V;
        wh_drive_start(&rig.run.drive, nominal_radps, rig.run.volts);
        rig.command = (wh_rig_command){WH_MOTOR_DRIVES, rig.run.volts};
        go_on(AS_ASKED, 700U + (unsigned)(draw_bits(&seed) >> 32) % 90U);
        kind.friction_Nm = WH_R(0.0);
        go_on(AS_ASKED, 350U);
        TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_NONE);
        TEST_ASSERT_TRUE(rig.run.phase == WH_PHASE_SETTLE);
    }
}

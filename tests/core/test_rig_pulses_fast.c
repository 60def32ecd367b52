/* test_rig_pulses_fast.c: how soon a runaway motor is detected from the pulses. */
#include <stddef.h>

#include "draw.h"
#include "even_rig.h"
#include "rotor.h"
#include "tests/suites.h"

#define STEP_TICKS EVEN_STEP_TICKS

static wh_rig rig;
static wh_rig_config config;
static uint64_t seed;
static const wh_real nominal_radps = WH_RIG_NOMINAL_RPM * EVEN_RPM;

static void stand_in(wh_rig_phase phase, uint32_t now_ticks) {
    config = even_config();
    wh_rig_start(&config, &rig, now_ticks, NULL);
    wh_run_start(&rig.run, nominal_radps, now_ticks);
    rig.state = WH_RIG_RUNNING;
    rig.run.phase = phase;
    rig.run.volts = wh_run_needs_V(&config.run, nominal_radps);
    rig.run.closed_ticks = now_ticks - 5U * WH_RIG_TICKS_PER_S;
    wh_drive_start(&rig.run.drive, nominal_radps, rig.run.volts);
}

/* Applies full voltage to the rotor, whatever the command. Returns the time until the rig trips, s. */
static wh_real run_away(rotor_state *rotor) {
    const rotor_kind kind = rotor_nominal();
    const uint32_t begin = rotor->ticks;
    wh_rig_inputs inputs = {.supply_V = WH_RIG_RATED_V};
    for (unsigned step = 0; step < 500U && rig.state != WH_RIG_TRIPPED; step++) {
        rotor_turn(&kind, rotor, WH_R(1.0), STEP_TICKS);
        for (unsigned i = 0; i < rotor->marks; i++) {
            wh_rig_pulse(&config, &rig, rotor->mark_sensor[i], rotor->mark_ticks[i]);
        }
        inputs.now_ticks = rotor->ticks;
        wh_rig_load(&config, &rig, rotor->ticks, step % 2U == 0 ? 3000 : -3000, WH_LOAD_OK);
        (void)wh_rig_step(&config, &rig, &inputs);
    }
    /* from rest, the runaway looks like a motor that is faster than its settings */
    TEST_ASSERT_TRUE(rig.guard.trip ==
                     (rig.record.phase == WH_PHASE_SPIN_UP ? WH_TRIP_FASTER : WH_TRIP_OVERSPEED));
    return (wh_real)(rotor->ticks - begin) / (wh_real)WH_RIG_TICKS_PER_S;
}

TEST(rig_pulses_fast, a_runaway_is_seen_at_any_place) {
    seed = 7;
    const rotor_kind kind = rotor_nominal();
    const wh_real drive =
        nominal_radps / kind.no_load_radps + kind.drag_Nms * nominal_radps / kind.stall_Nm;
    for (unsigned place = 0; place < 46U; place++) { /* at intervals of 4 ms over a turn */
        rotor_state rotor = {
            .ticks = UINT32_MAX - 2000000U, .speed_radps = nominal_radps, .seed = draw_bits(&seed)};
        stand_in(WH_PHASE_SETTLE, rotor.ticks);
        for (unsigned step = 0; step < 1000U + 2U * place; step++) {
            rotor_turn(&kind, &rotor, drive, STEP_TICKS);
            for (unsigned i = 0; i < rotor.marks; i++) {
                wh_rig_pulse(&config, &rig, rotor.mark_sensor[i], rotor.mark_ticks[i]);
            }
        }
        rig.run.since_ticks = rig.run.band_ticks = rig.run.ample_ticks = rotor.ticks;
        TEST_ASSERT_TRUE(run_away(&rotor) <= WH_R(0.25));
        /* the limit that docs/rig.md states */
        TEST_ASSERT_TRUE(rotor.speed_radps < WH_R(475.0) * EVEN_RPM);
    }
}

TEST(rig_pulses_fast, a_runaway_from_rest_is_seen) {
    seed = 8;
    for (int place = -2; place <= 2; place++) {
        /* within a few degrees of the hanging position, in which friction may hold it */
        rotor_state rotor = {.ticks = UINT32_MAX - 100000U,
                             .angle_rad = place < 0 ? WH_RIG_TWO_PI + WH_R(0.04) * (wh_real)place
                                                    : WH_R(0.04) * (wh_real)place,
                             .seed = draw_bits(&seed)};
        stand_in(WH_PHASE_SPIN_UP, rotor.ticks);
        rig.run.volts = config.run.spin_up_V;
        TEST_ASSERT_TRUE(run_away(&rotor) <= WH_R(0.35));
    }
}

static void go_on(const rotor_kind *kind, rotor_state *rotor, unsigned steps) {
    wh_rig_inputs inputs = {.supply_V = WH_RIG_RATED_V};
    for (unsigned step = 0; step < steps; step++) {
        rotor_turn(kind, rotor, rig.command.volts / WH_RIG_RATED_V, STEP_TICKS);
        for (unsigned i = 0; i < rotor->marks; i++) {
            wh_rig_pulse(&config, &rig, rotor->mark_sensor[i], rotor->mark_ticks[i]);
        }
        inputs.now_ticks = rotor->ticks;
        wh_rig_load(&config, &rig, rotor->ticks, step % 2U == 0 ? 3000 : -3000, WH_LOAD_OK);
        (void)wh_rig_step(&config, &rig, &inputs);
    }
}

/* A friction of up to 0.1 N m vanishes at some instant, and the rotor becomes faster. With at least 0.7 times the
 * inertia the rig must not trip: the control loop corrects the speed. */
TEST(rig_pulses_fast, a_load_that_goes_away_is_no_runaway) {
    seed = 9;
    for (unsigned trial = 0; trial < 60U; trial++) {
        rotor_kind kind = rotor_nominal();
        kind.inertia_kgm2 *=
            WH_R(0.7) + WH_R(0.05) * (wh_real)(trial % 20U) * (wh_real)(trial % 6U);
        kind.friction_Nm = WH_R(0.02) + WH_R(0.02) * (wh_real)(trial % 5U);
        rotor_state rotor = {
            .ticks = UINT32_MAX - 1500000U, .speed_radps = nominal_radps, .seed = draw_bits(&seed)};
        stand_in(WH_PHASE_SETTLE, rotor.ticks);
        rig.run.volts += kind.friction_Nm / kind.stall_Nm * WH_RIG_RATED_V;
        wh_drive_start(&rig.run.drive, nominal_radps, rig.run.volts);
        rig.command = (wh_rig_command){WH_MOTOR_DRIVES, rig.run.volts};
        go_on(&kind, &rotor, 700U + (unsigned)(draw_bits(&seed) >> 32) % 90U);
        kind.friction_Nm = WH_R(0.0);
        go_on(&kind, &rotor, 350U);
        TEST_ASSERT_TRUE(rig.guard.trip == WH_TRIP_NONE);
        TEST_ASSERT_TRUE(rig.run.phase == WH_PHASE_SETTLE);
    }
}

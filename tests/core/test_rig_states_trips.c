/* test_rig_states_trips.c: a tripped or stopped rig stays stopped. Trips in each phase, their record through a reset, `clear`,
 * `stop`, the stop input, a lost host, a rotor that turns at the controller's start. */
#include <stddef.h>

#include "even_rig.h"
#include "tests/suites.h"

static even_rig even;
static even_rig stood;

static void check_off(void) {
    TEST_ASSERT_TRUE(even.command.way != WH_MOTOR_DRIVES);
    TEST_ASSERT_FLOAT_WITHIN(0.0f, 0.0f, (float)even.command.volts);
}

static void check_tripped(wh_trip trip) {
    TEST_ASSERT_TRUE(even.rig.state == WH_RIG_TRIPPED && even.rig.run.phase == WH_PHASE_NONE);
    TEST_ASSERT_EQUAL_INT(trip, even.rig.guard.trip);
    TEST_ASSERT_TRUE(even.command.way == WH_MOTOR_COASTS);
    check_off();
}

/* Each order but `clear` and `stop` is refused by the trip, and nothing moves. */
static void check_latched(wh_trip trip) {
    static const wh_rig_event orders[] = {WH_EVENT_ARM, WH_EVENT_START, WH_EVENT_SET};
    for (unsigned i = 0; i < 3; i++) {
        TEST_ASSERT_TRUE(even_order(&even, orders[i], WH_R(330.0) * EVEN_RPM) ==
                         WH_REFUSED_TRIPPED);
        check_tripped(trip);
    }
    TEST_ASSERT_TRUE(even_order(&even, WH_EVENT_STOP, WH_R(0.0)) == WH_ALLOWED);
    check_tripped(trip);
    TEST_ASSERT_TRUE(even_order(&even, WH_EVENT_HOST_LOST, WH_R(0.0)) == WH_ALLOWED);
    check_tripped(trip);
}

static wh_refusal clear(void) { return even_order(&even, WH_EVENT_CLEAR, WH_R(0.0)); }

/* `clear` waits for rest and leads to idle only: the next run needs `arm` and `start`. */
static void check_clears(void) {
    for (unsigned i = 0; i < 20000U && !even.rig.rested; i++) {
        TEST_ASSERT_TRUE(i % 1000U != 0 || clear() == WH_REFUSED_TURNING);
        even_step(&even);
        check_off();
    }
    even_rest(&even);
    TEST_ASSERT_TRUE(clear() == WH_ALLOWED);
    TEST_ASSERT_TRUE(even.rig.state == WH_RIG_IDLE && even.rig.guard.trip == WH_TRIP_NONE);
    check_off();
    TEST_ASSERT_TRUE(even_order(&even, WH_EVENT_START, WH_R(330.0) * EVEN_RPM) ==
                     WH_REFUSED_NOT_ARMED);
    TEST_ASSERT_TRUE(even_order(&even, WH_EVENT_ARM, WH_R(0.0)) == WH_ALLOWED);
}

/* --- trips ------------------------------------------------------------------------------------------ */

/* Causes that trip the rig in any state, and their effects. */
static void break_supply(bool broken) {
    even.inputs.supply_V = broken ? WH_R(9.0) : WH_RIG_RATED_V;
}
static void break_watchdog(bool broken) { even.inputs.watchdog_has_cut = broken; }
static void break_cell(bool broken) {
    even.fails =
        (even_failure){.in = broken ? WH_PHASE_NONE : EVEN_NEVER, .status = WH_LOAD_DISCONNECTED};
    even.failing = broken;
}

typedef struct fault {
    void (*breaks)(bool broken);
    wh_trip trip;
    wh_refusal while_broken; /* `clear` of a rig at rest */
} fault;

static const fault faults[] = {
    {break_supply, WH_TRIP_SUPPLY, WH_REFUSED_SUPPLY},
    {break_watchdog, WH_TRIP_WATCHDOG, WH_REFUSED_WATCHDOG},
    {break_cell, WH_TRIP_LOAD_CELL, WH_REFUSED_LOAD_CELL},
};

static void check_record(const wh_trip_record *record, wh_trip trip, wh_rig_phase phase) {
    TEST_ASSERT_TRUE(record->trip == trip && record->phase == phase);
    TEST_ASSERT_EQUAL_UINT32(even.inputs.now_ticks, record->ticks);
    TEST_ASSERT_FLOAT_WITHIN(0.0f, (float)even.inputs.supply_V, (float)record->supply_V);
    const bool drives = phase >= WH_PHASE_SPIN_UP && phase <= WH_PHASE_RAMP_DOWN;
    TEST_ASSERT_TRUE(drives ? record->volts > WH_R(5.0) : !(record->volts > WH_R(0.0)));
    TEST_ASSERT_FLOAT_WITHIN(0.0f, (float)even.rig.pulses.speed.turn_radps,
                             (float)record->speed_radps);
    TEST_ASSERT_TRUE((record->speed_radps > WH_R(100.0) * EVEN_RPM) ==
                     (phase >= WH_PHASE_RAMP && drives));
}

/* The record goes through a reset, at another timer value, and is latched again. */
static void check_reset(wh_trip trip) {
    const wh_trip_record record = even.rig.record;
    const uint32_t now = even.inputs.now_ticks + 12345678U;
    const even_rig before = even;
    even_start(&even);
    even.inputs = before.inputs;
    even.inputs.now_ticks = now;
    even.fails = before.fails;
    even.failing = before.failing;
    wh_rig_start(&even.config, &even.rig, now, &record);
    TEST_ASSERT_TRUE(even.rig.state == WH_RIG_TRIPPED && even.rig.guard.trip == trip);
    TEST_ASSERT_TRUE(even.rig.record.ticks == record.ticks && !even.rig.rested);
    even_step(&even);
    check_tripped(trip);
    check_latched(trip);
    TEST_ASSERT_TRUE(clear() == WH_REFUSED_TURNING); /* the rotor's motion is unknown */
}

/* In each phase of a run, and armed: off in the same step, latched, through a reset, until rest and the cause is gone. */
TEST(rig_states_trips, trips_latch) {
    for (unsigned i = 0; i < 3; i++) {
        for (wh_rig_phase phase = WH_PHASE_NONE; phase <= WH_PHASE_RAMP_DOWN; phase++) {
            if (phase == WH_PHASE_NONE) {
                even_arm(&even);
            } else {
                even_reach(&even, phase);
            }
            faults[i].breaks(true);
            even_step(&even);
            check_tripped(faults[i].trip);
            check_record(&even.rig.record, faults[i].trip, phase);
            check_latched(faults[i].trip);
            check_reset(faults[i].trip);
            even_go_on_until(&even, EVEN_NEVER);
            TEST_ASSERT_TRUE(clear() == faults[i].while_broken);
            check_tripped(faults[i].trip);
            faults[i].breaks(false);
            check_clears();
        }
    }
}

TEST(rig_states_trips, a_reset_without_a_trip_is_idle) {
    const wh_trip_record none = {.trip = WH_TRIP_NONE, .ticks = 7};
    even_start(&even);
    wh_rig_start(&even.config, &even.rig, even.inputs.now_ticks, &none);
    TEST_ASSERT_TRUE(even.rig.state == WH_RIG_IDLE && even.rig.guard.trip == WH_TRIP_NONE);
    even_rest(&even);
    TEST_ASSERT_TRUE(even.rig.state == WH_RIG_IDLE);
}

/* Implausible pulses cannot show rest: that trip waits only for its time. */
TEST(rig_states_trips, a_trip_for_its_pulses_waits_longer) {
    even_failure failing = {.in = WH_PHASE_SETTLE};
    failing.lose[0] = failing.lose[1] = EVEN_ALWAYS;
    even_begin(&even, WH_R(330.0), &failing);
    for (unsigned i = 0; i < 20000U && even.rig.state != WH_RIG_TRIPPED; i++) {
        even_step(&even);
    }
    check_tripped(WH_TRIP_PULSES);
    even_steps(&even, 20U * 500U - 1U);
    TEST_ASSERT_TRUE(clear() == WH_REFUSED_TURNING && !even.rig.rested);
    even_step(&even);
    TEST_ASSERT_TRUE(even.rig.rested && clear() == WH_REFUSED_TURNING); /* unknown */
    even_steps(&even, 100U * 500U);
    TEST_ASSERT_TRUE(clear() == WH_ALLOWED && even.rig.state == WH_RIG_IDLE);
}

/* The wait is over, but `clear` is still refused while the rotor turns. */
TEST(rig_states_trips, a_turning_rotor_is_not_cleared) {
    even_arm(&even);
    break_supply(true);
    even_step(&even);
    break_supply(false);
    even_turn_by_hand(&even, WH_R(60.0));
    even_steps(&even, 25U * 500U);
    TEST_ASSERT_TRUE(even.rig.rested && clear() == WH_REFUSED_TURNING);
    check_tripped(WH_TRIP_SUPPLY);
    even_turn_by_hand(&even, WH_R(0.0));
    check_clears();
}

/* --- stop ------------------------------------------------------------------------------------------ */

typedef enum stop_way { STOP_ORDER, STOP_INPUT, STOP_HOST_LOST, STOP_WAYS } stop_way;

static void stop(stop_way way) {
    if (way == STOP_INPUT) {
        even.inputs.stop_pressed = true;
        even_step(&even);
    } else {
        (void)even_order(&even, way == STOP_ORDER ? WH_EVENT_STOP : WH_EVENT_HOST_LOST, WH_R(0.0));
    }
}

/* In every phase the motor is off in the same step until the rotor rests. Then `arm` is allowed unless stop is still pressed. */
TEST(rig_states_trips, stop_is_at_once) {
    for (wh_rig_phase phase = WH_PHASE_TARE; phase <= WH_PHASE_OFF; phase++) {
        even_reach(&even, phase);
        stood = even;
        for (stop_way way = STOP_ORDER; way < STOP_WAYS; way++) {
            for (unsigned brakes = 0; brakes < 2; brakes++) {
                even = stood;
                even.config.stop_brakes = brakes == 1;
                stop(way);
                check_off();
                TEST_ASSERT_TRUE(even.rig.state == WH_RIG_STOPPING &&
                                 even.rig.run.phase == WH_PHASE_OFF);
                /* a stop never switches the enable on */
                const bool enabled = phase != WH_PHASE_TARE && phase != WH_PHASE_OFF;
                TEST_ASSERT_TRUE(even.command.way == (brakes == 1 && enabled && way != STOP_INPUT
                                                          ? WH_MOTOR_BRAKES
                                                          : WH_MOTOR_COASTS));
                TEST_ASSERT_TRUE(even_order(&even, WH_EVENT_START, WH_R(330.0) * EVEN_RPM) ==
                                 WH_REFUSED_STOPPING);
                unsigned steps = 0;
                for (; steps < 1000U && even.rig.state == WH_RIG_STOPPING; steps++) {
                    even_step(&even);
                    check_off();
                }
                TEST_ASSERT_TRUE(even.rig.state == WH_RIG_IDLE && steps >= 700U);
                TEST_ASSERT_TRUE(even.rig.guard.trip == WH_TRIP_NONE);
                TEST_ASSERT_TRUE(even_order(&even, WH_EVENT_ARM, WH_R(0.0)) ==
                                 (way == STOP_INPUT ? WH_REFUSED_STOP_INPUT : WH_ALLOWED));
            }
        }
    }
    for (stop_way way = STOP_ORDER; way < STOP_WAYS; way++) { /* no longer armed */
        even_arm(&even);
        stop(way);
        check_off();
        TEST_ASSERT_TRUE(even.rig.state == WH_RIG_IDLE);
    }
}

/* As configured: without a host a run goes on to its end. */
TEST(rig_states_trips, a_run_may_outlive_its_host) {
    for (wh_rig_phase phase = WH_PHASE_TARE; phase <= WH_PHASE_RAMP_DOWN; phase++) {
        even_reach(&even, phase);
        even.config.host_loss_stops = false;
        TEST_ASSERT_TRUE(even_order(&even, WH_EVENT_HOST_LOST, WH_R(0.0)) == WH_ALLOWED);
        TEST_ASSERT_TRUE(even.rig.run.phase == phase);
        even_go_on_until(&even, EVEN_NEVER);
        TEST_ASSERT_TRUE(even_is_done(&even));
    }
}

/* --- the controller's start -------------------------------------------------------------------------- */

/* The rotor still turns: no trip, `arm` is refused, and the rotor is watched. */
TEST(rig_states_trips, a_reset_while_the_rotor_turns) {
    static const wh_real speeds_rpm[] = {WH_R(60.0), WH_R(170.0), WH_R(330.0), WH_R(390.0)};
    for (unsigned i = 0; i < 4; i++) {
        even_start(&even);
        even_turn_by_hand(&even, speeds_rpm[i]);
        for (unsigned step = 0; step < 3000U; step++) {
            even_step(&even);
            check_off();
            TEST_ASSERT_TRUE(even.rig.state == WH_RIG_IDLE);
        }
        TEST_ASSERT_TRUE(even_order(&even, WH_EVENT_ARM, WH_R(0.0)) == WH_REFUSED_TURNING);
        even_turn_by_hand(&even, WH_R(0.0));
        even_rest(&even);
        TEST_ASSERT_TRUE(even_order(&even, WH_EVENT_ARM, WH_R(0.0)) == WH_ALLOWED);
    }
    even_start(&even); /* faster than the shaft can take */
    even_turn_by_hand(&even, WH_R(410.0));
    even_steps(&even, 1000);
    check_tripped(WH_TRIP_OVERSPEED);
    even_start(&even); /* from rest, with the motor off: a stage drives it */
    even_rest(&even);
    even_turn_by_hand(&even, WH_R(300.0));
    even_steps(&even, 1000);
    check_tripped(WH_TRIP_RUNS_ON);
}

/* --- a rotor turned by hand -------------------------------------------------------------------------- */

/* Armed, a rotor may shiver: two pulses. The third is a hand that turns it. */
TEST(rig_states_trips, armed_is_no_more_when_somebody_turns_the_rotor) {
    for (unsigned i = 0; i < 8U; i++) { /* of either sensor */
        even_arm(&even);
        for (unsigned pulses = 1; pulses <= 3U; pulses++) {
            wh_rig_pulse(&even.config, &even.rig, i >> (pulses - 1U) & 1U, even.inputs.now_ticks);
            even_steps(&even, 3);
            TEST_ASSERT_TRUE(even.rig.state == (pulses <= 2U ? WH_RIG_ARMED : WH_RIG_IDLE));
        }
    }
}

/* After any rest a hand's pulses are not compared with earlier ones: the timer wraps after 72 minutes, half of which is future. */
TEST(rig_states_trips, rest_may_last_any_time) {
    for (unsigned i = 0; i < 24U; i++) {
        even_start(&even);
        even_rest(&even);
        even_turn_by_hand(&even, WH_R(60.0));
        even_steps(&even, 800);
        even_turn_by_hand(&even, WH_R(0.0));
        const uint32_t last = even.rig.pulses.speed.ticks;
        const uint32_t rejected = even.rig.pulses.rejected;
        even_rest(&even);
        TEST_ASSERT_FALSE(even.rig.pulses.speed.running);
        const uint32_t wakes =
            last + (i % 3U == 0 ? UINT32_C(0x80000000) : 0U) + UINT32_C(5000) * i;
        for (unsigned s = 0; s < 4294U; s++) { /* a second each */
            even.inputs.now_ticks += 1000000U - EVEN_STEP_TICKS;
            even_step(&even);
            if (s > 5U && wakes - even.inputs.now_ticks < 2000000U) {
                break;
            }
        }
        even.inputs.now_ticks = wakes;
        even_turn_by_hand(&even, WH_R(60.0));
        even_steps(&even, 1600);
        TEST_ASSERT_TRUE(even.rig.guard.trip == WH_TRIP_NONE && even.rig.state == WH_RIG_IDLE);
        TEST_ASSERT_EQUAL_UINT32(rejected, even.rig.pulses.rejected);
        TEST_ASSERT_FLOAT_WITHIN(0.1f, 60.0f, (float)(even.rig.pulses.speed.turn_radps / EVEN_RPM));
    }
}

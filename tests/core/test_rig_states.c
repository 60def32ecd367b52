/* test_rig_states.c: the life cycle of the rig, its trips, and random orders. */
#include <stddef.h>

#include "draw.h"
#include "even_rig.h"
#include "tests/suites.h"

/* Numbers that are neither a voltage nor a speed. */
#define STRANGE \
    WH_R(1e30), (wh_real)__builtin_inff(), (wh_real)-__builtin_inff(), (wh_real)__builtin_nanf("")

static even_rig even;
static even_rig stood;

static void stand_tripped(void) {
    even_arm(&even);
    even.inputs.supply_V = WH_R(0.0);
    even_step(&even);
    even.inputs.supply_V = WH_RIG_RATED_V;
    TEST_ASSERT_TRUE(even.rig.state == WH_RIG_TRIPPED);
    even_go_on_until(&even, EVEN_NEVER);
    TEST_ASSERT_TRUE(even.rig.rested);
}

/* Puts the rig into this state and fulfils all other conditions: only the state can refuse an order. */
static void stand_in(wh_rig_state state) {
    switch (state) {
    case WH_RIG_IDLE:
        even_start(&even);
        even_rest(&even);
        break;
    case WH_RIG_ARMED: even_arm(&even); break;
    case WH_RIG_RUNNING: even_reach(&even, WH_PHASE_TARE); break;
    case WH_RIG_STOPPING: even_reach(&even, WH_PHASE_OFF); break;
    case WH_RIG_TRIPPED: stand_tripped(); break;
    case WH_RIG_STATES: break;
    }
    TEST_ASSERT_TRUE(even.rig.state == state);
}

/* An event's effect in each of the states idle, armed, running, stopping, tripped: the first letter of the next state,
 * or a refusal. Refusals: `-` not armed, `a` armed, `r` running, `s` stopping, `t` tripped, `n` no trip, `x` not
 * running. */
typedef struct expectation {
    wh_rig_event event;
    bool is_order; /* an order from outside; other events are refused if posted */
    const char *becomes;
} expectation;

static const expectation expected[] = {
    {WH_EVENT_ARM, true, "Aarst"},      {WH_EVENT_START, true, "-Rrst"},
    {WH_EVENT_SET, true, "xxRst"},      {WH_EVENT_STOP, true, "IISST"},
    {WH_EVENT_CLEAR, true, "nnnnI"},    {WH_EVENT_HOST_LOST, true, "IISST"},
    {WH_EVENT_DONE, false, "xxSst"},    {WH_EVENT_RESTED, false, "IARIT"},
    {WH_EVENT_EXPIRED, false, "IIRST"}, {WH_EVENT_TRIP, false, "TTTTT"},
};

static bool is_state(char letter) { return letter >= 'A' && letter <= 'Z'; }

static wh_rig_state state_of(char letter) {
    return letter == 'I'   ? WH_RIG_IDLE
           : letter == 'A' ? WH_RIG_ARMED
           : letter == 'R' ? WH_RIG_RUNNING
           : letter == 'S' ? WH_RIG_STOPPING
                           : WH_RIG_TRIPPED;
}

static wh_refusal refusal_of(char letter) {
    return is_state(letter) ? WH_ALLOWED
           : letter == '-'  ? WH_REFUSED_NOT_ARMED
           : letter == 'a'  ? WH_REFUSED_ARMED
           : letter == 'r'  ? WH_REFUSED_RUNNING
           : letter == 's'  ? WH_REFUSED_STOPPING
           : letter == 't'  ? WH_REFUSED_TRIPPED
           : letter == 'n'  ? WH_REFUSED_NO_TRIP
                            : WH_REFUSED_NOT_RUNNING;
}

TEST(rig_states, the_table_has_every_pair) {
    TEST_ASSERT_EQUAL_UINT(WH_EVENTS, sizeof expected / sizeof expected[0]);
    for (unsigned i = 0; i < WH_EVENTS; i++) {
        for (unsigned state = 0; state < WH_RIG_STATES; state++) {
            const char letter = expected[i].becomes[state];
            const wh_rig_transition rule =
                wh_rig_transition_of((wh_rig_state)state, expected[i].event);
            TEST_ASSERT_TRUE(rule.refusal == refusal_of(letter));
            TEST_ASSERT_TRUE(rule.next ==
                             (is_state(letter) ? state_of(letter) : (wh_rig_state)state));
        }
    }
    static const int strange[] = {-1, 100, 200, INT16_MAX}; /* the low byte of each is not 0 */
    for (unsigned i = 0; i < 4; i++) {
        const wh_rig_transition event =
            wh_rig_transition_of(WH_RIG_ARMED, (wh_rig_event)strange[i]);
        const wh_rig_transition state =
            wh_rig_transition_of((wh_rig_state)strange[i], WH_EVENT_ARM);
        TEST_ASSERT_TRUE(event.refusal == WH_REFUSED_EVENT && event.next == WH_RIG_ARMED);
        TEST_ASSERT_TRUE(state.refusal == WH_REFUSED_EVENT);
    }
    TEST_ASSERT_TRUE(wh_rig_transition_of(WH_RIG_STATES, WH_EVENT_ARM).refusal == WH_REFUSED_EVENT);
    TEST_ASSERT_TRUE(wh_rig_transition_of(WH_RIG_ARMED, WH_EVENTS).refusal == WH_REFUSED_EVENT);
}

static void check_answer(const expectation *of, wh_rig_state state) {
    const char letter = of->becomes[state];
    const wh_refusal answer = even_order(&even, of->event, WH_R(250.0) * EVEN_RPM);
    TEST_ASSERT_TRUE(answer == (of->is_order ? refusal_of(letter) : WH_REFUSED_EVENT));
    const bool goes = of->is_order && is_state(letter);
    TEST_ASSERT_TRUE(even.rig.state == (goes ? state_of(letter) : state));
    TEST_ASSERT_TRUE(even.rig.state == WH_RIG_TRIPPED || even.rig.guard.trip == WH_TRIP_NONE);
    TEST_ASSERT_TRUE(even.command.way != WH_MOTOR_DRIVES || wh_run_drives(&even.rig.run));
}

TEST(rig_states, every_event_in_every_state) {
    for (wh_rig_state state = WH_RIG_IDLE; state < WH_RIG_STATES; state++) {
        stand_in(state);
        stood = even;
        for (unsigned i = 0; i < WH_EVENTS; i++) {
            even = stood;
            check_answer(&expected[i], state);
        }
        for (int event = (int)WH_EVENTS; event <= (int)WH_EVENTS + 3; event++) {
            const wh_rig_event unknown = (wh_rig_event)(event > (int)WH_EVENTS + 2 ? -1 : event);
            TEST_ASSERT_TRUE(even_order(&even, unknown, WH_R(1.0)) == WH_REFUSED_EVENT);
        }
    }
    for (wh_rig_phase phase = WH_PHASE_TARE; phase <= WH_PHASE_RAMP_DOWN; phase++) {
        even_reach(&even, phase);
        stood = even;
        for (unsigned i = 0; i < WH_EVENTS; i++) {
            even = stood;
            check_answer(&expected[i],
                         phase == WH_PHASE_RAMP_DOWN ? WH_RIG_STOPPING : WH_RIG_RUNNING);
        }
    }
}

static wh_refusal arm(void) { return even_order(&even, WH_EVENT_ARM, WH_R(0.0)); }

static void check_refused(wh_refusal answer, wh_refusal why, wh_rig_state state) {
    TEST_ASSERT_EQUAL_INT(why, answer);
    TEST_ASSERT_TRUE(even.rig.state == state);
    TEST_ASSERT_TRUE(even.command.way == WH_MOTOR_COASTS);
}

TEST(rig_states, conditions_of_arm) {
    stand_in(WH_RIG_IDLE);
    stood = even;
    even.inputs.stop_pressed = true;
    check_refused(arm(), WH_REFUSED_STOP_INPUT, WH_RIG_IDLE);
    even = stood;
    even.inputs.clock_is_fallback = true;
    check_refused(arm(), WH_REFUSED_CLOCK, WH_RIG_IDLE);
    const wh_real supplies_V[] = {WH_R(0.0), WH_R(-24.0), WH_R(10.0), WH_R(38.0), STRANGE};
    for (unsigned i = 0; i < sizeof supplies_V / sizeof supplies_V[0]; i++) {
        even = stood;
        even.inputs.supply_V = supplies_V[i];
        check_refused(arm(), WH_REFUSED_SUPPLY, WH_RIG_IDLE);
        /* In the state idle the cell is not needed. */
        TEST_ASSERT_TRUE(even.rig.guard.trip == WH_TRIP_NONE);
    }
    even = stood;
    even.fails = (even_failure){.in = WH_PHASE_NONE, .lose_samples = EVEN_ALWAYS};
    even_steps(&even, 11);
    check_refused(arm(), WH_REFUSED_LOAD_CELL, WH_RIG_IDLE);
    for (unsigned minute = 0; minute < 160U;
         minute++) { /* more than two wraps of the timer without a pulse */
        even.inputs.now_ticks += 60U * WH_RIG_TICKS_PER_S;
        check_refused(arm(), WH_REFUSED_LOAD_CELL, WH_RIG_IDLE);
    }
    for (wh_load_status status = WH_LOAD_SATURATED; status <= WH_LOAD_DISCONNECTED; status++) {
        even = stood;
        even.fails = (even_failure){.in = WH_PHASE_NONE, .status = status};
        check_refused(arm(), WH_REFUSED_LOAD_CELL, WH_RIG_IDLE);
    }
    even = stood; /* next case: a trip after the orders */
    even.inputs.watchdog_has_cut = true;
    check_refused(arm(), WH_REFUSED_WATCHDOG, WH_RIG_TRIPPED);
    even_start(&even); /* next case: the controller does not know yet that the rotor rests */
    check_refused(arm(), WH_REFUSED_TURNING, WH_RIG_IDLE);
    even = stood; /* next case: a single pulse */
    even.fails = (even_failure){.in = WH_PHASE_NONE, .adds = {true, false}};
    check_refused(arm(), WH_REFUSED_TURNING, WH_RIG_IDLE);
    even_steps(&even, 740);
    check_refused(arm(), WH_REFUSED_TURNING, WH_RIG_IDLE);
    even_steps(&even, 20);
    TEST_ASSERT_TRUE(arm() == WH_ALLOWED && even.rig.state == WH_RIG_ARMED);
}

TEST(rig_states, conditions_of_start_and_set) {
    const wh_real wrong_rpm[] = {WH_R(0.0), WH_R(-330.0), WH_R(1.0), WH_R(361.0), STRANGE};
    for (unsigned running = 0; running < 2; running++) {
        const wh_rig_event event = running == 0 ? WH_EVENT_START : WH_EVENT_SET;
        const wh_rig_state state = running == 0 ? WH_RIG_ARMED : WH_RIG_RUNNING;
        stand_in(state);
        stood = even;
        for (unsigned i = 0; i < sizeof wrong_rpm / sizeof wrong_rpm[0]; i++) {
            check_refused(even_order(&even, event, wrong_rpm[i] * EVEN_RPM), WH_REFUSED_TARGET,
                          state);
        }
        even.inputs.supply_V = WH_R(12.0); /* 330 rpm need 14 V, 250 rpm need 10.8 V */
        check_refused(even_order(&even, event, WH_R(330.0) * EVEN_RPM), WH_REFUSED_VOLTAGE, state);
        even_obeys(&even, event, WH_R(250.0) * EVEN_RPM);
        CHECK_NEAR(1e-3f, 250.0f, even.rig.run.target_radps / EVEN_RPM);
    }
    stand_in(WH_RIG_ARMED); /* allowed: lowest supply, slowest set-point, no compensation */
    const wh_real slowest = even.config.guard.target_min_radps;
    even.inputs.supply_V = wh_run_needs_V(&even.config.run, slowest);
    even.config.guard.supply_min_V = WH_R(1.0);
    even.config.compensation_when = WH_COMPENSATION_SLOW;
    even_obeys(&even, WH_EVENT_START, slowest);
    TEST_ASSERT_FALSE(even.rig.compensated);
    for (unsigned never = 0; never < 2;
         /* slower set-points need an observer, and gravity compensation must be permitted */
         never++) {
        stand_in(WH_RIG_ARMED);
        even.rig.observer.status = WH_OK;
        even.config.compensation_when = never == 1 ? WH_COMPENSATION_NEVER : WH_COMPENSATION_SLOW;
        TEST_ASSERT_TRUE(even_order(&even, WH_EVENT_START, WH_R(110.0) * EVEN_RPM) ==
                         (never == 1 ? WH_REFUSED_TARGET : WH_ALLOWED));
        TEST_ASSERT_TRUE(even.rig.compensated == (never == 0));
    }
    stand_in(WH_RIG_ARMED); /* the stop input disarms the rig before the order is processed */
    even.inputs.stop_pressed = true;
    check_refused(even_order(&even, WH_EVENT_START, WH_R(330.0) * EVEN_RPM), WH_REFUSED_NOT_ARMED,
                  WH_RIG_IDLE);
}

/* A step accepts four orders and refuses a fifth at once. All five are answered, in order. */
TEST(rig_states, too_many_orders) {
    stand_in(WH_RIG_IDLE);
    for (unsigned i = 0; i < WH_RIG_ORDERS_MOST; i++) {
        TEST_ASSERT_TRUE(wh_rig_post(&even.rig, i < 2U ? WH_EVENT_STOP : WH_EVENT_ARM, WH_R(0.0)));
    }
    TEST_ASSERT_FALSE(wh_rig_post(&even.rig, WH_EVENT_START, WH_R(330.0) * EVEN_RPM));
    const uint32_t answers = even.rig.answers;
    even_step(&even);
    TEST_ASSERT_EQUAL_UINT32(answers + WH_RIG_ORDERS_MOST, even.rig.answers);
    check_refused(even.rig.answer, WH_REFUSED_ARMED, WH_RIG_ARMED);
    even_obeys(&even, WH_EVENT_STOP, WH_R(0.0));
}

TEST(rig_states, armed_lasts_a_minute) {
    stand_in(WH_RIG_ARMED);
    even_steps(&even, 30000U);
    TEST_ASSERT_TRUE(even.rig.state == WH_RIG_ARMED);
    even_step(&even);
    check_refused(even_order(&even, WH_EVENT_START, WH_R(330.0) * EVEN_RPM), WH_REFUSED_NOT_ARMED,
                  WH_RIG_IDLE);
    TEST_ASSERT_TRUE(arm() == WH_ALLOWED);
}

/* A hand turns the armed rig's rotor, slowly or fast: no trip, but the rig is disarmed and cannot start. */
TEST(rig_states, armed_ends_when_the_rotor_turns) {
    static const wh_real hands_rpm[] = {WH_R(20.0), WH_R(60.0), WH_R(100.0), WH_R(140.0)};
    for (unsigned i = 0; i < 4; i++) {
        stand_in(WH_RIG_ARMED);
        even_turn_by_hand(&even, hands_rpm[i]);
        unsigned steps = 0;
        for (; steps < 5000U && even.rig.state == WH_RIG_ARMED; steps++) {
            even_step(&even);
            TEST_ASSERT_TRUE(even.command.way == WH_MOTOR_COASTS);
        }
        TEST_ASSERT_TRUE(even.rig.state == WH_RIG_IDLE);
        /* Jitter may make two pulses. The third comes after a turn. */
        TEST_ASSERT_TRUE((float)steps <= 60.0f / (float)hands_rpm[i] * 500.0f + 2.0f);
        even_steps(&even, 2000);
        TEST_ASSERT_TRUE(even.rig.state == WH_RIG_IDLE && even.rig.guard.trip == WH_TRIP_NONE);
        TEST_ASSERT_TRUE(arm() == WH_REFUSED_TURNING);
        even_turn_by_hand(&even, WH_R(0.0));
        even_rest(&even);
        TEST_ASSERT_TRUE(arm() == WH_ALLOWED);
    }
}

/* === rig states trips ======================================================================== */

static void check_off(void) {
    TEST_ASSERT_TRUE(even.command.way != WH_MOTOR_DRIVES);
    CHECK_NEAR(0.0f, 0.0f, even.command.volts);
}

static void check_tripped(wh_trip trip) {
    TEST_ASSERT_TRUE(even.rig.state == WH_RIG_TRIPPED && even.rig.run.phase == WH_PHASE_NONE);
    TEST_ASSERT_EQUAL_INT(trip, even.rig.guard.trip);
    TEST_ASSERT_TRUE(even.command.way == WH_MOTOR_COASTS);
    check_off();
}

/* Checks that the trip refuses each order except `clear` and `stop`, and that nothing moves. */
static void check_latched(wh_trip trip) {
    static const wh_rig_event orders[] = {WH_EVENT_ARM, WH_EVENT_START, WH_EVENT_SET};
    for (unsigned i = 0; i < 3; i++) {
        TEST_ASSERT_TRUE(even_order(&even, orders[i], WH_R(330.0) * EVEN_RPM) ==
                         WH_REFUSED_TRIPPED);
        check_tripped(trip);
    }
    even_obeys(&even, WH_EVENT_STOP, WH_R(0.0));
    check_tripped(trip);
    even_obeys(&even, WH_EVENT_HOST_LOST, WH_R(0.0));
    check_tripped(trip);
}

static wh_refusal clear(void) { return even_order(&even, WH_EVENT_CLEAR, WH_R(0.0)); }

/* Checks that `clear` is refused until the rotor rests, and leads only to idle: the next run needs `arm` and then
 * `start`. */
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
    even_obeys(&even, WH_EVENT_ARM, WH_R(0.0));
}

/* Causes of a trip in any state: each function switches one on or off. */
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
    wh_refusal while_broken; /* the answer to `clear` at rest while the cause persists */
} fault;

static const fault faults[] = {
    {break_supply, WH_TRIP_SUPPLY, WH_REFUSED_SUPPLY},
    {break_watchdog, WH_TRIP_WATCHDOG, WH_REFUSED_WATCHDOG},
    {break_cell, WH_TRIP_LOAD_CELL, WH_REFUSED_LOAD_CELL},
};

static void check_record(const wh_trip_record *record, wh_trip trip, wh_rig_phase phase) {
    TEST_ASSERT_TRUE(record->trip == trip && record->phase == phase);
    TEST_ASSERT_EQUAL_UINT32(even.inputs.now_ticks, record->ticks);
    CHECK_NEAR(0.0f, even.inputs.supply_V, record->supply_V);
    const bool drives = phase >= WH_PHASE_SPIN_UP && phase <= WH_PHASE_RAMP_DOWN;
    TEST_ASSERT_TRUE(drives ? record->volts > WH_R(5.0) : !(record->volts > WH_R(0.0)));
    CHECK_NEAR(0.0f, even.rig.pulses.speed.turn_radps, record->speed_radps);
    TEST_ASSERT_TRUE((record->speed_radps > WH_R(100.0) * EVEN_RPM) ==
                     (phase >= WH_PHASE_RAMP && drives));
}

/* The record survives a reset, with another value of the timer, and the trip is latched again. */
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
    /* the controller does not know whether the rotor moves */
    TEST_ASSERT_TRUE(clear() == WH_REFUSED_TURNING);
}

/* In each phase of a run, and armed, a trip switches the motor off in the same step. It stays latched, also through a reset,
 * until the rotor rests and the cause is gone. */
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

/* Unreliable pulses cannot show that the rotor rests. After such a trip, `clear` is allowed after tripped_max_s. */
TEST(rig_states_trips, pulse_trip_waits_longer) {
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
    /* Rest is assumed, not known. */
    TEST_ASSERT_TRUE(even.rig.rested && clear() == WH_REFUSED_TURNING);
    even_steps(&even, 100U * 500U);
    TEST_ASSERT_TRUE(clear() == WH_ALLOWED && even.rig.state == WH_RIG_IDLE);
}

/* The waiting time is over, but while the rotor turns, `clear` is still refused. */
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

typedef enum stop_way { STOP_ORDER, STOP_INPUT, STOP_HOST_LOST, STOP_WAYS } stop_way;

static void stop(stop_way way) {
    if (way == STOP_INPUT) {
        even.inputs.stop_pressed = true;
        even_step(&even);
    } else {
        (void)even_order(&even, way == STOP_ORDER ? WH_EVENT_STOP : WH_EVENT_HOST_LOST, WH_R(0.0));
    }
}

/* In every phase `stop` switches the motor off in the same step. When the rotor rests, `arm` is allowed, unless the
 * stop input is still pressed. */
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
                /* `stop` never switches the enable on. */
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
    for (stop_way way = STOP_ORDER; way < STOP_WAYS; way++) {
        /* Each way of stopping also ends the state armed. */
        even_arm(&even);
        stop(way);
        check_off();
        TEST_ASSERT_TRUE(even.rig.state == WH_RIG_IDLE);
    }
}

/* If so configured, a run whose host is lost goes on to its end. */
TEST(rig_states_trips, run_goes_on_without_host) {
    for (wh_rig_phase phase = WH_PHASE_TARE; phase <= WH_PHASE_RAMP_DOWN; phase++) {
        even_reach(&even, phase);
        even.config.host_loss_stops = false;
        even_obeys(&even, WH_EVENT_HOST_LOST, WH_R(0.0));
        TEST_ASSERT_TRUE(even.rig.run.phase == phase);
        even_go_on_until(&even, EVEN_NEVER);
        TEST_ASSERT_TRUE(even_is_done(&even));
    }
}

/* A reset while the rotor turns causes no trip. `arm` is refused until the rotor rests. */
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
        even_obeys(&even, WH_EVENT_ARM, WH_R(0.0));
    }
    even_start(&even); /* the rotor is faster than the shaft's limit */
    even_turn_by_hand(&even, WH_R(410.0));
    even_steps(&even, 1000);
    check_tripped(WH_TRIP_OVERSPEED);
    /* The rotor accelerates from rest with the motor off: a stuck stage drives it. */
    even_start(&even);
    even_rest(&even);
    even_turn_by_hand(&even, WH_R(300.0));
    even_steps(&even, 1000);
    check_tripped(WH_TRIP_RUNS_ON);
}

/* An armed rig tolerates two pulses, because a hanging rotor may give them by jitter. The third shows that a hand turns
 * the rotor. */
TEST(rig_states_trips, turning_the_rotor_ends_armed) {
    for (unsigned i = 0; i < 8U; i++) { /* pulses of either sensor */
        even_arm(&even);
        for (unsigned pulses = 1; pulses <= 3U; pulses++) {
            wh_rig_pulse(&even.config, &even.rig, i >> (pulses - 1U) & 1U, even.inputs.now_ticks);
            even_steps(&even, 3);
            TEST_ASSERT_TRUE(even.rig.state == (pulses <= 2U ? WH_RIG_ARMED : WH_RIG_IDLE));
        }
    }
}

/* The rotor was at rest for any time. Then pulses by a hand must not be compared with those before the rest. The timer
 * wraps after 72 minutes, and differences of more than half of that are negative. */
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
        for (unsigned s = 0; s < 4294U; s++) { /* one second each */
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
        CHECK_NEAR(0.1f, 60.0f, even.rig.pulses.speed.turn_radps / EVEN_RPM);
    }
}

/* === rig states random ======================================================================= */

static uint32_t result_end_ticks;
static uint64_t seed;

/* A new set-point in any phase before the result: the rig settles at it, and the record restarts. */
TEST(rig_states_random, new_set_point_during_a_run) {
    for (wh_rig_phase phase = WH_PHASE_TARE; phase <= WH_PHASE_RECORD; phase++) {
        even_reach(&even, phase);
        even_steps(&even, 100); /* a record of these steps is dropped later */
        TEST_ASSERT_TRUE(even.rig.run.phase == phase);
        even_obeys(&even, WH_EVENT_SET, WH_R(250.0) * EVEN_RPM);
        TEST_ASSERT_TRUE(even.rig.run.phase == (phase > WH_PHASE_RAMP ? WH_PHASE_RAMP : phase));
        even_go_on_until(&even, WH_PHASE_RECORD);
        const uint32_t begin = even.inputs.now_ticks;
        CHECK_NEAR(0.5f, 250.0f, even.rig.pulses.speed.turn_radps / EVEN_RPM);
        even_go_on_until(&even, WH_PHASE_RAMP_DOWN);
        TEST_ASSERT_TRUE(even.inputs.now_ticks - begin >= 2000000U);
        even_go_on_until(&even, EVEN_NEVER);
        TEST_ASSERT_TRUE(even_is_done(&even));
        const wh_measured *force = &even.rig.result.force;
        CHECK_NEAR(0.01f, 250.0f, force->speed_radps / EVEN_RPM);
        /* The number of whole turns in 2 s is that of 250 rpm, not that of 330 rpm. */
        TEST_ASSERT_TRUE(force->turns == 7U || force->turns == 8U);
        CHECK_NEAR(0.02f, EVEN_LOAD_N, force->amplitude_N);
    }
}

/* The next run counts lost and rejected pulses from zero, and ignores the counts at which the last run's loop closed
 * (lost_before, rejected_before). */
TEST(rig_states_random, the_run_before_does_not_count) {
    even_run(&even, WH_R(330.0), &(even_failure){.in = EVEN_NEVER});
    TEST_ASSERT_TRUE(even_is_done(&even));
    even.rig.guard.lost_before = 2;
    even.rig.guard.rejected_before = 5;
    even_rest(&even);
    even_obeys(&even, WH_EVENT_ARM, WH_R(0.0));
    even_obeys(&even, WH_EVENT_START, WH_R(330.0) * EVEN_RPM);
    even_go_on_until(&even, EVEN_NEVER);
    TEST_ASSERT_TRUE(even_is_done(&even));
}

/* If the speed leaves the band during the record, the run trips without a result, even if an earlier run had a
 * result. */
TEST(rig_states_random, tripped_record_gives_no_result) {
    for (unsigned before = 0; before < 2U; before++) {
        for (unsigned i = 0; i < 6U; i++) {
            even_start(&even);
            if (before > 0) {
                even_run(&even, WH_R(330.0), &(even_failure){.in = EVEN_NEVER});
            }
            even_rest(&even);
            even_obeys(&even, WH_EVENT_ARM, WH_R(0.0));
            even_obeys(&even, WH_EVENT_START, WH_R(250.0) * EVEN_RPM);
            even_go_on_until(&even, WH_PHASE_RECORD);
            even_steps(&even, 300U + 60U * i);
            even_turn_by_hand(&even, i % 2U == 0 ? WH_R(235.0) : WH_R(265.0));
            even_steps(&even, 600);
            TEST_ASSERT_TRUE(even.rig.state == WH_RIG_TRIPPED &&
                             even.rig.guard.trip == WH_TRIP_UNSETTLED);
            TEST_ASSERT_FALSE(even.rig.has_result);
        }
    }
}

TEST(rig_states_random, speed_is_zero_at_rest) {
    even_run(&even, WH_R(330.0), &(even_failure){.in = EVEN_NEVER});
    even_rest(&even);
    CHECK_NEAR(0.0f, 0.0f, even.rig.run.off_radps);
}

static wh_real any_value(void) {
    const wh_real values[] = {WH_R(330.0) * EVEN_RPM,
                              WH_R(200.0) * EVEN_RPM,
                              WH_R(360.0) * EVEN_RPM,
                              WH_R(500.0) * EVEN_RPM,
                              WH_R(0.0),
                              WH_R(-35.0),
                              STRANGE};
    return values[draw_one_of(&seed, sizeof values / sizeof values[0])];
}

static wh_real any_supply_V(void) {
    const wh_real supplies_V[] = {WH_RIG_RATED_V, WH_R(12.0),  WH_R(36.0), WH_R(14.0),
                                  WH_R(0.0),      WH_R(-24.0), STRANGE};
    return supplies_V[draw_one_of(&seed, sizeof supplies_V / sizeof supplies_V[0])];
}

typedef struct asked {
    bool arm;
    bool start;
    bool clear;
} asked;

static asked order_anything(void) {
    asked of = {.arm = false};
    const unsigned orders = draw_one_in(&seed, 3) ? 1U + draw_one_of(&seed, 5) : 0U;
    for (unsigned i = 0; i < orders; i++) {
        const int event = (int)draw_one_of(&seed, (unsigned)WH_EVENTS + 3U) - 1;
        const bool posted = wh_rig_post(&even.rig, (wh_rig_event)event, any_value());
        TEST_ASSERT_TRUE(posted == (i < WH_RIG_ORDERS_MOST));
        of.arm = of.arm || (posted && event == (int)WH_EVENT_ARM);
        of.start = of.start || (posted && event == (int)WH_EVENT_START);
        of.clear = of.clear || (posted && event == (int)WH_EVENT_CLEAR);
    }
    return of;
}

static void disturb_anything(void) {
    even.inputs.supply_V = draw_one_in(&seed, 30) ? any_supply_V() : WH_RIG_RATED_V;
    even.inputs.stop_pressed = draw_one_in(&seed, 60);
    even.inputs.clock_is_fallback = draw_one_in(&seed, 20);
    even.inputs.watchdog_has_cut = draw_one_in(&seed, 300);
    if (draw_one_in(&seed, 40)) {
        wh_rig_pulse(&even.config, &even.rig, draw_one_of(&seed, 3),
                     even.inputs.now_ticks + (uint32_t)(draw_bits(&seed) % EVEN_STEP_TICKS));
    }
    if (draw_one_in(&seed, 60)) {
        wh_rig_load(&even.config, &even.rig, even.inputs.now_ticks,
                    (int32_t)(draw_bits(&seed) % 70000U) - 35000,
                    (wh_load_status)draw_one_of(&seed, WH_LOAD_STATUSES));
    }
}

static void check_what_always_holds(wh_rig_state before, asked of) {
    const wh_rig *rig = &even.rig;
    const wh_rig_command *command = &even.command;
    const bool drives = command->way == WH_MOTOR_DRIVES;
    TEST_ASSERT_TRUE(rig->state < WH_RIG_STATES && rig->run.phase < WH_PHASES);
    TEST_ASSERT_TRUE((rig->state == WH_RIG_TRIPPED) == (rig->guard.trip != WH_TRIP_NONE));
    TEST_ASSERT_TRUE(!drives ||
                     ((rig->state == WH_RIG_RUNNING || rig->state == WH_RIG_STOPPING) &&
                      rig->run.phase >= WH_PHASE_SPIN_UP && rig->run.phase <= WH_PHASE_RAMP_DOWN));
    TEST_ASSERT_TRUE(rig->state != WH_RIG_TRIPPED || command->way == WH_MOTOR_COASTS);
    TEST_ASSERT_FALSE(drives && even.inputs.stop_pressed);
    TEST_ASSERT_TRUE(command->volts >= WH_R(0.0)); /* false for NaN */
    TEST_ASSERT_TRUE(drives ? command->volts <= even.inputs.supply_V : command->volts <= WH_R(0.0));
    /* The state has changed only as the life cycle allows. */
    TEST_ASSERT_TRUE(rig->state != WH_RIG_ARMED || before == WH_RIG_ARMED || of.arm);
    TEST_ASSERT_TRUE(rig->state != WH_RIG_RUNNING || before == WH_RIG_RUNNING ||
                     (of.start && (before == WH_RIG_ARMED || of.arm)));
    TEST_ASSERT_TRUE(before != WH_RIG_TRIPPED || rig->state == WH_RIG_TRIPPED || of.clear);
    TEST_ASSERT_TRUE(before != WH_RIG_TRIPPED || !drives);
    TEST_ASSERT_TRUE(before != WH_RIG_STOPPING || rig->state != WH_RIG_RUNNING);
}

#define SEQUENCES 500U /* number of sequences that begin in each phase */
#define STEPS 24U

static void go_through_anything(void) {
    const wh_rig_phase phase = even.rig.run.phase;
    stood = even;
    unsigned left = 0; /* number of sequences that left the phase */
    unsigned drove = 0;
    for (unsigned sequence = 0; sequence < SEQUENCES; sequence++) {
        even = stood;
        even_steps(&even, draw_one_of(&seed, 20));
        for (unsigned step = 0; step < STEPS; step++) {
            const wh_rig_state before = even.rig.state;
            const asked of = order_anything();
            disturb_anything();
            even_step(&even);
            check_what_always_holds(before, of);
            drove += even.command.way == WH_MOTOR_DRIVES ? 1U : 0U;
        }
        left += even.rig.run.phase != phase ? 1U : 0U;
    }
    const bool runs = phase > WH_PHASE_NONE && phase < WH_PHASE_OFF;
    /* Enough of the sequences had an effect. */
    TEST_ASSERT_TRUE(left > (runs ? SEQUENCES / 2U : 0U));
    TEST_ASSERT_TRUE(!runs || phase == WH_PHASE_TARE || drove > SEQUENCES);
}

/* Checks that a result belongs to the last start, exists from the end of its record on, and that its age grows with the
 * clock. */
static void check_result(const wh_rig *before) {
    const wh_rig *rig = &even.rig;
    const uint32_t now = even.inputs.now_ticks;
    TEST_ASSERT_TRUE(rig->runs - before->runs <= 1U);
    if (rig->runs != before->runs) {
        TEST_ASSERT_FALSE(rig->has_result);
    } else if (rig->has_result && !before->has_result) {
        result_end_ticks = now;
        TEST_ASSERT_TRUE(before->run.phase == WH_PHASE_RECORD &&
                         rig->settings == even.config.settings);
    } else {
        TEST_ASSERT_TRUE(rig->has_result == before->has_result);
    }
    TEST_ASSERT_TRUE(!rig->has_result || wh_rig_result_age_s(rig, now) ==
                                             (now - result_end_ticks) / WH_RIG_TICKS_PER_S);
}

TEST(rig_states_random, invariants_hold_for_random_orders) {
    seed = 11;
    even_start(&even);
    even_rest(&even);
    go_through_anything();
    even_arm(&even);
    go_through_anything();
    for (wh_rig_phase phase = WH_PHASE_TARE; phase <= WH_PHASE_OFF; phase++) {
        even_reach(&even, phase);
        go_through_anything();
    }
    even_arm(&even); /* tripped, at rest */
    even.inputs.supply_V = WH_R(0.0);
    even_step(&even);
    even.inputs.supply_V = WH_RIG_RATED_V;
    even_go_on_until(&even, EVEN_NEVER);
    go_through_anything();
}

/* Long random sequences, so that some runs reach their result. */
TEST(rig_states_random, invariants_hold_in_long_sequences) {
    seed = 12;
    even_start(&even);
    unsigned results = 0;
    unsigned trips = 0;
    for (uint32_t step = 0; step < 150000U; step++) {
        const wh_rig_state before = even.rig.state;
        asked of = {.arm = false};
        even.inputs.supply_V = draw_one_in(&seed, 6000) ? any_supply_V() : WH_RIG_RATED_V;
        even.inputs.stop_pressed = draw_one_in(&seed, 20000);
        if (draw_one_in(&seed, 20000)) {
            of = order_anything();
        } else if (even.rig.state != WH_RIG_RUNNING && step % 50U == 0) {
            static const wh_rig_event orders[] = {WH_EVENT_CLEAR, WH_EVENT_ARM, WH_EVENT_START};
            for (unsigned i = 0; i < 3; i++) {
                TEST_ASSERT_TRUE(wh_rig_post(&even.rig, orders[i], draw_whole(&seed, 18, 37)));
            }
            of = (asked){true, true, true};
        }
        if (draw_one_in(&seed, 2000)) {
            wh_rig_pulse(&even.config, &even.rig, draw_one_of(&seed, 2), even.inputs.now_ticks);
        }
        const wh_rig before_step = even.rig;
        even_step(&even);
        check_what_always_holds(before, of);
        trips += before != WH_RIG_TRIPPED && even.rig.state == WH_RIG_TRIPPED ? 1U : 0U;
        results += before == WH_RIG_RUNNING && even.rig.run.phase == WH_PHASE_RAMP_DOWN ? 1U : 0U;
        check_result(&before_step);
    }
    TEST_ASSERT_TRUE(results >= 3U && trips >= 3U);
}

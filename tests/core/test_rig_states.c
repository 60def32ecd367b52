/* test_rig_states.c: the rig's life cycle: every state and event, every named refusal, and how `arm` ends. */
#include <stddef.h>

#include "even_rig.h"
#include "tests/suites.h"

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

/* Only the state can refuse an order. */
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

/* An event's effect by state (idle, armed, running, stopping, tripped): the next state's first letter, or the refusal.
 * Refusals: - not armed, a armed, r running, s stopping, t tripped, n no trip, x not running. */
typedef struct expectation {
    wh_rig_event event;
    bool is_order; /* from outside; otherwise refused when posted */
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
    static const int strange[] = {-1, 100, 200, INT16_MAX}; /* none of them 0 in a byte */
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

TEST(rig_states, what_arm_asks_for) {
    stand_in(WH_RIG_IDLE);
    stood = even;
    even.inputs.stop_pressed = true;
    check_refused(arm(), WH_REFUSED_STOP_INPUT, WH_RIG_IDLE);
    even = stood;
    even.inputs.clock_is_fallback = true;
    check_refused(arm(), WH_REFUSED_CLOCK, WH_RIG_IDLE);
    const wh_real supplies_V[] = {WH_R(0.0),
                                  WH_R(-24.0),
                                  WH_R(10.0),
                                  WH_R(38.0),
                                  WH_R(1e30),
                                  (wh_real)__builtin_inff(),
                                  (wh_real)-__builtin_inff(),
                                  (wh_real)__builtin_nanf("")};
    for (unsigned i = 0; i < sizeof supplies_V / sizeof supplies_V[0]; i++) {
        even = stood;
        even.inputs.supply_V = supplies_V[i];
        check_refused(arm(), WH_REFUSED_SUPPLY, WH_RIG_IDLE);
        TEST_ASSERT_TRUE(even.rig.guard.trip == WH_TRIP_NONE); /* idle: not needed */
    }
    even = stood;
    even.fails = (even_failure){.in = WH_PHASE_NONE, .lose_samples = EVEN_ALWAYS};
    even_steps(&even, 11);
    check_refused(arm(), WH_REFUSED_LOAD_CELL, WH_RIG_IDLE);
    for (unsigned minute = 0; minute < 160U;
         minute++) { /* silent for more than two wraps of the clock */
        even.inputs.now_ticks += 60U * WH_RIG_TICKS_PER_S;
        check_refused(arm(), WH_REFUSED_LOAD_CELL, WH_RIG_IDLE);
    }
    for (wh_load_status status = WH_LOAD_SATURATED; status <= WH_LOAD_DISCONNECTED; status++) {
        even = stood;
        even.fails = (even_failure){.in = WH_PHASE_NONE, .status = status};
        check_refused(arm(), WH_REFUSED_LOAD_CELL, WH_RIG_IDLE);
    }
    even = stood; /* a trip as well, after the orders */
    even.inputs.watchdog_has_cut = true;
    check_refused(arm(), WH_REFUSED_WATCHDOG, WH_RIG_TRIPPED);
    even_start(&even); /* rest is not known yet */
    check_refused(arm(), WH_REFUSED_TURNING, WH_RIG_IDLE);
    even = stood; /* a single pulse */
    even.fails = (even_failure){.in = WH_PHASE_NONE, .adds = {true, false}};
    check_refused(arm(), WH_REFUSED_TURNING, WH_RIG_IDLE);
    even_steps(&even, 740);
    check_refused(arm(), WH_REFUSED_TURNING, WH_RIG_IDLE);
    even_steps(&even, 20);
    TEST_ASSERT_TRUE(arm() == WH_ALLOWED && even.rig.state == WH_RIG_ARMED);
}

TEST(rig_states, what_start_and_set_ask_for) {
    const wh_real wrong_rpm[] = {WH_R(0.0),
                                 WH_R(-330.0),
                                 WH_R(1.0),
                                 WH_R(361.0),
                                 WH_R(1e30),
                                 (wh_real)__builtin_inff(),
                                 (wh_real)-__builtin_inff(),
                                 (wh_real)__builtin_nanf("")};
    for (unsigned running = 0; running < 2; running++) {
        const wh_rig_event event = running == 0 ? WH_EVENT_START : WH_EVENT_SET;
        const wh_rig_state state = running == 0 ? WH_RIG_ARMED : WH_RIG_RUNNING;
        stand_in(state);
        stood = even;
        for (unsigned i = 0; i < sizeof wrong_rpm / sizeof wrong_rpm[0]; i++) {
            check_refused(even_order(&even, event, wrong_rpm[i] * EVEN_RPM), WH_REFUSED_TARGET,
                          state);
        }
        even.inputs.supply_V = WH_R(12.0); /* 330 rpm take 14 V, 250 rpm 10.8 V */
        check_refused(even_order(&even, event, WH_R(330.0) * EVEN_RPM), WH_REFUSED_VOLTAGE, state);
        TEST_ASSERT_TRUE(even_order(&even, event, WH_R(250.0) * EVEN_RPM) == WH_ALLOWED);
        TEST_ASSERT_FLOAT_WITHIN(1e-3f, 250.0f, (float)(even.rig.run.target_radps / EVEN_RPM));
    }
    stand_in(
        WH_RIG_ARMED); /* just enough suffices, and the slowest set-point without feed needs none */
    const wh_real slowest = even.config.guard.target_min_radps;
    even.inputs.supply_V = wh_run_needs_V(&even.config.run, slowest);
    even.config.guard.supply_min_V = WH_R(1.0);
    even.config.feeds = WH_COMPENSATION_SLOW;
    TEST_ASSERT_TRUE(even_order(&even, WH_EVENT_START, slowest) == WH_ALLOWED);
    TEST_ASSERT_FALSE(even.rig.fed);
    for (unsigned never = 0; never < 2;
         never++) { /* slower ones need an observer and a permitted feed-forward */
        stand_in(WH_RIG_ARMED);
        even.rig.observer.status = WH_OK;
        even.config.feeds = never == 1 ? WH_COMPENSATION_NEVER : WH_COMPENSATION_SLOW;
        TEST_ASSERT_TRUE(even_order(&even, WH_EVENT_START, WH_R(110.0) * EVEN_RPM) ==
                         (never == 1 ? WH_REFUSED_TARGET : WH_ALLOWED));
        TEST_ASSERT_TRUE(even.rig.fed == (never == 0));
    }
    stand_in(WH_RIG_ARMED); /* the stop input disarms before the order is processed */
    even.inputs.stop_pressed = true;
    check_refused(even_order(&even, WH_EVENT_START, WH_R(330.0) * EVEN_RPM), WH_REFUSED_NOT_ARMED,
                  WH_RIG_IDLE);
}

/* Four orders a step; the fifth is refused at once. All get their answers, in order. */
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
    TEST_ASSERT_TRUE(even_order(&even, WH_EVENT_STOP, WH_R(0.0)) == WH_ALLOWED);
}

/* Events that the rig detects itself, and unknown ones, cannot be posted. */
TEST(rig_states, unknown_and_internal_events_are_refused) {
    for (wh_rig_state state = WH_RIG_IDLE; state < WH_RIG_STATES; state++) {
        stand_in(state);
        for (int event = (int)WH_EVENT_DONE; event < (int)WH_EVENTS + 3; event++) {
            TEST_ASSERT_TRUE(even_order(&even, (wh_rig_event)event, WH_R(1.0)) == WH_REFUSED_EVENT);
            TEST_ASSERT_TRUE(even.rig.state == state);
        }
        TEST_ASSERT_TRUE(even_order(&even, (wh_rig_event)-1, WH_R(1.0)) == WH_REFUSED_EVENT);
        TEST_ASSERT_TRUE(even.rig.state == state);
    }
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

/* A hand turns the rotor, slowly or fast: no trip, and no start. */
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
        /* two pulses are a shiver; the third comes after a turn */
        TEST_ASSERT_TRUE((float)steps <= 60.0f / (float)hands_rpm[i] * 500.0f + 2.0f);
        even_steps(&even, 2000);
        TEST_ASSERT_TRUE(even.rig.state == WH_RIG_IDLE && even.rig.guard.trip == WH_TRIP_NONE);
        TEST_ASSERT_TRUE(arm() == WH_REFUSED_TURNING);
        even_turn_by_hand(&even, WH_R(0.0));
        even_rest(&even);
        TEST_ASSERT_TRUE(arm() == WH_ALLOWED);
    }
}

/* test_rig_states_random.c: the rig's controller under random orders and inputs, new set-points, and a result that outlives a
 * trip. */
#include <stddef.h>

#include "draw.h"
#include "even_rig.h"
#include "tests/suites.h"

static even_rig even;
static uint32_t result_end_ticks;
static even_rig stood;
static uint64_t seed;

/* In any phase before the result: it settles at the new one, and the record restarts. */
TEST(rig_states_random, another_set_point_while_it_runs) {
    for (wh_rig_phase phase = WH_PHASE_TARE; phase <= WH_PHASE_RECORD; phase++) {
        even_reach(&even, phase);
        even_steps(&even, 100); /* the earlier record is dropped */
        TEST_ASSERT_TRUE(even.rig.run.phase == phase);
        TEST_ASSERT_TRUE(even_order(&even, WH_EVENT_SET, WH_R(250.0) * EVEN_RPM) == WH_ALLOWED);
        TEST_ASSERT_TRUE(even.rig.run.phase == (phase > WH_PHASE_RAMP ? WH_PHASE_RAMP : phase));
        even_go_on_until(&even, WH_PHASE_RECORD);
        const uint32_t begin = even.inputs.now_ticks;
        TEST_ASSERT_FLOAT_WITHIN(0.5f, 250.0f,
                                 (float)(even.rig.pulses.speed.turn_radps / EVEN_RPM));
        even_go_on_until(&even, WH_PHASE_RAMP_DOWN);
        TEST_ASSERT_TRUE(even.inputs.now_ticks - begin >= 2000000U);
        even_go_on_until(&even, EVEN_NEVER);
        TEST_ASSERT_TRUE(even_is_done(&even));
        const wh_measured *force = &even.rig.result.force;
        TEST_ASSERT_FLOAT_WITHIN(0.01f, 250.0f, (float)(force->speed_radps / EVEN_RPM));
        /* whole turns of 2 s at 250 rpm; those at 330 rpm are not among them */
        TEST_ASSERT_TRUE(force->turns == 7U || force->turns == 8U);
        TEST_ASSERT_FLOAT_WITHIN(0.02f, (float)EVEN_LOAD_N, (float)force->amplitude_N);
    }
}

/* The next run counts from zero, not from the pulses that the last one lost or rejected before its loop was closed. */
TEST(rig_states_random, the_run_before_does_not_count) {
    even_run(&even, WH_R(330.0), &(even_failure){.in = EVEN_NEVER});
    TEST_ASSERT_TRUE(even_is_done(&even));
    even.rig.guard.lost_before = 2;
    even.rig.guard.rejected_before = 5;
    even_rest(&even);
    TEST_ASSERT_TRUE(even_order(&even, WH_EVENT_ARM, WH_R(0.0)) == WH_ALLOWED);
    TEST_ASSERT_TRUE(even_order(&even, WH_EVENT_START, WH_R(330.0) * EVEN_RPM) == WH_ALLOWED);
    even_go_on_until(&even, EVEN_NEVER);
    TEST_ASSERT_TRUE(even_is_done(&even));
}

/* A record that leaves its speed band ends in a trip without a result, whether there was an earlier one or not. */
TEST(rig_states_random, a_record_that_is_left_brings_no_result) {
    for (unsigned before = 0; before < 2U; before++) {
        for (unsigned i = 0; i < 6U; i++) {
            even_start(&even);
            if (before > 0) {
                even_run(&even, WH_R(330.0), &(even_failure){.in = EVEN_NEVER});
            }
            even_rest(&even);
            TEST_ASSERT_TRUE(even_order(&even, WH_EVENT_ARM, WH_R(0.0)) == WH_ALLOWED);
            TEST_ASSERT_TRUE(even_order(&even, WH_EVENT_START, WH_R(250.0) * EVEN_RPM) ==
                             WH_ALLOWED);
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

/* A rotor at rest has no speed to lead by. */
TEST(rig_states_random, rest_leaves_no_speed) {
    even_run(&even, WH_R(330.0), &(even_failure){.in = EVEN_NEVER});
    even_rest(&even);
    TEST_ASSERT_FLOAT_WITHIN(0.0f, 0.0f, (float)even.rig.run.off_radps);
}

static wh_real any_value(void) {
    const wh_real values[] = {WH_R(330.0) * EVEN_RPM,
                              WH_R(200.0) * EVEN_RPM,
                              WH_R(360.0) * EVEN_RPM,
                              WH_R(500.0) * EVEN_RPM,
                              WH_R(0.0),
                              WH_R(-35.0),
                              WH_R(1e30),
                              (wh_real)__builtin_inff(),
                              (wh_real)-__builtin_inff(),
                              (wh_real)__builtin_nanf("")};
    return values[draw_one_of(&seed, sizeof values / sizeof values[0])];
}

static wh_real any_supply_V(void) {
    const wh_real supplies_V[] = {WH_RIG_RATED_V,
                                  WH_R(12.0),
                                  WH_R(36.0),
                                  WH_R(14.0),
                                  WH_R(0.0),
                                  WH_R(-24.0),
                                  WH_R(1e30),
                                  (wh_real)__builtin_inff(),
                                  (wh_real)-__builtin_inff(),
                                  (wh_real)__builtin_nanf("")};
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
    TEST_ASSERT_TRUE(command->volts >= WH_R(0.0)); /* NaN is not */
    TEST_ASSERT_TRUE(drives ? command->volts <= even.inputs.supply_V : command->volts <= WH_R(0.0));
    /* allowed sequences */
    TEST_ASSERT_TRUE(rig->state != WH_RIG_ARMED || before == WH_RIG_ARMED || of.arm);
    TEST_ASSERT_TRUE(rig->state != WH_RIG_RUNNING || before == WH_RIG_RUNNING ||
                     (of.start && (before == WH_RIG_ARMED || of.arm)));
    TEST_ASSERT_TRUE(before != WH_RIG_TRIPPED || rig->state == WH_RIG_TRIPPED || of.clear);
    TEST_ASSERT_TRUE(before != WH_RIG_TRIPPED || !drives);
    TEST_ASSERT_TRUE(before != WH_RIG_STOPPING || rig->state != WH_RIG_RUNNING);
}

#define SEQUENCES 500U /* from each phase */
#define STEPS 24U

static void go_through_anything(void) {
    const wh_rig_phase phase = even.rig.run.phase;
    stood = even;
    unsigned left = 0; /* sequences that ended elsewhere, or not at all */
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
    TEST_ASSERT_TRUE(left > (runs ? SEQUENCES / 2U : 0U)); /* the drawn sequences were not idle */
    TEST_ASSERT_TRUE(!runs || phase == WH_PHASE_TARE || drove > SEQUENCES);
}

/* A result belongs to the last start, from its record's end on, and its age grows with the clock. */
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

TEST(rig_states_random, what_holds_whatever_is_ordered) {
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

/* Long sequences, in which runs get far. */
TEST(rig_states_random, what_holds_for_hours) {
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

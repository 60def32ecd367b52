/* test_rig_observed.c: the rig's controller with an observer beside it, on a rotor that turns evenly (even_rig.c): what the
 * observer is told of the pulses, and that each run begins with one that knows nothing. */
#include "build/gen/scenes.h"
#include "core/rig/observer.h"
#include "draw.h"
#include "even_rig.h"

#include "unity.h"

void suite_rig_observed(void);

static even_rig even;
static uint64_t seed;

/* Armed, with an observer to which every mark is a good one: good_marks counts those that it is told. */
static void arm(void) {
    even_arm(&even);
    wh_observer_config *observing = &even.config.observer;
    observing->scene = &rig_fixed;
    observing->trusted_rad = observing->lost_rad = WH_R(3.2);
    observing->trusted_marks = 1000000U;
    even.config.feeds = WH_FEED_ALWAYS;
    TEST_ASSERT_TRUE(wh_observer_start(observing, &even.rig.observer, even.inputs.now_ticks) ==
                     WH_OK);
}

/* While the loop is closed each pulse that is taken is told once, as it was captured, within two steps; nothing else is. */
static void test_each_pulse_is_told_once(void) {
    for (unsigned k = 0; k < 3U; k++) {
        static const wh_real targets_rpm[] = {WH_R(330.0), WH_R(200.0), WH_R(270.0)};
        arm();
        TEST_ASSERT_TRUE(even_order(&even, WH_EVENT_START, targets_rpm[k] * EVEN_RPM) ==
                         WH_ALLOWED);
        even_go_on_until(&even, WH_PHASE_SETTLE);
        const wh_observer *observer = &even.rig.observer;
        const uint32_t told = observer->good_marks;
        const uint32_t taken = even.rig.pulses.speed.taken;
        TEST_ASSERT_TRUE(observer->runs);
        unsigned waited = 0;
        for (unsigned i = 0; i < 3000U && even.rig.run.phase <= WH_PHASE_RECORD; i++) {
            even_step(&even);
            const uint32_t missing =
                (even.rig.pulses.speed.taken - taken) - (observer->good_marks - told);
            TEST_ASSERT_TRUE(missing <= 1U);
            waited = missing == 0 ? 0U : waited + 1U;
            TEST_ASSERT_TRUE(waited <= 2U);
            TEST_ASSERT_TRUE(missing > 0 ||
                             observer->mark_ticks == even.rig.pulses.last.pulse.ticks);
        }
        TEST_ASSERT_TRUE(even.rig.pulses.speed.taken - taken > 20U);
    }
}

/* Whatever the observer knew when a run ended, and however long ago: the next one begins with none of it. */
static void test_each_run_begins_with_an_observer_that_knows_nothing(void) {
    seed = 1;
    for (unsigned i = 0; i < 8U; i++) {
        arm();
        wh_observer *observer = &even.rig.observer;
        observer->valid = observer->runs = true;
        observer->marked = !draw_one_in(&seed, 4);
        observer->good_marks = draw_one_of(&seed, 100);
        observer->mark_ticks = even.inputs.now_ticks + (uint32_t)draw_bits(&seed) * 2U;
        observer->torque_Nm = draw_broken(&seed, -1, 1);
        TEST_ASSERT_TRUE(even_order(&even, WH_EVENT_START, WH_R(330.0) * EVEN_RPM) == WH_ALLOWED);
        TEST_ASSERT_FALSE(observer->valid || observer->runs || observer->marked);
        TEST_ASSERT_TRUE(observer->good_marks == 0 && observer->torque_Nm == WH_R(0.0));
    }
}

/* A result says the voltage that the motor had as the record ended. */
static void test_a_result_says_the_voltage(void) {
    for (unsigned i = 0; i < 4U; i++) {
        even_arm(&even);
        const wh_real target_rpm = WH_R(200.0) + WH_R(45.0) * (wh_real)i;
        TEST_ASSERT_TRUE(even_order(&even, WH_EVENT_START, target_rpm * EVEN_RPM) == WH_ALLOWED);
        even_go_on_until(&even, WH_PHASE_RECORD);
        wh_real volts = WH_R(0.0);
        while (even.rig.run.phase == WH_PHASE_RECORD) {
            volts = even.command.volts;
            even_step(&even);
        }
        even_go_on_until(&even, EVEN_NEVER);
        TEST_ASSERT_TRUE(even_is_done(&even) && volts > WH_R(1.0));
        TEST_ASSERT_FLOAT_WITHIN(1e-3f, (float)volts, (float)even.rig.result.volts);
    }
}

/* A pulse is work enough for one control step: the turn that is worked on waits for the next one. */
static void test_a_step_with_a_pulse_works_on_no_turn(void) {
    unsigned pulses = 0;
    unsigned works = 0;
    even_reach(&even, WH_PHASE_SETTLE);
    const wh_lockin *lockin = &even.rig.measure.lockin;
    while (even.rig.run.phase <= WH_PHASE_RECORD) {
        const wh_lockin_stage stage = lockin->stage;
        const wh_lockin_place place = lockin->place;
        const wh_real part = lockin->last.part;
        const uint32_t ever = even.rig.pulses_ever;
        even_step(&even);
        const bool stays = (stage == lockin->stage || stage == WH_LOCKIN_WAITS) &&
                           place == lockin->place && part == lockin->last.part;
        TEST_ASSERT_TRUE(stays || even.rig.pulses_ever == ever);
        pulses += even.rig.pulses_ever != ever ? 1U : 0U;
        works += stays ? 0U : 1U;
    }
    TEST_ASSERT_TRUE(pulses > 40U && works > 400U);
}

void suite_rig_observed(void) {
    RUN_TEST(test_a_step_with_a_pulse_works_on_no_turn);
    RUN_TEST(test_each_pulse_is_told_once);
    RUN_TEST(test_each_run_begins_with_an_observer_that_knows_nothing);
    RUN_TEST(test_a_result_says_the_voltage);
}

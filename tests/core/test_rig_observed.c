/* test_rig_observed.c: the rig's controller with an observer on an imitated rotor of constant speed (even_rig.c): which
 * pulses the observer gets, and its restart at the start of each run. */
#include <string.h>

#include "build/gen/scenes.h"
#include "core/rig/observer.h"
#include "draw.h"
#include "even_rig.h"

#include "tests/suites.h"

static even_rig even;
static uint64_t seed;

/* Arms the rig with an observer that trusts every pulse: good_pulses counts the pulses that it gets. */
static void arm(void) {
    even_arm(&even);
    wh_observer_config *observing = &even.config.observer;
    observing->scene = &rig_fixed;
    observing->trusted_rad = observing->lost_rad = WH_R(3.2);
    observing->trusted_pulses = 1000000U;
    even.config.compensation_when = WH_COMPENSATION_ALWAYS;
    TEST_ASSERT_TRUE(wh_observer_start(observing, &even.rig.observer, even.inputs.now_ticks) ==
                     WH_OK);
}

/* While the loop is closed, the observer gets each accepted pulse once, with its time, within two steps. It gets no
 * other pulse. */
TEST(rig_observed, observer_gets_each_pulse_once) {
    for (unsigned k = 0; k < 3U; k++) {
        static const wh_real targets_rpm[] = {WH_R(330.0), WH_R(200.0), WH_R(270.0)};
        arm();
        even_obeys(&even, WH_EVENT_START, targets_rpm[k] * EVEN_RPM);
        even_go_on_until(&even, WH_PHASE_SETTLE);
        const wh_observer *observer = &even.rig.observer;
        const uint32_t told = observer->good_pulses;
        const uint32_t taken = even.rig.pulses.speed.taken;
        TEST_ASSERT_TRUE(observer->runs);
        unsigned waited = 0;
        for (unsigned i = 0; i < 3000U && even.rig.run.phase <= WH_PHASE_RECORD; i++) {
            even_step(&even);
            const uint32_t missing =
                (even.rig.pulses.speed.taken - taken) - (observer->good_pulses - told);
            TEST_ASSERT_TRUE(missing <= 1U);
            waited = missing == 0 ? 0U : waited + 1U;
            TEST_ASSERT_TRUE(waited <= 2U);
            TEST_ASSERT_TRUE(missing > 0 ||
                             observer->pulse_ticks == even.rig.pulses.last.pulse.ticks);
        }
        TEST_ASSERT_TRUE(even.rig.pulses.speed.taken - taken > 20U);
    }
}

TEST(rig_observed, runs_begin_with_a_reset_observer) {
    seed = 1;
    for (unsigned i = 0; i < 8U; i++) {
        arm();
        wh_observer *observer = &even.rig.observer;
        observer->valid = observer->runs = true;
        observer->had_pulse = !draw_one_in(&seed, 4);
        observer->good_pulses = draw_one_of(&seed, 100);
        observer->pulse_ticks = even.inputs.now_ticks + (uint32_t)draw_bits(&seed) * 2U;
        observer->torque_Nm = draw_broken(&seed, -1, 1);
        even_obeys(&even, WH_EVENT_START, WH_R(330.0) * EVEN_RPM);
        TEST_ASSERT_FALSE(observer->valid || observer->runs || observer->had_pulse);
        TEST_ASSERT_TRUE(observer->good_pulses == 0 && observer->torque_Nm == WH_R(0.0));
    }
}

TEST(rig_observed, result_has_the_voltage) {
    for (unsigned i = 0; i < 4U; i++) {
        even_arm(&even);
        const wh_real target_rpm = WH_R(200.0) + WH_R(45.0) * (wh_real)i;
        even_obeys(&even, WH_EVENT_START, target_rpm * EVEN_RPM);
        even_go_on_until(&even, WH_PHASE_RECORD);
        wh_real volts = WH_R(0.0);
        while (even.rig.run.phase == WH_PHASE_RECORD) {
            volts = even.command.volts;
            even_step(&even);
        }
        even_go_on_until(&even, EVEN_NEVER);
        TEST_ASSERT_TRUE(even_is_done(&even) && volts > WH_R(1.0));
        CHECK_NEAR(1e-3f, volts, even.rig.result.volts);
    }
}

/* A step that processes a pulse does no work for the turn in progress. */
TEST(rig_observed, steps_with_pulses_skip_turn_work) {
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

TEST(rig_observed, observer_is_idle_without_compensation) {
    arm();
    even.config.compensation_when = WH_COMPENSATION_NEVER;
    even_obeys(&even, WH_EVENT_START, WH_R(330.0) * EVEN_RPM);
    const uint32_t ticks = even.rig.observer.ticks;
    even_go_on_until(&even, WH_PHASE_RAMP_DOWN);
    TEST_ASSERT_TRUE(even.rig.run.phase == WH_PHASE_RAMP_DOWN);
    TEST_ASSERT_EQUAL_UINT32(ticks, even.rig.observer.ticks);
    TEST_ASSERT_FALSE(even.rig.observer.runs || even.rig.observer.had_pulse);
}

/* When a new set-point ends or begins gravity compensation, the measurement's model of the angle changes in the same
 * step. */
TEST(rig_observed, angle_model_follows_the_compensation) {
    arm();
    even.config.compensation_when = WH_COMPENSATION_SLOW;
    even_obeys(&even, WH_EVENT_START, WH_R(120.0) * EVEN_RPM);
    for (unsigned i = 0; i < 4U; i++) {
        const wh_turn_angle *angle = &even.rig.measure.lockin.angle;
        for (unsigned k = 0; k < 6000U && !angle->compensated; k++) {
            even.rig.compensation.part =
                WH_R(1.0); /* fully faded in, although the observer does not fit this rotor */
            even_step(&even);
        }
        TEST_ASSERT_TRUE(angle->compensated);
        CHECK_NEAR(0.0f, even.rig.run.volts, angle->drive_V);
        even_obeys(&even, WH_EVENT_SET, (WH_R(200.0) + (wh_real)i) * EVEN_RPM);
        TEST_ASSERT_FALSE(angle->compensated);
        TEST_ASSERT_TRUE(angle->part >= WH_R(1.0));
        CHECK_NEAR(0.0f, 0.0f, even.rig.compensation.part); /* fades in again from zero */
        even_steps(&even, 300);
        TEST_ASSERT_FALSE(angle->compensated);
        even_obeys(&even, WH_EVENT_SET, (WH_R(120.0) + (wh_real)i) * EVEN_RPM);
    }
}

/* Pulses of nonexistent sensors, in any phase, are counted only. */
TEST(rig_observed, nonexistent_sensors_are_only_counted) {
    static even_rig twin;
    seed = 77;
    for (wh_rig_phase phase = WH_PHASE_TARE; phase <= WH_PHASE_RAMP_DOWN; phase++) {
        even_reach(&even, phase);
        twin = even;
        uint32_t given = 0;
        for (unsigned i = 0; i < 400U; i++) {
            if (draw_one_in(&seed, 20)) {
                const unsigned sensor = WH_RIG_SENSORS + draw_one_of(&seed, 40);
                wh_rig_pulse(&even.config, &even.rig, sensor, even.inputs.now_ticks + 500U);
                given++;
            }
            even_step(&even);
            even_step(&twin);
            TEST_ASSERT_TRUE(memcmp(&even.command, &twin.command, sizeof even.command) == 0);
            TEST_ASSERT_TRUE(even.rig.run.phase == twin.rig.run.phase);
            TEST_ASSERT_TRUE(memcmp(even.rig.run.tare_pulses, twin.rig.run.tare_pulses,
                                    sizeof even.rig.run.tare_pulses) == 0);
        }
        TEST_ASSERT_TRUE(given > 5U);
        TEST_ASSERT_EQUAL_UINT32(twin.rig.pulses.speed.taken, even.rig.pulses.speed.taken);
    }
}

/* Confirmed pulses wait in order of time, up to the buffer's size. */
TEST(rig_observed, pulses_wait_in_order) {
    wh_pulses pulses;
    wh_index_pulse index;
    seed = 4;
    wh_pulses_start(&pulses, WH_R(84.0));
    pulses.bound_radps = WH_R(84.0);
    uint32_t ticks = UINT32_MAX - 500000U;
    uint32_t taken = 0;
    uint32_t before = ticks;
    for (unsigned i = 0; i < 200U; i++) {
        const unsigned running = 1U + draw_one_of(&seed, WH_PULSES_CONFIRMED);
        for (unsigned k = 0; k < running; k++) {
            /* 333 rpm; the sensors are a quarter of a turn apart */
            ticks += taken % 2U == 0 ? 135000U : 45000U;
            wh_pulses_take(&pulses, taken % 2U == 0 ? 0U : 1U, ticks);
            taken++;
        }
        unsigned confirmed = 0;
        while (wh_pulses_confirmed(&pulses, ticks + 30000U, &index)) {
            TEST_ASSERT_TRUE((int32_t)(index.pulse.ticks - before) > 0);
            before = index.pulse.ticks;
            confirmed++;
        }
        TEST_ASSERT_TRUE(i < 2U || confirmed == running);
        TEST_ASSERT_TRUE(i < 2U || before == ticks);
    }
}

/* test_rig_observer.c: the observer gets only the pulses of a rotor (rotor.c): the nominal one, or rotors with another
 * inertia, weight, friction, drive stage or sensor position. */
#include "build/gen/scenes.h"
#include "compensated_rotor.h"
#include "core/angle.h"
#include "core/rig/datasheet.h"
#include "draw.h"

#include "tests/suites.h"

#define RPM WH_RIG_RADPS_PER_RPM
#define DEG (WH_R(1.0) / WH_RIG_DEG_PER_RAD)
#define JITTER_S WH_R(104e-6) /* uniform: a standard deviation of 60 us */

static compensated_rotor compensated;

static void begin(uint64_t seed, wh_real speed_rpm) {
    compensated_rotor_standard(&compensated, seed);
    TEST_ASSERT_TRUE(compensated_rotor_start(&compensated, speed_rpm) == WH_OK);
}

static void check_below(wh_real bound, wh_real value) { TEST_ASSERT_TRUE(value < bound); }

/* The imitated rotor moves like the scene, although another method integrates it. */
TEST(rig_observer, the_rotor_is_the_scenes) {
    static uint64_t memory[WH_STATE_WORDS(1, 1, 1)];
    wh_state state;
    TEST_ASSERT_TRUE(wh_scene_start(&rig_fixed, &state, memory, sizeof memory) == WH_OK);
    const rotor_kind kind = rotor_nominal();
    rotor_state other = {.angle_rad = WH_R(1.0), .speed_radps = WH_R(15.0)};
    state.angle[0] = wh_angle_from_rad(WH_R(1.0));
    state.real[0] = WH_R(15.0);
    for (unsigned i = 0; i < 500; i++) {
        const wh_real drive = WH_R(0.6) - WH_R(0.001) * (wh_real)i;
        state.input[0] = drive;
        TEST_ASSERT_TRUE(wh_scene_steps(&rig_fixed, &state, 2) == WH_OK);
        rotor_turn(&kind, &other, drive, 2000);
    }
    wh_real sine;
    wh_real cosine;
    wh_real others[2];
    wh_sincos(wh_phase_of(state.angle[0]), &sine, &cosine);
    wh_sincos(wh_phase_from_rad(other.angle_rad), &others[0], &others[1]);
    CHECK_NEAR(1e-4f, 0.0f, sine - others[0]);
    CHECK_NEAR(1e-4f, 0.0f, cosine - others[1]);
    CHECK_NEAR(1e-3f, state.real[0], other.speed_radps);
}

/* The error of the angle is below 0.02 degrees at any speed, with gravity's ripple (up to 18 %) or with compensation.
 * Speed and friction torque are accurate, too. */
TEST(rig_observer, known_rotor_is_followed) {
    static const wh_real rpm[] = {WH_R(170.0), WH_R(250.0), WH_R(330.0), WH_R(400.0)};
    for (unsigned i = 0; i < 8; i++) {
        compensated_rotor_standard(&compensated, 7);
        compensated.by = i < 4U ? FED_BY_NOBODY : FED_BY_OBSERVER;
        compensated.kind.friction_Nm = i % 2U == 0 ? WH_R(0.0) : WH_R(0.1);
        TEST_ASSERT_TRUE(compensated_rotor_start(&compensated, rpm[i % 4U]) == WH_OK);
        compensated_rotor_run(&compensated, rpm[i % 4U], WH_R(4.0));
        compensated_rotor_count(&compensated);
        compensated_rotor_run(&compensated, rpm[i % 4U], WH_R(1.0));
        TEST_ASSERT_EQUAL_UINT32(500, compensated.valid);
        check_below(WH_R(0.02) * DEG, compensated.worst_rad);
        CHECK_NEAR(0.02f, compensated.rotor.speed_radps,
                   wh_observer_speed_radps(&compensated.observer));
        CHECK_NEAR(2e-3f, -(float)compensated.kind.friction_Nm, compensated.observer.torque_Nm);
        TEST_ASSERT_TRUE(WH_ABS(compensated.observer.innovation_rad) < WH_R(0.02) * DEG);
    }
}

/* The RMS error of the angle is between half and twice the jitter of the pulses. */
TEST(rig_observer, jitter_is_not_amplified) {
    static const wh_real rpm[] = {WH_R(170.0), WH_R(330.0), WH_R(400.0)};
    for (unsigned i = 0; i < 3; i++) {
        compensated_rotor_standard(&compensated, 11);
        compensated.kind.jitter_s = JITTER_S;
        TEST_ASSERT_TRUE(compensated_rotor_start(&compensated, rpm[i]) == WH_OK);
        compensated_rotor_run(&compensated, rpm[i], WH_R(4.0));
        compensated_rotor_count(&compensated);
        compensated_rotor_run(&compensated, rpm[i], WH_R(8.0));
        const wh_real pulses_rad = WH_R(60e-6) * rpm[i] * RPM;
        check_below(WH_R(2.0) * pulses_rad, fed_rotor_rms_rad(&compensated));
        check_below(fed_rotor_rms_rad(&compensated), WH_R(0.5) * pulses_rad);
    }
}

TEST(rig_observer, uncorrected_observer_deviates) {
    compensated_rotor_standard(&compensated, 7);
    compensated.kind.friction_Nm = WH_R(0.02);
    for (unsigned i = 0; i < 2; i++) {
        compensated.observing.angle_gain[i] = compensated.observing.speed_gain[i] = WH_R(0.0);
        compensated.observing.torque_gain_kgm2[i] = WH_R(0.0);
    }
    TEST_ASSERT_TRUE(compensated_rotor_start(&compensated, WH_R(330.0)) == WH_OK);
    compensated_rotor_run(&compensated, WH_R(330.0), WH_R(5.0));
    TEST_ASSERT_TRUE(compensated.valid < compensated.steps / 2U);
}

/* Random rotors: half to six times the inertia, weight wrong by up to 30 %, up to 0.2 N m of friction, sensor positions
 * wrong by up to 3 degrees, jitter. The stage brakes or freewheels, and the observer may be configured for the wrong
 * one. Speeds are 80 to 400 rpm; below 170 rpm gravity is compensated exactly, after a start at 150 rpm or more. In
 * nine of ten cases the error stays below 0.3 rad; fewer than 1 % of the valid angles are wrong. */
TEST(rig_observer, drawn_rotors_are_followed) {
    uint64_t seed = UINT64_C(0x5eed0b5e);
    unsigned fine = 0;
    uint32_t lies = 0;
    uint32_t valid = 0;
    const unsigned draws = draw_cases(40);
    for (unsigned i = 0; i < draws; i++) {
        compensated_rotor_standard(&compensated, seed);
        rotor_kind *kind = &compensated.kind;
        kind->inertia_kgm2 *= i % 2U == 0 ? draw_between(&seed, WH_R(0.5), WH_R(1.5))
                                          : draw_between(&seed, WH_R(1.5), WH_R(6.0));
        kind->weight_Nm *= draw_between(&seed, WH_R(0.7), WH_R(1.3));
        kind->friction_Nm = draw_between(&seed, WH_R(0.0), WH_R(0.2));
        kind->jitter_s = JITTER_S;
        for (unsigned k = 0; k < 2; k++) {
            kind->pulse_rad[k] += draw_between(&seed, WH_R(-3.0), WH_R(3.0)) * DEG;
        }
        kind->freewheels = draw_one_in(&seed, 2);
        compensated.observing.freewheels = kind->freewheels && draw_one_in(&seed, 2);
        const wh_real rpm = draw_between(&seed, WH_R(80.0), WH_R(400.0));
        const wh_real first = rpm > WH_R(150.0) ? rpm : WH_R(150.0);
        compensated.by = rpm < WH_R(170.0) ? FED_BY_TRUTH : (fed_by)draw_one_of(&seed, 3);
        TEST_ASSERT_TRUE(compensated_rotor_start(&compensated, first) == WH_OK);
        compensated_rotor_hold(&compensated, first);
        compensated_rotor_run(&compensated, first, WH_R(5.0));
        compensated_rotor_hold(&compensated, rpm);
        compensated_rotor_run(&compensated, rpm, WH_R(6.0));
        compensated_rotor_count(&compensated);
        compensated_rotor_run(&compensated, rpm, WH_R(4.0));
        TEST_ASSERT_FALSE(compensated.stood);
        fine +=
            compensated.worst_rad < WH_R(0.3) && compensated.valid > compensated.steps / 10U * 9U
                ? 1U
                : 0U;
        lies += compensated.lies;
        valid += compensated.valid;
    }
    TEST_ASSERT_TRUE(fine >= draws / 10U * 9U);
    TEST_ASSERT_TRUE(lies < valid / 100U);
}

/* The observer starts at the second pulse and is valid three pulses later. It stays valid if one pulse of either sensor
 * is lost. After more than a turn without pulses it is invalid, and two turns later valid again. */
TEST(rig_observer, observer_becomes_valid) {
    begin(3, WH_R(330.0));
    unsigned pulses = 0;
    while (!compensated.observer.valid && pulses < 20U) {
        compensated_rotor_run(&compensated, WH_R(330.0), FED_STEP_S);
        pulses += compensated.rotor.pulses;
        TEST_ASSERT_TRUE(compensated.observer.runs == (pulses >= 2U));
    }
    TEST_ASSERT_EQUAL_UINT(5, pulses);
    compensated_rotor_run(&compensated, WH_R(330.0), WH_R(3.0));
    for (unsigned i = 0; i < 2; i++) {
        compensated.lose_pulses = 1;
        compensated_rotor_count(&compensated);
        compensated_rotor_run(&compensated, WH_R(330.0), WH_R(0.5) + (wh_real)i * WH_R(0.05));
        TEST_ASSERT_EQUAL_UINT(0, compensated.lose_pulses);
        TEST_ASSERT_EQUAL_UINT32(compensated.steps, compensated.valid);
        check_below(DEG, compensated.worst_rad);
    }
    compensated.lose_pulses = 3;
    compensated_rotor_count(&compensated);
    compensated_rotor_run(&compensated, WH_R(330.0), WH_R(0.7));
    const uint32_t missing = compensated.steps - compensated.valid;
    TEST_ASSERT_TRUE(missing > 60U && missing < 300U); /* a turn has 91 steps */
    TEST_ASSERT_TRUE(compensated.observer.valid);
    check_below(DEG, compensated.worst_rad);
}

/* A pulse at a wrong angle makes the observer invalid at once; within 2 s it is valid again. */
TEST(rig_observer, a_false_pulse_is_noticed) {
    begin(3, WH_R(330.0));
    for (unsigned i = 0; i < 20; i++) {
        compensated_rotor_run(&compensated, WH_R(330.0), WH_R(2.0) + WH_R(0.0371) * (wh_real)i);
        TEST_ASSERT_TRUE(compensated.observer.valid);
        const uint32_t now = compensated.rotor.ticks;
        const unsigned sensor = i % 2U;
        const wh_real off =
            rotor_ahead_rad(&compensated.rotor, compensated.observing.pulse_rad[sensor]);
        wh_observer_pulse(&compensated.observing, &compensated.observer, sensor, now);
        const wh_real seen = compensated.observer.innovation_rad;
        CHECK_NEAR(DEG, -(float)off, seen);
        TEST_ASSERT_TRUE(compensated.observer.valid ==
                         (WH_ABS(seen) <= compensated.observing.trusted_rad));
    }
}

/* The second pulse starts the observer, with the mean speed since the first. Both may come at any time within a
 * step. */
TEST(rig_observer, observer_starts_at_second_pulse) {
    static const wh_real turned[2][2] = {{WH_R(1.0), WH_R(0.25)}, {WH_R(0.75), WH_R(1.0)}};
    for (unsigned i = 0; i < 8; i++) {
        const unsigned first = i % 2U;
        const unsigned second = i / 2U % 2U;
        const bool slow = i >= 4U;
        begin(3, WH_R(330.0));
        const uint32_t from = compensated.rotor.ticks;
        const uint32_t took = slow ? UINT32_C(1400000) : UINT32_C(101300);
        for (uint32_t k = 2000; k <= took + 3000U; k += 2000U) {
            wh_observer_step(&compensated.observing, &compensated.observer, from + k, WH_R(0.5));
            if (k == 2000U) {
                wh_observer_pulse(&compensated.observing, &compensated.observer, first,
                                  from + 1300U);
            }
        }
        wh_observer_pulse(&compensated.observing, &compensated.observer, second,
                          from + 1300U + took);
        /* at 43 rpm a turn takes 1.4 s; the observer does not start for slower rotors */
        TEST_ASSERT_TRUE(compensated.observer.runs == (!slow || first == second));
        if (!slow) {
            const wh_real speed = turned[first][second] * WH_RIG_TWO_PI / WH_R(0.1013);
            CHECK_NEAR(1e-4f * (float)speed, speed, wh_observer_speed_radps(&compensated.observer));
            CHECK_NEAR(1e-5f, compensated.observing.pulse_rad[second],
                       wh_observer_angle_rad(&compensated.observer, from + 1300U + took));
        }
    }
}

/* Without pulses the observer stays valid for slightly more than a turn. If the rotor has stopped, it becomes
 * invalid. */
TEST(rig_observer, a_missed_turn_is_noticed) {
    for (unsigned i = 0; i < 2; i++) {
        begin(3, WH_R(250.0));
        compensated_rotor_run(&compensated, WH_R(250.0), WH_R(3.0));
        while (compensated.rotor.pulses == 0 || compensated.rotor.pulse_sensor[0] != 0) {
            compensated_rotor_run(&compensated, WH_R(250.0), FED_STEP_S);
        }
        if (i == 1U) { /* the position in which the rotor would hang */
            compensated.observer.state.real[0] = WH_R(5.0);
        }
        const wh_real drive = i == 0 ? compensated.voltage : WH_R(0.0);
        uint32_t steps = 0;
        while (compensated.observer.valid && steps < 700U) {
            steps++;
            wh_observer_step(&compensated.observing, &compensated.observer,
                             compensated.rotor.ticks + steps * FED_STEP_TICKS, drive);
        }
        const wh_real part = (wh_real)steps * FED_STEP_S * WH_R(250.0) / WH_R(60.0);
        TEST_ASSERT_TRUE(i == 0 ? part > WH_R(1.01) && part < WH_R(1.12) : steps < 300U);
    }
}

/* If control steps are no multiples of the scene's step, the remainder is added to the next control step. */
TEST(rig_observer, uneven_steps_lose_no_time) {
    begin(3, WH_R(330.0));
    compensated_rotor_hold(&compensated, WH_R(330.0));
    uint32_t seen = 0;
    for (unsigned i = 0; i < 4000; i++) {
        rotor_turn(&compensated.kind, &compensated.rotor, compensated.voltage,
                   i % 3U == 0 ? 2500 : 1500);
        wh_observer_step(&compensated.observing, &compensated.observer, compensated.rotor.ticks,
                         compensated.voltage);
        for (unsigned k = 0; k < compensated.rotor.pulses; k++) {
            wh_observer_pulse(&compensated.observing, &compensated.observer,
                              compensated.rotor.pulse_sensor[k], compensated.rotor.pulse_ticks[k]);
        }
        if (i >= 2000U) {
            const wh_real angle =
                wh_observer_angle_rad(&compensated.observer, compensated.rotor.ticks);
            CHECK_NEAR(0.02f * (float)DEG, 0.0f, rotor_ahead_rad(&compensated.rotor, angle));
            seen += compensated.observer.valid ? 1U : 0U;
        }
    }
    TEST_ASSERT_EQUAL_UINT32(2000, seen);
}

/* A late call, a long silence, or a drive that is NaN restarts the observer, and it converges again. */
TEST(rig_observer, observer_restarts) {
    const wh_real nan = (wh_real)__builtin_nanf("");
    for (unsigned i = 0; i < 4; i++) {
        compensated_rotor_standard(&compensated, 5);
        compensated.kind.friction_Nm = WH_R(0.05);
        TEST_ASSERT_TRUE(compensated_rotor_start(&compensated, WH_R(330.0)) == WH_OK);
        compensated_rotor_run(&compensated, WH_R(330.0), WH_R(2.0));
        TEST_ASSERT_TRUE(compensated.observer.valid && compensated.observer.runs);
        const uint32_t now = compensated.rotor.ticks;
        if (i == 0) {
            wh_observer_step(&compensated.observing, &compensated.observer, now + 8000U, WH_R(0.5));
        } else if (i == 1U) {
            for (uint32_t k = 2000; k <= UINT32_C(1600000); k += 2000U) {
                wh_observer_step(&compensated.observing, &compensated.observer, now + k, WH_R(0.0));
            }
            TEST_ASSERT_FALSE(compensated.observer.had_pulse);
        } else if (i == 2U) {
            wh_observer_step(&compensated.observing, &compensated.observer, now + 2000U, nan);
        } else {
            wh_observer_forget(&compensated.observer);
        }
        TEST_ASSERT_FALSE(compensated.observer.valid);
        TEST_ASSERT_FALSE(compensated.observer.runs);
        TEST_ASSERT_TRUE(compensated.observer.torque_Nm == WH_R(0.0));
        compensated.rotor.ticks =
            compensated.observer.ticks; /* the rotor was at rest for this time */
        compensated_rotor_run(&compensated, WH_R(330.0), WH_R(4.0));
        TEST_ASSERT_TRUE(compensated.observer.valid);
        const wh_real seen = wh_observer_angle_rad(&compensated.observer, compensated.rotor.ticks);
        CHECK_NEAR(DEG, 0.0f, rotor_ahead_rad(&compensated.rotor, seen));
    }
}

/* The observer starts neither for a rotor that hangs at a sensor and gives pulses by jitter, nor for one that hardly
 * moves. */
TEST(rig_observer, jitter_does_not_start_the_observer) {
    static const uint32_t apart[] = {1, 500, 5000, 60000, 1000000, 1490000, 1600000};
    for (unsigned i = 0; i < 7; i++) {
        begin(5, WH_R(100.0));
        uint32_t now = compensated.rotor.ticks;
        for (unsigned k = 0; k < 6; k++) {
            wh_observer_pulse(&compensated.observing, &compensated.observer, 0, now);
            for (const uint32_t until = now + apart[i]; (int32_t)(until - now) > 0;) {
                now += until - now < 2000U ? until - now : 2000U;
                wh_observer_step(&compensated.observing, &compensated.observer, now, WH_R(0.0));
            }
        }
        TEST_ASSERT_TRUE(compensated.observer.runs == (i == 4U || i == 5U)); /* 60 and 40.3 rpm */
    }
}

TEST(rig_observer, timer_wrap_changes_no_result) {
    wh_real speed[2];
    wh_phase phase[2];
    for (unsigned i = 0; i < 2; i++) {
        compensated_rotor_standard(&compensated, 9);
        compensated.kind.jitter_s = JITTER_S;
        compensated.rotor.ticks = i == 0 ? 1000U : UINT32_MAX - UINT32_C(1500000);
        TEST_ASSERT_TRUE(compensated_rotor_start(&compensated, WH_R(250.0)) == WH_OK);
        compensated_rotor_run(&compensated, WH_R(250.0), WH_R(3.0));
        speed[i] = wh_observer_speed_radps(&compensated.observer);
        phase[i] = wh_observer_phase(&compensated.observer, compensated.rotor.ticks + 3000U);
    }
    TEST_ASSERT_TRUE(speed[0] == speed[1] && phase[0] == phase[1]);
}

/* The observer refuses scenes of another kind. Without a scene it is never valid. */
TEST(rig_observer, unsuitable_scenes_are_refused) {
    compensated_rotor_standard(&compensated, 1);
    wh_scene other = rig_fixed;
    wh_scene without = rig_fixed;
    const wh_scene *scenes[] = {NULL, &thomson_a, &carriage_free, &other, &without};
    other.step_s = WH_R(0.0010005);
    without.inputs = 0;
    for (unsigned i = 0; i < 5; i++) {
        compensated.observing.scene = scenes[i];
        TEST_ASSERT_TRUE(compensated_rotor_start(&compensated, WH_R(330.0)) == WH_E_ARGUMENT);
        compensated_rotor_run(&compensated, WH_R(330.0), WH_R(1.0));
        TEST_ASSERT_EQUAL_UINT32(0, compensated.valid);
        TEST_ASSERT_TRUE(wh_observer_speed_radps(&compensated.observer) == WH_R(0.0));
        TEST_ASSERT_TRUE(wh_observer_angle_rad(&compensated.observer, 77) == WH_R(0.0));
    }
}

/* test_rig_gravity.c: gravity compensation: its voltage, when the voltage is zero, and its effect on the ripple of a
 * rotor in closed loop (compensated_rotor.c), also with wrong settings. */
#include "compensated_rotor.h"
#include "core/angle.h"
#include "core/rig/datasheet.h"
#include "core/rig/lockin.h"
#include "core/rig/polar.h"
#include "core/rig/rig.h"
#include "core/root.h"
#include "draw.h"

#include "tests/suites.h"

#define RPM WH_RIG_RADPS_PER_RPM
#define DEG (WH_R(1.0) / WH_RIG_DEG_PER_RAD)
#define JITTER_S WH_R(104e-6) /* uniform: a standard deviation of 60 us */

static compensated_rotor compensated;

static void check_between(wh_real least, wh_real most, wh_real value) {
    TEST_ASSERT_TRUE(value > least && value < most);
}

static wh_real sine_of(wh_real rad) { return wh_wave_of(rad).sine; }

/* The voltage is the torque of gravity, S g sin(theta - gamma), divided by the stall torque. theta is the angle after
 * the lead. The voltage is limited, and fades in linearly. */
TEST(rig_gravity, voltage_follows_the_torque_of_gravity) {
    static const wh_real gravity_rad[] = {WH_R(0.0), WH_R(1.2), WH_R(-2.8)};
    for (unsigned i = 0; i < 6; i++) {
        compensated_rotor_standard(&compensated, 1);
        TEST_ASSERT_TRUE(compensated_rotor_start(&compensated, WH_R(330.0)) == WH_OK);
        compensated_rotor_run(&compensated, WH_R(330.0), WH_R(3.0));
        wh_compensation_config config = wh_compensation_standard;
        config.gravity_rad = gravity_rad[i % 3U];
        config.weight_Nm *= i < 3U ? WH_R(1.0) : WH_R(10.0);
        wh_compensation feed = {WH_R(0.0)};
        for (unsigned k = 1; k <= 300; k++) {
            compensated_rotor_run(&compensated, WH_R(330.0), FED_STEP_S);
            const wh_real said = wh_compensation_step(&config, &feed, &compensated.observer,
                                                      compensated.rotor.ticks, FED_STEP_S);
            const wh_real part = k < 250U ? (wh_real)k / WH_R(250.0) : WH_R(1.0);
            const wh_real at = compensated.rotor.angle_rad +
                               WH_R(0.003) * compensated.rotor.speed_radps - config.gravity_rad;
            const wh_real all = part * config.weight_Nm / WH_R(1.5) * sine_of(at);
            const wh_real most = WH_R(0.3);
            const wh_real wanted = all > most ? most : all < -most ? -most : all;
            CHECK_NEAR(i < 3U ? 5e-4f : 5e-3f, wanted, said);
            CHECK_NEAR(1e-4f, part, feed.part);
        }
    }
}

/* If the observer is invalid, the voltage is zero at once; afterwards it fades in again. It is never NaN. */
TEST(rig_gravity, voltage_is_zero_without_an_angle) {
    const wh_real nan = (wh_real)__builtin_nanf("");
    compensated_rotor_standard(&compensated, 1);
    TEST_ASSERT_TRUE(compensated_rotor_start(&compensated, WH_R(330.0)) == WH_OK);
    compensated_rotor_run(&compensated, WH_R(330.0), WH_R(3.0));
    TEST_ASSERT_TRUE(compensated.observer.valid && compensated.compensation.part >= WH_R(1.0));
    compensated.observer.valid = false;
    const uint32_t now = compensated.rotor.ticks;
    TEST_ASSERT_TRUE(wh_compensation_step(&compensated.feeding, &compensated.compensation,
                                          &compensated.observer, now, FED_STEP_S) == WH_R(0.0));
    TEST_ASSERT_TRUE(compensated.compensation.part == WH_R(0.0));
    compensated.observer.valid = true;
    TEST_ASSERT_TRUE(WH_ABS(wh_compensation_step(&compensated.feeding, &compensated.compensation,
                                                 &compensated.observer, now, FED_STEP_S)) <
                     WH_R(0.001));
    CHECK_NEAR(1e-6f, 0.004f, compensated.compensation.part);
    compensated.feeding.fade_s = WH_R(0.0);
    wh_compensation_step(&compensated.feeding, &compensated.compensation, &compensated.observer,
                         now, FED_STEP_S);
    TEST_ASSERT_TRUE(compensated.compensation.part == WH_R(1.0));
    for (unsigned i = 0; i < 4; i++) {
        wh_compensation_config config = wh_compensation_standard;
        wh_real *const numbers[] = {&config.weight_Nm, &config.gravity_rad, &config.stall_Nm,
                                    &config.fade_s};
        *numbers[i] = nan;
        const wh_real said = wh_compensation_step(&config, &compensated.compensation,
                                                  &compensated.observer, now, FED_STEP_S);
        TEST_ASSERT_TRUE(WH_ABS(said) <= config.most);
    }
}

/* Starts at 200 rpm, changes to this speed and keeps it, with jitter and a friction of 0.02 N m. */
static void run_at(wh_real rpm) {
    compensated.kind.jitter_s = JITTER_S;
    compensated.kind.friction_Nm += WH_R(0.02);
    TEST_ASSERT_TRUE(compensated_rotor_start(&compensated, WH_R(200.0)) == WH_OK);
    compensated_rotor_run(&compensated, WH_R(200.0), WH_R(3.0));
    compensated_rotor_run(&compensated, rpm, WH_R(6.0));
    compensated_rotor_count(&compensated);
    compensated_rotor_run(&compensated, rpm, WH_R(3.0));
    TEST_ASSERT_FALSE(compensated.stood);
    /* the last, incomplete turn adds some ripple to the mean */
    CHECK_NEAR(2.5f, rpm, fed_rotor_mean_rpm(&compensated));
}

static void begin(fed_by by) {
    compensated_rotor_standard(&compensated, 17);
    compensated.by = by;
}

/* At 330 rpm gravity compensation reduces the ripple from 5 % to a hundredth of that; at 170 rpm, from 18 %. At 100 rpm
 * the rotor would not pass the top without compensation. At that speed the motor brakes at most as much as with shorted
 * leads, so some ripple remains. Friction reduces it. */
TEST(rig_gravity, ripple_disappears) {
    begin(FED_BY_NOBODY);
    run_at(WH_R(330.0));
    check_between(WH_R(0.045), WH_R(0.055), compensated_rotor_ripple(&compensated));
    begin(FED_BY_NOBODY);
    run_at(WH_R(170.0));
    check_between(WH_R(0.17), WH_R(0.19), compensated_rotor_ripple(&compensated));
    begin(FED_BY_OBSERVER);
    run_at(WH_R(330.0));
    check_between(WH_R(0.00005), WH_R(0.001), compensated_rotor_ripple(&compensated));
    begin(FED_BY_OBSERVER);
    run_at(WH_R(170.0));
    check_between(WH_R(0.00005), WH_R(0.0015), compensated_rotor_ripple(&compensated));
    begin(FED_BY_OBSERVER);
    run_at(WH_R(100.0));
    check_between(WH_R(0.02), WH_R(0.05), compensated_rotor_ripple(&compensated));
    begin(FED_BY_OBSERVER);
    compensated.kind.friction_Nm = WH_R(0.1);
    run_at(WH_R(100.0));
    check_between(WH_R(0.0005), WH_R(0.02), compensated_rotor_ripple(&compensated));
    TEST_ASSERT_EQUAL_UINT32(compensated.steps, compensated.valid);
}

/* The lead compensates the delay of the voltage. Without it, or with twice the lead, a tenth of the ripple remains. */
TEST(rig_gravity, the_lead_is_right) {
    for (uint32_t lead = 0; lead <= 6000U; lead += 6000U) {
        begin(FED_BY_OBSERVER);
        compensated.feeding.lead_ticks = lead;
        run_at(WH_R(330.0));
        check_between(WH_R(0.004), WH_R(0.007), compensated_rotor_ripple(&compensated));
    }
}

TEST(rig_gravity, wrong_weight_gives_a_remaining_ripple) {
    for (unsigned i = 0; i < 4; i++) {
        begin(FED_BY_OBSERVER);
        compensated.kind.weight_Nm *= i % 2U == 0 ? WH_R(1.3) : WH_R(0.7);
        run_at(i < 2U ? WH_R(330.0) : WH_R(170.0));
        const wh_real whole = i < 2U ? WH_R(0.05) : WH_R(0.18);
        check_between(WH_R(0.25) * whole, WH_R(0.35) * whole,
                      compensated_rotor_ripple(&compensated));
        TEST_ASSERT_EQUAL_UINT32(compensated.steps, compensated.valid);
    }
}

/* If the sensor positions are wrong by 3 degrees, in equal or opposite directions, at most a twentieth of the ripple
 * remains. */
TEST(rig_gravity, displaced_sensors) {
    for (unsigned i = 0; i < 8; i++) {
        begin(FED_BY_OBSERVER);
        compensated.kind.pulse_rad[0] += (i % 2U == 0 ? WH_R(3.0) : WH_R(-3.0)) * DEG;
        compensated.kind.pulse_rad[1] += (i / 2U % 2U == 0 ? WH_R(3.0) : WH_R(-3.0)) * DEG;
        run_at(i < 4U ? WH_R(330.0) : WH_R(170.0));
        const wh_real whole = i < 4U ? WH_R(0.05) : WH_R(0.18);
        check_between(WH_R(0.002) * whole, WH_R(0.07) * whole,
                      compensated_rotor_ripple(&compensated));
        TEST_ASSERT_EQUAL_UINT32(compensated.steps, compensated.valid);
    }
}

/* With the wrong sign the ripple doubles, but the mean speed stays, and the shaft's limit is not exceeded. */
TEST(rig_gravity, the_wrong_sign_is_survived) {
    for (unsigned i = 0; i < 4; i++) {
        begin(FED_BY_OBSERVER);
        if (i % 2U == 0) {
            compensated.feeding.weight_Nm = -compensated.feeding.weight_Nm;
        } else {
            compensated.feeding.gravity_rad = WH_R(0.5) * WH_RIG_TWO_PI;
        }
        run_at(i < 2U ? WH_R(330.0) : WH_R(170.0));
        const wh_real whole = i < 2U ? WH_R(0.05) : WH_R(0.18);
        check_between(WH_R(1.8) * whole, WH_R(2.2) * whole, compensated_rotor_ripple(&compensated));
        TEST_ASSERT_TRUE(compensated.most_radps < WH_RIG_SHAFT_LIMIT_RPM * RPM);
        TEST_ASSERT_TRUE(compensated.least_radps > WH_R(90.0) * RPM);
    }
}

/* If pulses are missing, the voltage is zero at once and the ripple returns. When the pulses come again, the ripple
 * disappears again. */
TEST(rig_gravity, lost_pulses_end_the_compensation) {
    begin(FED_BY_OBSERVER);
    run_at(WH_R(330.0));
    compensated.lose_pulses = 4;
    compensated_rotor_count(&compensated);
    compensated_rotor_run(&compensated, WH_R(330.0), WH_R(0.6));
    TEST_ASSERT_TRUE(compensated.valid < compensated.steps);
    check_between(WH_R(0.01), WH_R(0.08), compensated_rotor_ripple(&compensated));
    compensated_rotor_run(&compensated, WH_R(330.0), WH_R(4.0));
    compensated_rotor_count(&compensated);
    compensated_rotor_run(&compensated, WH_R(330.0), WH_R(1.0));
    check_between(WH_R(0.00001), WH_R(0.001), compensated_rotor_ripple(&compensated));
}

/* If the inertia is given, the remaining part of gravity, of either sign, follows from the quadrature ratio alone. When
 * the compensation ends, the estimate restarts. */
TEST(rig_gravity, remaining_gravity_from_the_quadrature_ratio) {
    static const wh_real parts[] = {WH_R(0.0), WH_R(0.3), WH_R(-0.3), WH_R(0.05)};
    static const wh_real rpm[] = {WH_R(130.0), WH_R(170.0), WH_R(330.0)};
    wh_rotor_config rotor = wh_rig_standard.measure.rotor;
    rotor.pulse_rad[0] = -DEG;
    rotor.pulse_rad[1] = WH_R(89.0) * DEG;
    for (unsigned k = 0; k < 12; k++) {
        const wh_real speed = rpm[k / 4U] * RPM;
        wh_turn_angle wanted;
        wh_turn_angle_start(&rotor, &wanted);
        wh_turn_angle_compensate(&wanted, true, WH_R(0.0625));
        wanted.part = parts[k % 4U];
        wh_turn_angle found;
        wh_turn_angle_start(&rotor, &found);
        wh_turn_angle_compensate(&found, true, WH_R(0.0625));
        wanted.drive_V = found.drive_V = WH_R(24.0);
        for (unsigned i = 0; i < 4; i++) {
            wh_turn_angle_shape(&rotor, &wanted, speed);
        }
        /* Part of the turn's time before sensor 2's angle. */
        wh_real ratio = WH_R(0.25);
        for (unsigned i = 0; i < 30; i++) {
            ratio -= (wh_turn_angle_at(&wanted, ratio) - rotor.pulse_rad[1]) / WH_RIG_TWO_PI;
        }
        for (unsigned i = 0; i < 12; i++) {
            /* Compensation was already on, so this call changes nothing. */
            wh_turn_angle_compensate(&found, true, WH_R(0.0625));
            wh_turn_angle_shape(&rotor, &found, speed);
            wh_turn_angle_by_ratio(&rotor, &found, ratio);
        }
        TEST_ASSERT_EQUAL_UINT32(12, found.ratios);
        CHECK_NEAR(1e-3f, wanted.part, found.part);
        TEST_ASSERT_TRUE(found.inertia_kgm2 == rotor.inertia_kgm2);
        wh_turn_angle_shape(&rotor, &found, speed);
        for (unsigned i = 0; i <= 16; i++) {
            const wh_real part = (wh_real)i / WH_R(16.0);
            CHECK_NEAR(2e-4f, wh_turn_angle_at(&wanted, part), wh_turn_angle_at(&found, part));
        }
        wh_turn_angle_compensate(&found, false, WH_R(0.0625));
        TEST_ASSERT_TRUE(found.part == WH_R(1.0) && found.ratios == 0);
    }
}

/* The turn in which the compensation changes does not count. If the motor cannot brake, the drive's own voltage limits
 * the compensation; `cut` is the missing part. */
TEST(rig_gravity, lock_in_skips_a_changed_turn) {
    static wh_lockin lockin;
    const wh_rotor_config *rotor = &wh_rig_standard.measure.rotor;
    wh_lockin_forget(rotor, &lockin);
    wh_lockin_pulse(&lockin, 0, 1000, 0);
    wh_lockin_compensate(&lockin, false, WH_R(0.0625));
    TEST_ASSERT_TRUE(lockin.open && lockin.skipped == 0);
    wh_lockin_compensate(&lockin, true, WH_R(0.0625));
    TEST_ASSERT_TRUE(!lockin.open && lockin.skipped == 1U && lockin.angle.compensated);
    wh_lockin_pulse(&lockin, 0, 2000, 4);
    wh_lockin_compensate(&lockin, true, WH_R(0.0625));
    TEST_ASSERT_TRUE(lockin.open && lockin.skipped == 1U);
    const wh_real weight_Nm = rotor->unbalance_kgm * rotor->gravity_mps2;
    lockin.angle.drive_V = WH_R(16.0) * weight_Nm;
    wh_turn_angle_shape(rotor, &lockin.angle, WH_R(100.0) * RPM);
    TEST_ASSERT_TRUE(lockin.angle.cut == WH_R(0.0));
    lockin.angle.drive_V = WH_R(0.71) * WH_R(16.0) * weight_Nm;
    wh_turn_angle_shape(rotor, &lockin.angle, WH_R(100.0) * RPM);
    CHECK_NEAR(1e-6f, 0.29f, lockin.angle.cut);
    wh_lockin_compensate(&lockin, false, WH_R(0.0625));
    wh_turn_angle_shape(rotor, &lockin.angle, WH_R(100.0) * RPM);
    TEST_ASSERT_TRUE(lockin.angle.cut == WH_R(0.0));
}

static double root(double x) { return (double)WH_SQRT((wh_real)x); }

/* Reference: (1/pi) times the integral of (cos y - k) cos 2y over the angles with cos y > k, by the midpoint rule. */
static double second_of_pulse(double k) {
    double sum = 0.0;
    for (unsigned i = 0; i < 4096U; i++) {
        wh_real sine;
        wh_real cosine;
        wh_sincos(wh_phase_from_rad(WH_RIG_TWO_PI * ((wh_real)i + WH_R(0.5)) / WH_R(4096.0)), &sine,
                  &cosine);
        const double over = (double)cosine - k;
        sum += over > 0.0 ? over * (2.0 * (double)cosine * (double)cosine - 1.0) : 0.0;
    }
    return sum * 2.0 / 4096.0;
}

/* If the motor cannot brake, a torque W cos 2 theta remains twice per turn. The response is that of inertia and slope:
 * J theta'' + c theta' = -W cos 2 theta. */
TEST(rig_gravity, the_answer_to_a_pulse) {
    uint64_t seed = 77;
    for (unsigned i = 0; i < 60U; i++) {
        wh_rotor_config rotor = wh_rig_standard.measure.rotor;
        rotor.pulse_rad[0] = -DEG;
        rotor.damping_Nms = WH_R(0.01) * draw_whole(&seed, 2, 4);
        const wh_real speed = draw_whole(&seed, 70, 120) * RPM;
        const wh_real cut = WH_R(0.01) * draw_whole(&seed, 3, 35);
        const wh_real weight_Nm = rotor.unbalance_kgm * rotor.gravity_mps2;
        wh_turn_angle angle;
        wh_turn_angle_start(&rotor, &angle);
        wh_turn_angle_compensate(&angle, true, WH_R(0.0625));
        angle.drive_V = (WH_R(1.0) - cut) * WH_R(16.0) * weight_Nm;
        for (unsigned k = 0; k < 6U; k++) {
            wh_turn_angle_shape(&rotor, &angle, speed);
        }
        const double turning = 2.0 * (double)angle.inertia_kgm2 * (double)speed;
        const double slope = (double)rotor.damping_Nms;
        const double size = (double)weight_Nm * second_of_pulse(1.0 - (double)cut) /
                            (2.0 * (double)speed * root(turning * turning + slope * slope));
        /* Fourier components over the angle of a constant speed. Equidistant samples make them exact. */
        double off[2] = {0.0, 0.0};
        for (unsigned k = 0; k < 64U; k++) {
            const wh_real part = (wh_real)k / WH_R(64.0);
            const wh_real even = angle.base_rad + WH_RIG_TWO_PI * part;
            const wh_wave twice = wh_wave_of(WH_R(2.0) * (even - rotor.gravity_rad));
            const double wave = (double)(wh_turn_angle_at(&angle, part) - even);
            off[0] += wave * (double)twice.cosine / 32.0;
            off[1] += wave * (double)twice.sine / 32.0;
        }
        const double sum = root(turning * turning + slope * slope);
        const double most = 0.01 * size + 1e-5;
        CHECK_NEAR(most, size * turning / sum, off[0]);
        CHECK_NEAR(most, -size * slope / sum, off[1]);
    }
}

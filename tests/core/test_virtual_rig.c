/* test_virtual_rig.c: the whole rig on its model: the measurement of the dissertation, with noise and lost pulses. The
 * virtual rig computes in single precision only, so the double build tests only the formula. */
#include "on_plant.h"

#include "tests/suites.h"

/* The formula of I.3.2.1 in its own units (weights divided by g, inches) gives 9.44 lbf at 330 rpm. */
static void test_unbalance_gives_the_dissertations_force(void) {
    const wh_real omega = WH_R(5.5) * WH_RIG_TWO_PI;
    const wh_real g_inps2 = WH_R(386.0886);
    const wh_real force_lbf = omega * omega / g_inps2 *
                              (WH_R(0.152) * (WH_R(7.25) / WH_R(2.0)) + WH_R(0.15) * WH_R(6.5)) *
                              WH_R(2.0);
    const wh_real force_N = WH_RIG_UNBALANCE_KGM * omega * omega;
    CHECK_NEAR(0.005f, 9.44f, force_lbf);
    CHECK_NEAR(0.001f, force_lbf, force_N * WH_RIG_LBF_PER_N);
    CHECK_NEAR(0.05f, 42.0f, force_N);
}

#if !WH_DOUBLE

static on_plant on;

/* Checks that the run is done, with the speed within 2 rpm. The force is the unbalance times the mean square of the
 * speed, within 0.1 %. The phase is 0 within 0.1 degrees, as for every rotor whose speed repeats each turn
 * (docs/rig.md). */
static void check_measurement(float target_rpm) {
    TEST_ASSERT_TRUE(plant_is_done(&on));
    const wh_measured *force = &on.rig.result.force;
    const float omega = target_rpm * RPM;
    const float swing =
        WH_RIG_UNBALANCE_KGM * WH_RIG_GRAVITY_MPS2 / (WH_RIG_INERTIA_KGM2 * omega * omega);
    const float wanted_N = WH_RIG_UNBALANCE_KGM * omega * omega * (1.0f + 1.5f * swing * swing);
    CHECK_NEAR(2.0f, target_rpm, force->speed_radps / RPM);
    /* wanted_N follows from the speed alone, without the damping's part of the ripple */
    CHECK_NEAR(0.005f * wanted_N, wanted_N, force->amplitude_N);
    CHECK_NEAR(0.001f * wanted_N, force->expected_N, force->amplitude_N);
    CHECK_NEAR(0.1f, 0.0f, force->phase_rad * WH_RIG_DEG_PER_RAD);
    TEST_ASSERT_TRUE(force->quality == WH_GOOD);
    CHECK_NEAR(0.02f * WH_RIG_INERTIA_KGM2, WH_RIG_INERTIA_KGM2, force->inertia_kgm2);
}

static void test_measurement_of_the_force(void) {
    plant_begin(&on, 330.0f);
    plant_go_on_to_the_end(&on);
    check_measurement(330.0f);
    plant_check_stopped(&on);
    const wh_rig_result *result = &on.rig.result;
    TEST_ASSERT_EQUAL_UINT32(10, result->force.turns);
    TEST_ASSERT_EQUAL_UINT32(0, result->lost + result->rejected);
    /* circular motion has no mean acceleration: the tare must cancel */
    CHECK_NEAR(0.1f, 0.0f, result->force.mean_N);
    /* 12 lb of frame and 0.604 lb of arms and discs */
    CHECK_NEAR(0.01f, 12.604f * 4.4482216f, result->tare_N);
}

/* The noise of the model's cell (cell_noise, 0.07 N), or much more, acts at the tare, in the guard's checks, and in the
 * measurement. The interval grows with the noise and contains the true force with a margin. */
static void test_a_noisy_cell_is_no_fault(void) {
    static const float noises_N[] = {0.07f, 0.5f, 1.0f, 3.0f};
    float before_N = 0.0f;
    for (unsigned i = 0; i < 4; i++) {
        plant_begin(&on, 330.0f);
        on.noise_N = noises_N[i];
        plant_go_on_to_the_end(&on);
        const wh_rig_result *result = &on.rig.result;
        TEST_ASSERT_TRUE(plant_is_done(&on) && result->force.quality == WH_GOOD);
        CHECK_NEAR(2.0f * result->force.amplitude_half_N, 42.15f, result->force.amplitude_N);
        CHECK_NEAR(2.0f * result->force.phase_half_rad, 0.0f, result->force.phase_rad);
        CHECK_NEAR(0.25f * noises_N[i], noises_N[i], result->force.residual_N);
        CHECK_NEAR(0.015f * noises_N[i], noises_N[i] / 15.8f, result->tare_error_N);
        TEST_ASSERT_TRUE(result->force.amplitude_half_N > before_N);
        before_N = result->force.amplitude_half_N;
    }
}

/* Gravity accelerates the arms on the way down. So both peaks of the load are shifted by 2 S^2 g / I = 4.2 N towards
 * the bottom. Sensor 1's pulse is at the upper peak, sensor 2's near zero load. */
static void test_gravity_shows_in_the_peaks_and_spikes(void) {
    const wh_rig_result *result = &on.rig.result;
    CHECK_NEAR(0.5f, 42.0f + 4.2f, result->high_N);
    CHECK_NEAR(0.5f, -42.0f + 4.2f, result->low_N);
    CHECK_NEAR(0.2f, result->high_N, result->force.at_pulse_N[0]);
    CHECK_NEAR(2.5f, 0.0f, result->force.at_pulse_N[1]);
}

/* After the rig has settled, each pulse comes when the rotor is at the sensor. The rotor's position at the pulse is its
 * phase in the next step, minus the angle turned since the pulse. */
static void test_pulses_stand_at_their_angles(void) {
    plant_begin(&on, 330.0f);
    plant_go_on_until(&on, WH_PHASE_RECORD);
    TEST_ASSERT_TRUE(on.rig.run.phase == WH_PHASE_RECORD);
    hal_virtual_rig *plant = hal_virtual_rig_instance();
    unsigned pulses = 0;
    hal_slot_edge last = {.end = HAL_SLOT_TRAILING};
    for (unsigned i = 0; i < 2000U; i++) {
        hal_clock_wait_until(hal_clock_ticks() + 1000U);
        hal_watchdog_kick();
        hal_slot_edge pulse;
        while (hal_slots_take(&pulse)) {
            if (pulse.end == HAL_SLOT_TRAILING) {
                TEST_ASSERT_TRUE(pulses == 0 || last.end == HAL_SLOT_LEADING);
                TEST_ASSERT_TRUE(pulses == 0 ||
                                 (pulse.sensor == last.sensor &&
                                  pulse.ticks - last.ticks == HAL_VIRTUAL_PULSE_TICKS));
                last = pulse;
                continue;
            }
            TEST_ASSERT_EQUAL(HAL_SLOT_TRAILING, last.end);
            last = pulse;
            const float since_s = (float)(hal_clock_ticks() - pulse.ticks) * 1e-6f;
            const float speed = hal_virtual_rig_speed_radps(plant);
            const float turned = speed * since_s * WH_PHASE_PER_RAD;
            const uint32_t stand = pulse.sensor * 0x40000000U;
            const float off = (float)(int32_t)(wh_phase_of(plant->state.angle[0]) - stand) - turned;
            const float off_deg = off / WH_PHASE_PER_RAD * WH_RIG_DEG_PER_RAD;
            CHECK_NEAR(0.005f, -HAL_SLOT_LEAD_DEG, off_deg);
            pulses++;
        }
    }
    TEST_ASSERT_TRUE(pulses >= 21U && pulses <= 23U); /* two per turn, at 5.5 turns per second */
}

static void test_slowest_and_fastest_set_points_run(void) {
    static const wh_real targets_rpm[] = {WH_RIG_TARGET_MIN_RPM, WH_RIG_TARGET_MAX_RPM};
    for (unsigned i = 0; i < 2; i++) {
        plant_begin(&on, targets_rpm[i]);
        plant_go_on_to_the_end(&on);
        check_measurement(targets_rpm[i]);
        /* The run needs the voltage that the check of the supply assumes. */
        CHECK_NEAR(0.5f, wh_run_needs_V(&on.config.run, targets_rpm[i] * RPM), on.rig.result.volts);
        plant_check_stopped(&on);
    }
}

/* The constants of the controller are not computed from the model, so they must agree with it. */
static void test_data_sheet_agrees_with_the_model(void) {
    wh_real output[8];
    wh_state state;
    static uint64_t memory[WH_STATE_WORDS(1, 1, 1)];
    TEST_ASSERT_EQUAL_UINT(3, rig_fixed.outputs);
    TEST_ASSERT_TRUE(wh_scene_start(&rig_fixed, &state, memory, sizeof memory) == WH_OK);
    state.real[0] = 10.0f;
    rig_fixed.observe(&rig_fixed, &state, output);
    CHECK_NEAR(1e-5f, 100.0f * WH_RIG_UNBALANCE_KGM, output[2]);
    /* If the mass is on the axis, the cell measures the whole force. */
    CHECK_NEAR(1e-5f, output[2], output[1]);
    /* If the arms are level, the force is the unbalance times the angular acceleration by gravity and damping. */
    state.angle[0] = wh_angle_from_rad(0.25f * WH_RIG_TWO_PI);
    state.real[0] = 0.0f;
    state.input[0] = 0.0f;
    rig_fixed.observe(&rig_fixed, &state, output);
    const float falls = WH_RIG_UNBALANCE_KGM * WH_RIG_GRAVITY_MPS2 / WH_RIG_INERTIA_KGM2;
    CHECK_NEAR(1e-5f, -WH_RIG_UNBALANCE_KGM * falls, output[1]);
    state.real[0] = 20.0f;
    rig_fixed.observe(&rig_fixed, &state, output);
    const float slows = WH_RIG_DAMPING_NMS * 20.0f / WH_RIG_INERTIA_KGM2;
    CHECK_NEAR(1e-5f, -WH_RIG_UNBALANCE_KGM * (falls + slows), output[1]);
}

static void test_a_foreign_scene_is_refused(void) {
    static hal_virtual_rig other;
    wh_scene scene = rig_fixed;
    scene.inputs = 2;
    TEST_ASSERT_FALSE(hal_virtual_rig_start(&other, &scene));
    TEST_ASSERT_TRUE(hal_virtual_rig_start(&other, &rig_fixed));
}

#endif

SUITE(virtual_rig) {
    RUN_TEST(test_unbalance_gives_the_dissertations_force);
#if !WH_DOUBLE
    RUN_TEST(test_measurement_of_the_force);
    RUN_TEST(test_gravity_shows_in_the_peaks_and_spikes);
    RUN_TEST(test_a_noisy_cell_is_no_fault);
    RUN_TEST(test_pulses_stand_at_their_angles);
    RUN_TEST(test_slowest_and_fastest_set_points_run);
    RUN_TEST(test_data_sheet_agrees_with_the_model);
    RUN_TEST(test_a_foreign_scene_is_refused);
#endif
}

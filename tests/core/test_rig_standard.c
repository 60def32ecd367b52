/* test_rig_standard.c: the standard rig's settings (docs/rig.md has the reasons). If you change a setting, change it
 * here, too, and add it to CHANGELOG.md. */
#include "core/rig/rig.h"

#include "tests/suites.h"

typedef struct setting {
    const char *name;
    wh_real value;
    double recorded;
} setting;

#define DEG(x) ((x)*WH_RIG_DEG_PER_RAD)
#define RPM(x) ((x) / WH_RIG_RADPS_PER_RPM)
#define COUNT(x) ((wh_real)(x))

static void check(const setting *settings, unsigned count) {
    for (unsigned i = 0; i < count; i++) {
        const float recorded = (float)settings[i].recorded;
        TEST_ASSERT_FLOAT_WITHIN_MESSAGE(2e-6f * recorded, recorded, (float)settings[i].value,
                                         settings[i].name);
    }
}
#define CHECK(settings) check(settings, (unsigned)(sizeof(settings) / sizeof(settings)[0]))

TEST(rig_standard, the_run) {
    const wh_run_config *run = &wh_rig_standard.run;
    const setting settings[] = {
        {"control step, s", run->step_s, 0.002},
        {"proportional gain, V s/rad", run->drive.proportional_V_per_radps, 0.24},
        {"integral gain, V/rad", run->drive.integral_V_per_rad, 1.0},
        {"ramp, rpm/s", RPM(run->drive.ramp_radps2), 60},
        {"gentle below, rpm", RPM(run->drive.gentle_radps), 150},
        {"rated voltage, V", run->rated_V, 24},
        {"no-load speed, rpm", RPM(run->no_load_radps), 600},
        {"drag, V", run->drag_V, 0.8},
        {"spin up at, V", run->spin_up_V, 9.6},
        {"and rising by, V/s", run->spin_up_V_per_s, 2},
        {"the loop takes over at, rpm", RPM(run->take_over_radps), 150},
        {"spin up at most, s", run->spin_up_max_s, 8},
        {"ramp at most, s", run->ramp_max_s, 25},
        {"settled within, rpm", RPM(run->settle_band_radps), 0.5},
        {"settled for, s", run->settle_s, 2.5},
        {"settling at most, s", run->settle_max_s, 20},
        {"short of voltage at most, s", run->short_max_s, 2},
        {"recorded within, rpm", RPM(run->record_band_radps), 2},
        {"ramp down to, rpm", RPM(run->slow_radps), 200},
        {"armed at most, s", wh_rig_standard.armed_max_s, 60},
        {"to rest at most, s", wh_rig_standard.rest_max_s, 120},
        {"and tripped, s", wh_rig_standard.tripped_max_s, 20},
        {"impossible beyond, rpm", RPM(wh_rig_standard.impossible_radps), 930}};
    CHECK(settings);
    TEST_ASSERT_TRUE(!wh_rig_standard.stop_brakes && wh_rig_standard.host_loss_stops);
    TEST_ASSERT_TRUE(wh_rig_standard.compensation_when == WH_COMPENSATION_SLOW);
}

TEST(rig_standard, the_guard) {
    const wh_guard_config *guard = &wh_rig_standard.guard;
    const setting settings[] = {
        {"set-point at least, rpm", RPM(guard->target_min_radps), 170},
        {"where gravity is fed, rpm", RPM(guard->target_min_compensated_radps), 100},
        {"set-point at most, rpm", RPM(guard->target_max_radps), 360},
        {"the shaft's limit, rpm", RPM(guard->limit_radps), 400},
        {"ripple", guard->ripple, 0.1},
        {"over the set-point", guard->over, 0.03},
        {"climb", guard->climb, 0.02},
        {"climb at the start, rpm/s", RPM(guard->climb_start_radps2), 500},
        {"climb behind the set-point, rpm/s", RPM(guard->climb_behind_radps2), 70},
        {"behind is more than, rpm", RPM(guard->behind_radps), 8},
        {"climb at the set-point, rpm/s", RPM(guard->climb_there_radps2), 15},
        {"fall, rad/s", guard->fall_radps, 15.5},
        {"lost pulses", COUNT(guard->lost_max), 3},
        {"doubt", COUNT(guard->doubt_max), 6},
        {"rejected pulses", COUNT(guard->rejected_max), 40},
        {"silence, s", guard->silence_max_s, 0.5},
        {"silence while slow, s", guard->slow_silence_max_s, 2},
        {"silence of the cell, s", guard->load_silence_max_s, 0.02},
        {"a still cell, of the masses' force", guard->load_still_kgm / WH_RIG_UNBALANCE_KGM, 0.1},
        {"pulses of a stuck cell", COUNT(guard->stuck_pulses), 3},
        {"supply at least, V", guard->supply_min_V, 10.8},
        {"supply at most, V", guard->supply_max_V, 37.2},
        {"rest, s", guard->rest_s, 1.5}};
    CHECK(settings);
}

TEST(rig_standard, the_measurement) {
    const wh_measure_config *measure = &wh_rig_standard.measure;
    const wh_result_config *result = &measure->result;
    const wh_swing_config *swing = &wh_rig_standard.swing;
    const setting settings[] = {
        {"damping within", measure->rotor.damping_tolerance, 0.03},
        {"angle of what is fed within, rad", measure->rotor.compensation_tolerance_rad, 0.04},
        {"tare, samples", COUNT(measure->tare.samples), 250},
        {"still within, N", measure->tare.still_N, 0.05},
        {"and at most, N", measure->tare.most_N, 0.25},
        {"mount", result->mount_factor, 1},
        {"amplitude's floor: uncalibrated", result->amplitude_floor, 0},
        {"phase's floor, deg", DEG(result->phase_floor_rad), 0},
        {"amplitude off by", result->amplitude_off, 0.05},
        {"amplitude wrong by", result->amplitude_wrong, 0.25},
        {"phase off by, deg", DEG(result->phase_off_rad), 5},
        {"phase wrong by, deg", DEG(result->phase_wrong_rad), 20},
        {"residual", result->residual_large, 0.25},
        {"mean off by", result->mean_off, 0.1},
        {"inertia off by", result->inertia_off, 0.5},
        {"record, s", measure->record_s, 2},
        {"record, turns", measure->record_turns, 7.5},
        {"sensors off at most, deg", DEG(swing->most_rad), 8},
        {"jitter of a swing's pulses, s", swing->jitter_s, 1e-4},
        {"roughness, rad", swing->rough_rad, 8e-4},
        {"a place's floor, deg", DEG(swing->floor_rad), 0.08},
        {"wide from, deg", DEG(swing->wide_rad), 0.25},
        {"off from, deg", DEG(swing->off_rad), 0.3},
        {"swings at least", COUNT(swing->swings_least), 5}};
    CHECK(settings);
}

TEST(rig_standard, observer_and_feed) {
    const wh_observer_config *observer = &wh_rig_standard.observer;
    const wh_compensation_config *feed = &wh_rig_standard.compensation;
    const setting settings[] = {
        {"stall torque, N m", observer->stall_Nm, 1.5},
        {"no-load speed, rpm", RPM(observer->no_load_radps), 600},
        {"angle's gain, sensor 1", observer->angle_gain[0], 1.2},
        {"sensor 2", observer->angle_gain[1], 0.6},
        {"speed's gain, sensor 1", observer->speed_gain[0], 0.65},
        {"sensor 2", observer->speed_gain[1], 1.3},
        {"torque's gain, sensor 1, kg m^2", observer->torque_gain_kgm2[0], 0.009},
        {"sensor 2", observer->torque_gain_kgm2[1], 0.002},
        {"torque at most, N m", observer->torque_most_Nm, 0.5},
        {"trusted within, rad", observer->trusted_rad, 0.3},
        {"trusted after pulses", COUNT(observer->trusted_pulses), 3},
        {"lost beyond, rad", observer->lost_rad, 2},
        {"slowest, rpm", RPM(observer->slowest_radps), 40},
        {"fastest, rpm", RPM(observer->fastest_radps), 930},
        {"silence, us", COUNT(observer->silence_ticks), 1500000},
        {"lead of what is fed, us", COUNT(feed->lead_ticks), 3000},
        {"fading in, s", feed->fade_s, 0.5},
        {"fed at most, of full voltage", feed->most, 0.3}};
    CHECK(settings);
}

/* standard.c: the controller's data for the rig of eccentric.whirl. */
#include "datasheet.h"
#include "rig.h"

#define RPM(x) (WH_R(x) * WH_RIG_RADPS_PER_RPM)

/* The control loop. From voltage to mean speed, the rotor is a first-order lag of about 0.24 s with a gain of 60 rad/s
 * for 24 V. The measured speed of the last turn is some 0.15 s old. The zero of the PI controller cancels the lag. The
 * gain gives a crossover frequency of 2.5 rad/s and 65 degrees of phase margin (docs/dev/rig.md). */
const wh_rig_config wh_rig_standard = {
    .run = {.step_s = WH_R(0.002),
            .drive = {.proportional_V_per_radps = WH_R(0.24),
                      .integral_V_per_rad = WH_R(1.0),
                      .ramp_radps2 = RPM(60.0),
                      .gentle_radps = RPM(150.0)},
            .rated_V = WH_RIG_RATED_V,
            .no_load_radps = WH_RIG_NO_LOAD_RADPS,
            .drag_V = WH_R(0.8),
            .spin_up_V = WH_R(9.6),
            .spin_up_V_per_s = WH_R(2.0),
            .take_over_radps = RPM(150.0),
            .spin_up_max_s = WH_R(8.0),
            .ramp_max_s = WH_R(25.0),
            .settle_band_radps = RPM(0.5),
            .settle_s = WH_R(2.5),
            .settle_max_s = WH_R(20.0),
            .short_max_s = WH_R(2.0),
            .record_band_radps = RPM(2.0),
            .slow_radps = RPM(200.0)},
    .guard = {.target_min_radps = WH_RIG_TARGET_MIN_RPM * WH_RIG_RADPS_PER_RPM,
              .target_min_compensated_radps =
                  WH_RIG_TARGET_MIN_COMPENSATED_RPM * WH_RIG_RADPS_PER_RPM,
              .target_max_radps = WH_RIG_TARGET_MAX_RPM * WH_RIG_RADPS_PER_RPM,
              .limit_radps = WH_RIG_SHAFT_LIMIT_RPM * WH_RIG_RADPS_PER_RPM,
              .ripple = WH_R(0.1),
              .over = WH_R(0.03),
              .climb = WH_R(0.02),
              .climb_start_radps2 = RPM(500.0),
              .climb_behind_radps2 = RPM(70.0),
              .behind_radps = RPM(8.0),
              .climb_there_radps2 = RPM(15.0),
              .fall_radps = WH_R(15.5),
              .lost_max = 3,
              .doubt_max = 6,
              .rejected_max = 40,
              .silence_max_s = WH_R(0.5),
              .slow_silence_max_s = WH_R(2.0),
              .load_silence_max_s = WH_R(0.02), /* ten samples */
              .load_still_kgm = WH_R(0.1) * WH_RIG_UNBALANCE_KGM,
              .stuck_pulses = 3, /* three pulses span a whole turn, in which the load must change */
              .supply_min_V = WH_RIG_SUPPLY_LEAST * WH_RIG_RATED_V,
              .supply_max_V = WH_RIG_SUPPLY_MOST * WH_RIG_RATED_V,
              .rest_s = WH_R(1.5),
              .braked_radps =
                  WH_RIG_TWO_PI * WH_RIG_DAMPING_NMS / (WH_R(12.0) * WH_RIG_INERTIA_KGM2),
              .hand_radps = RPM(60.0)},
    .measure = {.rotor = {.unbalance_kgm = WH_RIG_UNBALANCE_KGM,
                          .gravity_mps2 = WH_RIG_GRAVITY_MPS2,
                          .damping_Nms = WH_RIG_DAMPING_NMS,
                          .damping_tolerance = WH_R(0.03),
                          .compensation_tolerance_rad = WH_R(0.04),
                          .inertia_kgm2 = WH_RIG_INERTIA_KGM2},
                .tare = {.samples = 250, .still_N = WH_R(0.05), .most_N = WH_R(0.25)},
                .result = {.mount_factor = WH_R(1.0),
                           .amplitude_floor = WH_R(0.0), /* uncalibrated */
                           .phase_floor_rad = WH_R(0.0),
                           .amplitude_off = WH_R(0.05),
                           .amplitude_wrong = WH_R(0.25),
                           .phase_off_rad = WH_R(5.0) / WH_RIG_DEG_PER_RAD,
                           .phase_wrong_rad = WH_R(20.0) / WH_RIG_DEG_PER_RAD,
                           .residual_large = WH_R(0.25),
                           .mean_off = WH_R(0.1),
                           .inertia_off = WH_R(0.5)},
                .record_s = WH_R(2.0),
                .record_turns = WH_R(7.5)},
    .observer = WH_OBSERVER_STANDARD,
    .compensation = WH_COMPENSATION_STANDARD,
    .compensation_when = WH_COMPENSATION_SLOW,
    .swing = {.most_rad = WH_R(8.0) / WH_RIG_DEG_PER_RAD,
              .jitter_s = WH_R(1e-4),
              .rough_rad = WH_R(8e-4),
              .floor_rad = WH_R(0.08) / WH_RIG_DEG_PER_RAD,
              .wide_rad = WH_R(0.25) / WH_RIG_DEG_PER_RAD,
              .off_rad = WH_R(0.3) / WH_RIG_DEG_PER_RAD,
              .swings_least = 5},
    .impossible_radps = WH_RIG_IMPOSSIBLE_RADPS,
    .armed_max_s = WH_R(60.0),
    .rest_max_s = WH_R(120.0),
    .tripped_max_s = WH_R(20.0),
    .host_loss_stops = true,
};

static wh_real volts_for(const wh_rig_motor *motor, wh_real torque_Nm, wh_real speed_radps) {
    return motor->rated_V * (torque_Nm / motor->stall_Nm + speed_radps / motor->no_load_radps);
}

static wh_real torque_at(const wh_rig_motor *motor, wh_real volts, wh_real speed_radps) {
    return motor->stall_Nm * (volts / motor->rated_V - speed_radps / motor->no_load_radps);
}

void wh_rig_motor_of(const wh_rig_config *config, wh_rig_motor *motor) {
    *motor = (wh_rig_motor){.stall_Nm = config->compensation.stall_Nm,
                            .no_load_radps = config->run.no_load_radps,
                            .rated_V = config->run.rated_V};
}

void wh_rig_bound_pulses(wh_rig_config *config) {
    const wh_run_config *run = &config->run;
    config->impossible_radps = run->no_load_radps * config->guard.supply_max_V / run->rated_V;
    config->observer.fastest_radps = config->impossible_radps;
}

void wh_rig_use_motor(wh_rig_config *config, const wh_rig_motor *motor) {
    wh_run_config *run = &config->run;
    wh_rotor_config *rotor = &config->measure.rotor;
    wh_observer_config *observer = &config->observer;
    wh_rig_motor before;
    wh_rig_motor_of(config, &before);
    const wh_real volts = motor->rated_V / before.rated_V;
    const wh_real per_torque = volts * before.stall_Nm / motor->stall_Nm;
    const wh_real damping_Nms = rotor->damping_Nms + motor->stall_Nm / motor->no_load_radps -
                                before.stall_Nm / before.no_load_radps;
    /* The loop keeps its crossover frequency, and its zero cancels this rotor's lag. */
    run->drive.proportional_V_per_radps *= per_torque;
    run->drive.integral_V_per_rad *= per_torque * damping_Nms / rotor->damping_Nms;
    run->drag_V *= per_torque;
    /* Between standstill and take_over_radps, the torque must not exceed that of the original motor. */
    const wh_real over = run->take_over_radps;
    const wh_real at_rest =
        volts_for(motor, torque_at(&before, run->spin_up_V, WH_R(0.0)), WH_R(0.0));
    const wh_real at_over = volts_for(motor, torque_at(&before, run->spin_up_V, over), over);
    run->spin_up_V = at_rest < at_over ? at_rest : at_over;
    run->spin_up_V_per_s *= volts;
    config->guard.supply_min_V *= volts;
    config->guard.supply_max_V *= volts;
    config->guard.braked_radps *= damping_Nms / rotor->damping_Nms;
    rotor->damping_Nms = damping_Nms;
    observer->per_drive = motor->stall_Nm / observer->stall_Nm;
    observer->per_radps =
        WH_R(1.0) / observer->no_load_radps - observer->per_drive / motor->no_load_radps;
    observer->no_load_radps = motor->no_load_radps;
    config->compensation.most *= before.stall_Nm / motor->stall_Nm;
    /* Below the speed `slowest`, the compensation might need a negative voltage. */
    const wh_real slowest = config->guard.target_min_compensated_radps * before.stall_Nm /
                            motor->stall_Nm * motor->no_load_radps / before.no_load_radps;
    if (slowest > config->guard.target_min_compensated_radps) {
        config->guard.target_min_compensated_radps = slowest;
    }
    config->compensation.stall_Nm = motor->stall_Nm;
    run->no_load_radps = motor->no_load_radps;
    run->rated_V = motor->rated_V;
    wh_rig_bound_pulses(config);
}

/* === on a carriage =========================================================================== */

/* Relative error of the configured inertia, which a measurement without gravity cannot correct. */
#define YIELDS_TOLERANCE WH_R(0.1)

void wh_carriage_mount(wh_rig_config *config, const wh_carriage *carriage) {
    wh_rotor_config *rotor = &config->measure.rotor;
    const wh_real moment = WH_RIG_UNBALANCE_AT_KGM(carriage->disc_m);
    const wh_real part = WH_R(1.0) / (WH_R(1.0) + carriage->ratio);
    rotor->unbalance_kgm = moment;
    rotor->inertia_kgm2 = WH_RIG_INERTIA_AT_KGM2(carriage->disc_m);
    rotor->gravity_mps2 = WH_R(0.0);
    rotor->yields_kgm2 = moment * moment / WH_RIG_ECCENTRIC_KG * carriage->ratio * part;
    rotor->yields_tolerance = YIELDS_TOLERANCE;
    config->measure.result.mount_factor = part;
    config->guard.load_still_kgm = WH_R(0.1) * moment * part;
    config->observer.scene = NULL;
    config->compensation_when = WH_COMPENSATION_NEVER;
}

wh_real wh_carriage_displacement_m(const wh_rig_config *config, const wh_carriage *carriage,
                                   const wh_measured *force) {
    /* mean of the squared speed, from the expected force */
    const wh_real square = force->expected_N / (config->measure.result.mount_factor *
                                                config->measure.rotor.unbalance_kgm);
    return square > WH_R(0.0)
               ? force->amplitude_N * carriage->ratio / (WH_RIG_ECCENTRIC_KG * square)
               : WH_R(0.0);
}

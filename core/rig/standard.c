/* standard.c: the rig of eccentric.whirl in its controller's numbers. */
#include "datasheet.h"
#include "rig.h"

#define RPM(x) (WH_R(x) * WH_RIG_RADPS_PER_RPM)

/* The loop: from voltage to mean speed the rotor is a lag of about 0.24 s with a gain of 60 rad/s for 24 V, and
 * a speed taken over the last turn is some 0.15 s old. The integral's zero cancels the lag, the gain
 * puts the crossover at 2.5 rad/s: 65 degrees of phase margin. docs/rig.md has the reasons. */
const wh_rig_config wh_rig_standard = {
    .run = {.step_s = WH_R(0.002),
            .drive = {.proportional_V_per_radps = WH_R(0.24),
                      .integral_V_per_rad = WH_R(1.0),
                      .ramp_radps2 = RPM(60.0),
                      .gentle_radps = RPM(150.0)},
            .rated_V = WH_RIG_RATED_V,
            .no_load_radps = RPM(600.0),
            .drag_V = WH_R(0.8),
            .spin_up_V = WH_R(9.6),
            .spin_up_V_per_s = WH_R(2.0),
            .take_over_radps = RPM(150.0),
            .spin_up_max_s = WH_R(8.0),
            .settle_band_radps = RPM(0.5),
            .settle_s = WH_R(2.5),
            .settle_max_s = WH_R(20.0),
            .short_max_s = WH_R(2.0),
            .record_band_radps = RPM(2.0),
            .slow_radps = RPM(200.0)},
    .guard = {.target_min_radps = WH_RIG_TARGET_MIN_RPM * WH_RIG_RADPS_PER_RPM,
              .target_min_fed_radps = WH_RIG_TARGET_MIN_FED_RPM * WH_RIG_RADPS_PER_RPM,
              .target_max_radps = WH_RIG_TARGET_MAX_RPM * WH_RIG_RADPS_PER_RPM,
              .limit_radps = WH_RIG_SHAFT_LIMIT_RPM * WH_RIG_RADPS_PER_RPM,
              .ripple = WH_R(0.1),
              .over = WH_R(0.05),
              .fall_radps = WH_R(15.5),
              .lost_max = 3,
              .rejected_max = 40,
              .silence_max_s = WH_R(0.5),
              .slow_silence_max_s = WH_R(2.0),
              .load_silence_max_s = WH_R(0.02), /* ten samples' periods */
              /* a tenth of what the masses' force moves it by */
              .load_still_kgm = WH_R(0.1) * WH_RIG_MASS_MOMENT_KGM,
              .stuck_pulses = 3, /* a whole turn from the first to the last */
              .supply_min_V = WH_R(0.45) * WH_RIG_RATED_V,
              .supply_max_V = WH_R(1.55) * WH_RIG_RATED_V,
              .rest_s = WH_R(1.5)},
    .measure = {.rotor = {.mass_moment_kgm = WH_RIG_MASS_MOMENT_KGM,
                          .gravity_mps2 = WH_RIG_GRAVITY_MPS2,
                          .damping_Nms = WH_RIG_DAMPING_NMS,
                          .damping_tolerance = WH_R(0.03),
                          .fed_tolerance_rad = WH_R(0.04),
                          .inertia_kgm2 = WH_RIG_INERTIA_KGM2},
                .tare = {.samples = 250, .still_N = WH_R(0.05), .most_N = WH_R(0.25)},
                .result = {.mount_factor = WH_R(1.0),
                           .amplitude_floor = WH_R(1e-4),
                           .phase_floor_rad = WH_R(0.01) / WH_RIG_DEG_PER_RAD,
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
    .feed = WH_FEED_STANDARD,
    .feeds = WH_FEED_SLOW,
    .impossible_radps = WH_RIG_IMPOSSIBLE_RPM * WH_RIG_RADPS_PER_RPM,
    .armed_max_s = WH_R(60.0),
    .rest_max_s = WH_R(120.0),
    .stop_brakes = true,
    .host_loss_stops = true,
};

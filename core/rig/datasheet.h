/* datasheet.h: the eccentric-mass rig's data for its controller. Weights and radii are those of the force formula in
 * Almesallmy (2006), I.3.2.1. tests/core/test_virtual_rig.c compares this file with core/models/eccentric.whirl. */
#ifndef WH_RIG_DATASHEET_H
#define WH_RIG_DATASHEET_H

#include "core/real.h"

/* Time stamps of the rig are counts of a 1 MHz timer, 32 bits, wrapping. */
#define WH_RIG_TICKS_PER_S 1000000U

/* Returns the seconds from a time stamp to a later one. Valid for less than 71.6 minutes. */
WH_SHARED wh_real wh_rig_since_s(uint32_t then_ticks, uint32_t now_ticks) {
    return (wh_real)(now_ticks - then_ticks) / (wh_real)WH_RIG_TICKS_PER_S;
}

/* Returns the seconds from one time stamp to another, negative if `to` is earlier. Valid below 35.8 minutes. */
WH_SHARED wh_real wh_rig_way_s(uint32_t from_ticks, uint32_t to_ticks) {
    return (wh_real)(int32_t)(to_ticks - from_ticks) / (wh_real)WH_RIG_TICKS_PER_S;
}

/* True if now_ticks is more than most_s after the earlier time stamp then_ticks. */
WH_SHARED bool wh_rig_is_over(uint32_t then_ticks, uint32_t now_ticks, wh_real most_s) {
    return wh_rig_since_s(then_ticks, now_ticks) > most_s;
}

#define WH_RIG_TWO_PI WH_R(6.283185307179586)
#define WH_RIG_RADPS_PER_RPM WH_R(0.10471975511965977)
#define WH_RIG_DEG_PER_RAD WH_R(57.29577951308232)
#define WH_RIG_LBF_PER_N WH_R(0.22480894309971047)

#define WH_RIG_SENSORS 2U /* slot sensors */

/* Mass of two sets. Each set is an arm of 0.152 lb and 7.25 in, and a disc of 0.15 lb. The disc's centre is 6.5 in from
 * the shaft. In a macro with the argument disc_m, that distance is disc_m metres. */
#define WH_RIG_ECCENTRIC_KG (WH_R(2.0) * (WH_R(0.152) + WH_R(0.15)) * WH_R(0.45359237))
#define WH_RIG_DISC_RADIUS_M (WH_R(6.5) * WH_R(0.0254))

/* Sum of mass times radius over both sets. */
#define WH_RIG_UNBALANCE_AT_KGM(disc_m) \
    (WH_R(2.0) * (WH_R(0.152) * (WH_R(3.625) * WH_R(0.0254)) + WH_R(0.15) * (disc_m)) * \
     WH_R(0.45359237))
#define WH_RIG_UNBALANCE_KGM WH_RIG_UNBALANCE_AT_KGM(WH_RIG_DISC_RADIUS_M)

/* Inertia of all rotating parts. Each set is a slender rod (the arm) and a point mass (the disc). Motor, couplings and
 * shafts are assumed to have 5e-4 kg m^2. */
#define WH_RIG_INERTIA_AT_KGM2(disc_m) \
    (WH_R(2.0) * \
         (WH_R(0.152) * (WH_R(17.520833333333332) * WH_R(0.0254) * WH_R(0.0254)) + \
          WH_R(0.15) * ((disc_m) * (disc_m))) * \
         WH_R(0.45359237) + \
     WH_R(5e-4))
#define WH_RIG_INERTIA_KGM2 WH_RIG_INERTIA_AT_KGM2(WH_RIG_DISC_RADIUS_M)

/* At rated voltage, the torque falls linearly from WH_RIG_STALL_NM at standstill to 0 at WH_RIG_NO_LOAD_RADPS. */
#define WH_RIG_STALL_NM WH_R(1.5)
#define WH_RIG_NO_LOAD_RADPS (WH_R(600.0) * WH_RIG_RADPS_PER_RPM)

/* Damping of the rotor: the loss of motor torque per rad/s, plus 0.001 N m s for the bearings. */
#define WH_RIG_DAMPING_NMS (WH_RIG_STALL_NM / WH_RIG_NO_LOAD_RADPS + WH_R(0.001))

#define WH_RIG_RATED_V WH_R(24.0)

#define WH_RIG_GRAVITY_MPS2 WH_R(9.80665)

/* Speed of the measurement (I.3.2.1): 5.5 turns a second. */
#define WH_RIG_NOMINAL_RPM WH_R(330.0)

/* Speed at the endurance limit of a 1/4 in shaft (416 rpm: docs/dev/rig.md), rounded down. The guard stops the rig
 * above it. Set-points stay a tenth below it, for the loop's overshoot. */
#define WH_RIG_SHAFT_LIMIT_RPM WH_R(400.0)
#define WH_RIG_TARGET_MAX_RPM WH_R(360.0)

/* Smallest set-point. The rotor needs 148 rpm at the bottom to pass the top against gravity (docs/dev/rig.md), and its
 * speed can dip below the set-point. */
#define WH_RIG_TARGET_MIN_RPM WH_R(170.0)

/* Smallest set-point with gravity compensation (gravity_compensation.h). */
#define WH_RIG_TARGET_MIN_COMPENSATED_RPM WH_R(100.0)

/* Range of the motor's supply, as multiples of the rated voltage. */
#define WH_RIG_SUPPLY_LEAST WH_R(0.45)
#define WH_RIG_SUPPLY_MOST WH_R(1.55)

/* Speed without load at the highest supply voltage. A pulse that would need a higher speed is rejected. */
#define WH_RIG_IMPOSSIBLE_RADPS (WH_RIG_SUPPLY_MOST * WH_RIG_NO_LOAD_RADPS)

#endif

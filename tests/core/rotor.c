/* rotor.c: an imitated rotor of the rig, for tests of its controller. */
#include "rotor.h"

#include "core/angle.h"
#include "core/rig/datasheet.h"
#include "core/rig/polar.h"
#include "draw.h"

#define SLICE_TICKS 500U
#define SLICE_S WH_R(500e-6)
#define LEAD_RAD (WH_R(1.0) / WH_RIG_DEG_PER_RAD)

rotor_kind rotor_nominal(void) {
    return (rotor_kind){.weight_Nm = WH_RIG_UNBALANCE_KGM * WH_RIG_GRAVITY_MPS2,
                        .inertia_kgm2 = WH_RIG_INERTIA_KGM2,
                        .stall_Nm = WH_RIG_STALL_NM,
                        .no_load_radps = WH_RIG_NO_LOAD_RADPS,
                        .drag_Nms = WH_R(0.001),
                        .pulse_rad = {-LEAD_RAD, WH_R(0.25) * WH_RIG_TWO_PI - LEAD_RAD}};
}

static wh_real within_half_a_turn(wh_real rad) {
    return rad < WH_R(-0.5) * WH_RIG_TWO_PI  ? rad + WH_RIG_TWO_PI
           : rad > WH_R(0.5) * WH_RIG_TWO_PI ? rad - WH_RIG_TWO_PI
                                             : rad;
}

wh_real rotor_ahead_rad(const rotor_state *rotor, wh_real than_rad) {
    return within_half_a_turn(within_half_a_turn(rotor->angle_rad - than_rad));
}

static wh_real acceleration(const rotor_kind *kind, wh_real drive, wh_real angle_rad,
                            wh_real speed_radps) {
    const wh_wave wave = wh_wave_of(angle_rad);
    wh_real torque = kind->stall_Nm * (drive - speed_radps / kind->no_load_radps);
    if (kind->freewheels && torque < WH_R(0.0)) {
        torque = WH_R(0.0);
    }
    torque -= kind->drag_Nms * speed_radps + kind->weight_Nm * wave.sine;
    torque -= speed_radps > WH_R(0.0)   ? kind->friction_Nm
              : speed_radps < WH_R(0.0) ? -kind->friction_Nm
                                        : WH_R(0.0);
    return torque / kind->inertia_kgm2;
}

wh_real rotor_acceleration_radps2(const rotor_kind *kind, const rotor_state *rotor, wh_real drive) {
    return acceleration(kind, drive, rotor->angle_rad, rotor->speed_radps);
}

/* Finds the sensor that the rotor passes between two angles that are less than half a turn apart. */
static void watch(const rotor_kind *kind, rotor_state *rotor, wh_real from_rad, wh_real way_rad) {
    for (unsigned sensor = 0; sensor < 2; sensor++) {
        const bool back = way_rad < WH_R(0.0) && kind->slot_rad > WH_R(0.0);
        const wh_real on = kind->pulse_rad[sensor] - from_rad;
        wh_real to = back ? -(on + kind->slot_rad) : on;
        while (to < WH_R(0.0)) {
            to += WH_RIG_TWO_PI;
        }
        while (to >= WH_RIG_TWO_PI) {
            to -= WH_RIG_TWO_PI;
        }
        const wh_real way = back ? -way_rad : way_rad;
        if (!(to < way) || rotor->pulses == ROTOR_PULSES) {
            continue;
        }
        const wh_real late_s =
            kind->jitter_s * draw_whole(&rotor->seed, -1000, 1000) / WH_R(1000.0);
        const wh_real ticks =
            (wh_real)SLICE_TICKS * (to / way) + late_s * (wh_real)WH_RIG_TICKS_PER_S;
        rotor->pulse_sensor[rotor->pulses] = sensor;
        rotor->pulse_ticks[rotor->pulses++] = rotor->ticks + (uint32_t)(int32_t)ticks;
    }
}

void rotor_turn(const rotor_kind *kind, rotor_state *rotor, wh_real drive, uint32_t ticks) {
    const wh_real h = SLICE_S;
    rotor->pulses = 0;
    for (uint32_t passed = 0; passed < ticks; passed += SLICE_TICKS) {
        const wh_real q = rotor->angle_rad;
        const wh_real w = rotor->speed_radps;
        const wh_real a1 = acceleration(kind, drive, q, w);
        const wh_real a2 = acceleration(kind, drive, q + h / 2 * w, w + h / 2 * a1);
        const wh_real a3 = acceleration(kind, drive, q + h / 2 * (w + h / 2 * a1), w + h / 2 * a2);
        const wh_real a4 = acceleration(kind, drive, q + h * (w + h / 2 * a2), w + h * a3);
        const wh_real way = h * (w + h / 6 * (a1 + a2 + a3));
        rotor->speed_radps = w + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
        watch(kind, rotor, q, way);
        rotor->angle_rad += way;
        if (rotor->angle_rad >= WH_RIG_TWO_PI) {
            rotor->angle_rad -= WH_RIG_TWO_PI;
        } else if (rotor->angle_rad < WH_R(0.0)) {
            rotor->angle_rad += WH_RIG_TWO_PI;
        }
        rotor->ticks += SLICE_TICKS;
    }
}

/* rotor.h: an imitated rotor for tests of the rig's controller, integrated with smaller steps than the core's scene. It
 * has arms in a vertical plane, a motor's torque line, friction, a braking or freewheeling stage and two slot sensors.
 * All its numbers may differ from the controller's settings. */
#ifndef TESTS_CORE_ROTOR_H
#define TESTS_CORE_ROTOR_H

#include <stdbool.h>
#include <stdint.h>

#include "core/real.h"

typedef struct rotor_kind {
    wh_real weight_Nm; /* S g */
    wh_real inertia_kgm2;
    wh_real stall_Nm;      /* at rated voltage */
    wh_real no_load_radps; /* at rated voltage */
    wh_real drag_Nms;
    wh_real friction_Nm; /* Coulomb friction, against the motion */
    /* True if a voltage below the back-EMF makes no torque. Otherwise it brakes. */
    bool freewheels;
    wh_real pulse_rad[2]; /* the true angles of the sensors */
    /* Hysteresis of the slot when the rotor turns backwards. 0: no pulses backwards. */
    wh_real slot_rad;
    wh_real jitter_s; /* jitter of the pulses, uniform, early or late by up to this time */
} rotor_kind;

#define ROTOR_PULSES 4U

typedef struct rotor_state {
    uint32_t ticks;    /* present time, 1 MHz, wrapping */
    wh_real angle_rad; /* 0 ... 2 pi */
    wh_real speed_radps;
    uint64_t seed;   /* seed of the pulses' jitter */
    unsigned pulses; /* number of pulses during the last rotor_turn() */
    unsigned pulse_sensor[ROTOR_PULSES];
    uint32_t pulse_ticks[ROTOR_PULSES];
} rotor_state;

/* Returns the rig of core/models/eccentric.whirl. Its pulses come one degree before the sensors. */
rotor_kind rotor_nominal(void);

/* Advances by `ticks`, a multiple of 500. `drive` is the voltage divided by the rated one. */
void rotor_turn(const rotor_kind *kind, rotor_state *rotor, wh_real drive, uint32_t ticks);

wh_real rotor_acceleration_radps2(const rotor_kind *kind, const rotor_state *rotor, wh_real drive);

/* Returns angle_rad - than_rad, wrapped to -pi ... pi. */
wh_real rotor_ahead_rad(const rotor_state *rotor, wh_real than_rad);

#endif

/* rotor.h: a made-up rotor of the rig for tests of its controller, integrated more finely than the core's scene and
 * without it: arms in a vertical plane, a motor's torque line, friction, a stage that brakes or freewheels, two slot
 * sensors. All of it can be another than the controller believes. */
#ifndef TESTS_CORE_ROTOR_H
#define TESTS_CORE_ROTOR_H

#include <stdbool.h>
#include <stdint.h>

#include "core/real.h"

typedef struct rotor_kind {
    wh_real weight_Nm; /* S g */
    wh_real inertia_kgm2;
    wh_real stall_Nm;      /* at rated voltage */
    wh_real no_load_radps; /* likewise */
    wh_real drag_Nms;
    wh_real friction_Nm; /* Coulomb's, against the motion */
    bool freewheels;     /* less voltage than the motor's own makes no torque, not a braking one */
    wh_real mark_rad[2]; /* where the sensors really fire */
    wh_real slot_rad;    /* and going back so much further on; 0: not at all */
    wh_real jitter_s;    /* either way, evenly */
} rotor_kind;

#define ROTOR_MARKS 4U

typedef struct rotor_state {
    uint32_t ticks;    /* now, 1 MHz, wrapping */
    wh_real angle_rad; /* 0 ... 2 pi */
    wh_real speed_radps;
    uint64_t seed;  /* of the marks' jitter */
    unsigned marks; /* of the last rotor_turn(), in order of time */
    unsigned mark_sensor[ROTOR_MARKS];
    uint32_t mark_ticks[ROTOR_MARKS];
} rotor_state;

/* The rig of core/models/eccentric.whirl, its marks a degree early. */
rotor_kind rotor_nominal(void);

/* Go on for so many ticks, a multiple of 500, with the voltage `drive`, a fraction of the rated one. */
void rotor_turn(const rotor_kind *kind, rotor_state *rotor, wh_real drive, uint32_t ticks);

/* Its acceleration now, at this voltage. */
wh_real rotor_acceleration_radps2(const rotor_kind *kind, const rotor_state *rotor, wh_real drive);

/* angle_rad less `than_rad`, -pi ... pi. */
wh_real rotor_ahead_rad(const rotor_state *rotor, wh_real than_rad);

#endif

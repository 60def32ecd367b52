/* on_plant.h: the rig's controller on the virtual rig, operated as in boards/programs/rig.c; single precision only. */
#ifndef TESTS_CORE_ON_PLANT_H
#define TESTS_CORE_ON_PLANT_H

#include "core/rig/datasheet.h"
#include "core/rig/rig.h"

#if !WH_DOUBLE

#include "boards/programs/obey.h"
#include "boards/programs/trip_memory.h"
#include "hal/clock.h"
#include "hal/loadcell.h"
#include "hal/motor.h"
#include "hal/slots.h"
#include "hal/stop.h"
#include "hal/virtual/virtual_rig.h"
#include "hal/watchdog.h"

#define CONTROL_TICKS UINT32_C(2000) /* an AVR's unsigned has 16 bits */
#define RPM WH_RIG_RADPS_PER_RPM

typedef struct on_plant {
    wh_rig rig;
    wh_rig_config config;
    wh_rig_command command;
    bool drives; /* the last command drove the motor (obey.h) */
    wh_trip_record memory;
    float fastest_radps; /* the largest true speed of the rotor, not the measured one */
    float noise_N;       /* standard deviation of the noise added to each sample */
} on_plant;

void plant_control(on_plant *on);

/* Posts an order, steps, and returns the answer. */
wh_refusal plant_order(on_plant *on, wh_rig_event event, float value);

/* Resets and restarts the processor; the rotor keeps moving. */
void plant_reset(on_plant *on, hal_reset cause);

/* Starts hardware and controller. Afterwards plant_start() leaves the rig idle at rest; the next functions leave it
 * armed, or at the tare of a run. */
void plant_start(on_plant *on);
void plant_arm(on_plant *on);
void plant_begin(on_plant *on, float target_rpm);

/* Runs until `phase` begins, until the rig is idle, or until it is tripped and at rest. An endless run is stopped. */
void plant_go_on_until(on_plant *on, wh_rig_phase phase);
void plant_go_on_to_the_end(on_plant *on);

bool plant_is_done(const on_plant *on);

/* Checks that the rotor is at rest, hanging, with the motor off. */
void plant_check_stopped(const on_plant *on);

#endif

#endif

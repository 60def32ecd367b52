/* on_plant.h: the rig's controller on the virtual rig, operated as boards/programs/rig.c does it; single precision only. */
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
    bool drives; /* obey.h */
    trip_memory memory;
    float fastest_radps; /* of the rotor itself, not as measured */
    float noise_N;       /* standard deviation of what is added to each sample */
} on_plant;

/* One control step. */
void plant_control(on_plant *on);

/* Post an order, step, and return the answer. */
wh_refusal plant_order(on_plant *on, wh_rig_event event, float value);

/* The processor is reset while the rig is as it is, and starts again. */
void plant_reset(on_plant *on, hal_reset cause);

/* The hardware and its controller, idle at rest; armed; or at the tare of a run. */
void plant_start(on_plant *on);
void plant_arm(on_plant *on);
void plant_begin(on_plant *on, float target_rpm);

/* Control until `phase` is reached or the run is over: nothing is left to wait for, idle, or tripped and at rest. A run
 * that does neither is stopped. */
void plant_go_on_until(on_plant *on, wh_rig_phase phase);
void plant_go_on_to_the_end(on_plant *on);

/* The run is through, and nothing tripped. */
bool plant_is_done(const on_plant *on);

/* The rotor ends at rest, hanging, with the motor off. */
void plant_check_stopped(const on_plant *on);

#endif

#endif

/* virtual_rig.h: hardware simulated by the core's own model of the rig (scene rig_fixed), in single precision.
 *
 * This file adds the slot sensors, the load cell's converter, the timer and the watchdog. Slot edges can lie between
 * two steps of the model. Time advances in whole steps, and only in hal_virtual_rig_advance(), so the same calls give
 * the same bits on every machine.
 *
 * The hal_ functions (clock.h, motor.h, ...) act on hal_virtual_rig_instance(). The functions below work on any number
 * of rigs in the caller's memory. */
#ifndef HAL_VIRTUAL_RIG_H
#define HAL_VIRTUAL_RIG_H

#include <stdbool.h>
#include <stdint.h>

#include "core/scene.h"
#include "hal/loadcell.h"
#include "hal/motor.h"
#include "hal/reset.h"
#include "hal/slots.h"

WH_C_BEGIN

#define HAL_VIRTUAL_PULSES 16U
#define HAL_VIRTUAL_SAMPLES 8U
#define HAL_VIRTUAL_PULSE_TICKS 150U /* length of the monostable's pulse */

#define HAL_VIRTUAL_RATED_V 24.0f /* motor voltage at the model's duty 1 */
/* no-load speed at HAL_VIRTUAL_RATED_V: parameter no_load of the model */
#define HAL_VIRTUAL_NO_LOAD_RADPS 62.831853f

/* Time from a start or reset to the timer's first wrap. The time is short, so that tests reach the wrap. */
#define HAL_VIRTUAL_WRAP_AFTER_S 5U

/* Injected faults, which may be set at any time. hal_virtual_rig_start() clears them. */
typedef struct hal_virtual_faults {
    unsigned lose_pulses[2]; /* number of pulses that each sensor still loses */
    bool dead_sensor[2];     /* the sensor gives no pulse */
    unsigned lose_samples;   /* number of load samples still to lose */
    bool stuck_load_cell;    /* the load cell repeats its last count */
    float stuck; /* fraction of the supply voltage that is applied for any command; 0: no fault */
    bool deaf;   /* if stuck > 0, the stage drives even if `enabled` is false */
    bool freewheels; /* the stage cannot brake */
} hal_virtual_faults;

typedef struct hal_virtual_rig {
    const wh_scene *scene;
    wh_state state;
    uint64_t memory[WH_STATE_WORDS(1, 1, 1)];
    wh_status status;      /* WH_E_DIVERGED: the model diverged, and the rotor stands still */
    uint32_t ticks;        /* time now, 1 MHz, wrapping */
    uint32_t step_ticks;   /* duration of one step of the model */
    float volts;           /* commanded voltage */
    bool enabled;          /* the drive is on */
    float supply_V;        /* may be set at any time */
    uint32_t sample_ticks; /* time of the next load sample */
    int32_t last_raw;
    hal_slot_edge pulse[HAL_VIRTUAL_PULSES];
    unsigned pulses;
    uint32_t overruns; /* number of pulses lost because pulse[] was full */
    hal_load_sample sample[HAL_VIRTUAL_SAMPLES];
    unsigned samples;
    bool watched; /* the watchdog is armed */
    bool cut;     /* the watchdog has cut the motor */
    uint32_t watchdog_ticks;
    uint32_t kicked_ticks;
    bool stop_cuts;    /* a press of stop has cut the drive; hal_motor_off() ends the cut */
    bool stop_pressed; /* may be set at any time */
    hal_reset cause;   /* why the processor started */
    bool in_reset;     /* was reset, and hal_clock_start() has not been called yet */
    uint8_t remembered[HAL_REMEMBER_BYTES];
    unsigned remembers; /* number of remembered bytes */
    hal_virtual_faults faults;
} hal_virtual_rig;

/* Puts the rig at its scene's start, with motor and watchdog off. The scene must have one angle, one input and 1 to 8
 * outputs. Returns false if the scene is unfit or cannot start. The step must be whole microseconds (unchecked). */
bool hal_virtual_rig_start(hal_virtual_rig *rig, const wh_scene *scene);

/* Advances the time by whole steps of the model until it is `ticks` or later. */
void hal_virtual_rig_advance(hal_virtual_rig *rig, uint32_t ticks);

/* Resets the processor; `cause` must not be HAL_RESET_POWER_ON. Drive and watchdog go off, pulses and samples are lost,
 * and the timer restarts. The rotor keeps turning, and the next hal_clock_start() does not stop it. */
void hal_virtual_rig_reset(hal_virtual_rig *rig, hal_reset cause);

/* Enables the drive stage and sets its voltage. */
void hal_virtual_rig_drive(hal_virtual_rig *rig, float volts);
/* The next three functions act like hal_motor_off(), hal_slots_take() for leading edges, and hal_loadcell_take(). */
void hal_virtual_rig_motor_off(hal_virtual_rig *rig, hal_motor_off_way way);
bool hal_virtual_rig_take_pulse(hal_virtual_rig *rig, hal_slot_edge *leading);
bool hal_virtual_rig_take_sample(hal_virtual_rig *rig, hal_load_sample *sample);

/* For tests: the true speed of the arms. */
float hal_virtual_rig_speed_radps(const hal_virtual_rig *rig);

hal_virtual_rig *hal_virtual_rig_instance(void);

/* The model of hal_virtual_rig_instance(). */
extern const wh_scene rig_fixed;

WH_C_END

#endif

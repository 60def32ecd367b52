/* obey.h: commands to the motor, and the stop input, for the rig's programs and their tests. */
#ifndef PROGRAMS_OBEY_H
#define PROGRAMS_OBEY_H

#include <stdbool.h>

#include "core/rig/rig.h"
#include "hal/motor.h"
#include "hal/stop.h"

/* 0: the program never drives the motor, and has no call of hal_motor_start(). */
#ifndef RIG_DRIVES
#define RIG_DRIVES 1
#endif

/* True if stop is pressed, or if a press shorter than a control step has cut the drive. */
static inline bool stop_was_pressed(bool watchdog_has_cut) {
    return hal_stop_pressed() || (!watchdog_has_cut && (hal_motor_status() & HAL_MOTOR_CUT) != 0);
}

_Static_assert((int)HAL_STOP_EITHER == (int)WH_STOP_BY_EITHER &&
                   (int)HAL_STOP_INPUT == (int)WH_STOP_BY_INPUT &&
                   (int)HAL_STOP_DRIVE == (int)WH_STOP_BY_DRIVE,
               "the HAL and the station number the sources of a stop alike");

/* Returns the source of the stop. It is known only as long as stop is pressed. */
static inline wh_stop_by stop_was_by(void) {
    return hal_stop_pressed() ? (wh_stop_by)hal_stop_source_now() : WH_STOP_BY_EITHER;
}

/* Passes a command to the motor. *drives is true if the last command drove the motor, and false before the first one.
 * Only the first of successive driving commands starts the motor: a motor stopped by an interrupt stays off. */
static inline void obey(const wh_rig_command *command, bool *drives) {
    if (command->way != WH_MOTOR_DRIVES) {
        hal_motor_off(command->way == WH_MOTOR_BRAKES ? HAL_MOTOR_BRAKE : HAL_MOTOR_COAST);
        *drives = false;
        return;
    }
#if RIG_DRIVES
    if (!*drives) {
        *drives = true;
        (void)hal_motor_start(); /* if the start fails, the next step's inputs show why */
    }
    hal_motor_set_voltage(command->volts);
#else
    hal_motor_off(HAL_MOTOR_COAST);
#endif
}

#endif

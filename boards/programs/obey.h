/* obey.h: what the rig's controller commands goes to the motor, and whether that was stopped. A part of a program, or of a test
 * in its place. */
#ifndef PROGRAMS_OBEY_H
#define PROGRAMS_OBEY_H

#include <stdbool.h>

#include "core/rig/rig.h"
#include "hal/motor.h"
#include "hal/stop.h"

/* 0: a program that never drives; nothing here calls hal_motor_start(). */
#ifndef RIG_DRIVES
#define RIG_DRIVES 1
#endif

/* Stop is pressed; or it was, for less than a control step, and has cut the drive by itself. */
static inline bool stop_was_pressed(bool watchdog_has_cut) {
    return hal_stop_pressed() || (!watchdog_has_cut && (hal_motor_status() & HAL_MOTOR_CUT) != 0);
}

_Static_assert((int)HAL_STOP_EITHER == (int)WH_STOP_BY_EITHER &&
                   (int)HAL_STOP_INPUT == (int)WH_STOP_BY_INPUT &&
                   (int)HAL_STOP_DRIVE == (int)WH_STOP_BY_DRIVE,
               "one list of who asks for stop");

/* Whose it was, when stop_was_pressed(): of a short one that is over only the cut is left. */
static inline wh_stop_by stop_was_by(void) {
    return hal_stop_pressed() ? (wh_stop_by)hal_stop_source_now() : WH_STOP_BY_EITHER;
}

/* *drives: so was the command before; false at first. The motor is started where a command to drive begins, and not again: what
 * an interrupt has switched off, or stop has kept from starting, does not come by itself before the rig was off, too. */
static inline void obey(const wh_rig_command *command, bool *drives) {
    if (command->way != WH_MOTOR_DRIVES) {
        hal_motor_off(command->way == WH_MOTOR_BRAKES ? HAL_MOTOR_BRAKE : HAL_MOTOR_COAST);
        *drives = false;
        return;
    }
#if RIG_DRIVES
    if (!*drives) {
        *drives = true;
        (void)hal_motor_start(); /* why not is among the inputs of the next step */
    }
    hal_motor_set_voltage(command->volts);
#else
    hal_motor_off(HAL_MOTOR_COAST);
#endif
}

#endif

/* motor.h: the motor's drive stage: a chopper (PWM) that applies a part of the supply voltage, in one direction only,
 * and an enable line. The enable line is a second way to switch off: without it no chopper setting drives the motor. */
#ifndef HAL_MOTOR_H
#define HAL_MOTOR_H

#include <stdint.h>

#include "core/linkage.h"

WH_C_BEGIN

typedef enum hal_motor_off_way {
    HAL_MOTOR_COAST, /* enable off: no torque, the rotor turns freely */
    HAL_MOTOR_BRAKE  /* enable on, at 0 V: brakes if the stage can short-circuit the motor */
} hal_motor_off_way;

/* Status bits of the drive stage: */
enum {
    /* The hardware has cut the drive or prevented a start, because of stop or a fault of the drive stage. The drive
     * stays off until the next hal_motor_off(). */
    HAL_MOTOR_CUT = 1,
    /* the stage cannot drive, because stop is pressed or the stage has a fault */
    HAL_MOTOR_FAULT = 2,
    HAL_MOTOR_NO_SUPPLY = 4 /* the measured supply voltage is 0: the stage cannot drive */
};

/* If the motor is off, sets 0 V and switches the enable on, even if the status is HAL_MOTOR_NO_SUPPLY. Returns
 * hal_motor_status(). Do not call this function in an interrupt. */
unsigned hal_motor_start(void);

/* Drives the motor with a mean voltage, clamped to 0 ... hal_motor_supply_V() (NaN: 0), until the next call. No effect
 * if the motor is not started, or if the watchdog has cut the drive. If an interrupt has switched the motor off, it
 * stays off, even if the interrupted control step then sets a voltage. */
void hal_motor_set_voltage(float volts);

/* Stops driving at once, until the next start. Works at any time, also in an interrupt or a fault handler. */
void hal_motor_off(hal_motor_off_way way);

/* Returns the status bits; 0: no fault, or the stage is not monitored. Do not call it in an interrupt. */
unsigned hal_motor_status(void);

/* Returns the supply voltage, measured at most 10 ms ago. If the converter is at the end of its range, returns
 * HAL_MOTOR_SUPPLY_BEYOND, which is above every limit that a setting can have. Do not call it in an interrupt. */
#define HAL_MOTOR_SUPPLY_BEYOND __builtin_inff()
float hal_motor_supply_V(void);

/* Default of the setting supply_most: 37.2 V (core/rig/standard.c), or less if the board cannot measure so much. */
#define HAL_MOTOR_SUPPLY_MOST_mV UINT32_C(37200)
float hal_motor_supply_most_V(void);

/* True if the end of a converter's range, end_mV, is at least 2 % above most_mV. The boards assert this. The error of
 * their converters is smaller: 5 of 4096 counts, or 2 of 1024 counts. */
#define HAL_MOTOR_SUPPLY_IS_SEEN(most_mV, end_mV) ((end_mV) >= (most_mV) + (most_mV) / 50U)

WH_C_END

#endif

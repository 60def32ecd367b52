/* motor.h: the motor's drive stage: a chopper (PWM) that gives a part of the supply voltage, in one direction only, and
 * an enable line. The enable line is the second way to switch off: without it the motor has no drive at any chopper
 * setting. */
#ifndef HAL_MOTOR_H
#define HAL_MOTOR_H

#include <stdint.h>

#include "core/linkage.h"

WH_C_BEGIN

typedef enum hal_motor_off_way {
    HAL_MOTOR_COAST, /* switch the enable off: no torque, the rotor turns freely */
    HAL_MOTOR_BRAKE  /* keep the enable on at 0 V: a drive stage that can short the motor brakes */
} hal_motor_off_way;

/* Status bits of the drive stage: */
enum {
    /* The hardware has cut the drive or prevented a start, because stop was pressed or the drive stage has a fault. The
     * drive stays off until the next hal_motor_off(). */
    HAL_MOTOR_CUT = 1,
    /* stop is pressed, or a fault of the drive stage: the stage cannot drive */
    HAL_MOTOR_FAULT = 2,
    HAL_MOTOR_NO_SUPPLY = 4 /* the measured supply voltage is 0: the drive stage cannot drive */
};

/* Switch the enable on, at 0 V. After this call the stage can drive. Returns hal_motor_status(): 0, or the reason why
 * the stage cannot drive. If the reason is only a missing supply, the enable is on; otherwise the drive is off. The
 * call has no effect if the motor is already started. Do not call it from an interrupt. */
unsigned hal_motor_start(void);

/* Drive the motor with a mean voltage of 0 to hal_motor_supply_V(). Other values are clamped; NaN gives 0. The voltage
 * stays until the next call. The call has no effect on a motor that is not started, or after the watchdog has cut the
 * drive. If an interrupt has switched the motor off, it stays off, even if the interrupted control step then sets a
 * voltage. */
void hal_motor_set_voltage(float volts);

/* Stop driving at once, until the next start. May be called at any time, also from an interrupt or a fault handler, and
 * before hal_clock_start(). */
void hal_motor_off(hal_motor_off_way way);

/* Returns the status bits; 0: no fault, or the stage is not monitored. Do not call this function or
 * hal_motor_supply_V() from an interrupt. */
unsigned hal_motor_status(void);

/* Returns the supply voltage, measured at most 10 ms ago. HAL_MOTOR_SUPPLY_BEYOND means that the converter is at the
 * end of its range, so the true voltage is unknown. This value is above every limit that a setting can have. */
#define HAL_MOTOR_SUPPLY_BEYOND __builtin_inff()
float hal_motor_supply_V(void);

/* The default of the setting supply_most, the highest allowed supply voltage: above it the controller trips. The rig's
 * own limit is 37.2 V (core/rig/standard.c); a board with a shorter measuring range has a lower default. */
#define HAL_MOTOR_SUPPLY_MOST_mV UINT32_C(37200)
float hal_motor_supply_most_V(void);

/* True if a converter whose range ends at end_mV can measure up to most_mV with a margin of 2 %. The margin is at least
 * ten times the error of the converters here (5 counts of 12 bits, or 2 counts of 10 bits). Each board asserts this
 * condition. */
#define HAL_MOTOR_SUPPLY_IS_SEEN(most_mV, end_mV) ((end_mV) >= (most_mV) + (most_mV) / 50U)

WH_C_END

#endif

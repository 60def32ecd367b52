/* motor.h: the motor's drive stage: a chopper (PWM) of the supply, in one direction only, and an enable.
 * The enable is the second way to switch off: without it the motor has no drive at any chopper setting. */
#ifndef HAL_MOTOR_H
#define HAL_MOTOR_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum hal_motor_off_way {
    HAL_MOTOR_COAST, /* the enable goes off: no torque, the rotor turns freely */
    HAL_MOTOR_BRAKE  /* the enable stays on at 0 V: a drive stage that can short the motor brakes */
} hal_motor_off_way;

/* Status bits of the drive stage: */
enum {
    /* the hardware has cut the drive or prevented a start, because stop was pressed or the drive stage has a fault. The
     * drive stays off until the next hal_motor_off() */
    HAL_MOTOR_CUT = 1,
    HAL_MOTOR_FAULT = 2,    /* stop is pressed, or the drive stage has a fault: it cannot drive */
    HAL_MOTOR_NO_SUPPLY = 4 /* no supply voltage measured: the stage does not drive */
};

/* Switch the enable on, at 0 V: from now on the stage can drive. Returns hal_motor_status(): 0, or the reason why
 * the stage cannot drive. The drive is then off, unless only the supply is missing. No effect if the motor is
 * already started. Not from an interrupt. */
unsigned hal_motor_start(void);

/* Drive the motor with a mean voltage of 0 to hal_motor_supply_V(). Other values are clamped; NaN gives 0. The voltage
 * stays until the next call. No effect on a motor that is not started, or after the watchdog has cut the drive. A motor
 * that an interrupt has switched off stays off, even if the interrupted control step then sets a voltage. */
void hal_motor_set_voltage(float volts);

/* Stop driving at once, until the next start. May be called at any time, also from an interrupt or a fault handler, and
 * before hal_clock_start(). */
void hal_motor_off(hal_motor_off_way way);

/* The status bits; 0: no fault, or no monitoring. Neither this function nor hal_motor_supply_V() may be called from
 * an interrupt. */
unsigned hal_motor_status(void);

/* The supply as last measured, V, at most 10 ms ago. HAL_MOTOR_SUPPLY_BEYOND means that the converter is at its end, so
 * the true value is unknown. This value is above every limit that a setting can have. */
#define HAL_MOTOR_SUPPLY_BEYOND __builtin_inff()
float hal_motor_supply_V(void);

/* The default of the setting supply_most: above this supply the controller trips. The rig's own limit is 37.2 V
 * (core/rig/standard.c); a board with a shorter measuring range has a lower default. */
#define HAL_MOTOR_SUPPLY_MOST_mV UINT32_C(37200)
float hal_motor_supply_most_V(void);

/* True if a converter whose range ends at end_mV can measure this limit with a margin of 2 %. That is ten times the
 * errors of the converters here (5 counts of 12 bits, 2 of 10). Each board asserts it. */
#define HAL_MOTOR_SUPPLY_IS_SEEN(most_mV, end_mV) ((end_mV) >= (most_mV) + (most_mV) / 50U)

#ifdef __cplusplus
}
#endif

#endif

/* motor.h: the motor's drive stage. One direction only: a chopper (PWM) of the supply, and an enable.
 *
 * The enable is the second way to switch off: without it the motor has no drive at any chopper setting. */
#ifndef HAL_MOTOR_H
#define HAL_MOTOR_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum hal_motor_off_way {
    HAL_MOTOR_COAST, /* the enable goes off: no torque, the rotor turns freely */
    HAL_MOTOR_BRAKE /* the enable stays on, at 0 V: a drive stage that can short the motor brakes it */
} hal_motor_off_way;

/* Status bits of the drive stage: */
enum {
    HAL_MOTOR_CUT =
        1, /* stop or its own fault has cut it or prevented a start, without software: off until the
            * next hal_motor_off() */
    HAL_MOTOR_FAULT = 2,    /* stop is pressed, or the drive stage has a fault: it cannot drive */
    HAL_MOTOR_NO_SUPPLY = 4 /* no supply measured: it does not drive */
};

/* The enable on, at 0 V: from now on it can drive. Returns hal_motor_status(): 0, or the reason why it cannot. It is
 * then off, unless only the supply is missing. No effect if it is started already. Not from an interrupt. */
unsigned hal_motor_start(void);

/* Drive the motor with a mean voltage of 0 to hal_motor_supply_V(). Values outside are clamped, NaN to 0. In effect
 * until the next call. No effect on a motor that is not started, or after the watchdog has cut the drive. A motor that
 * an interrupt has switched off stays off, even if the interrupted control step sets a voltage. */
void hal_motor_set_voltage(float volts);

/* Stop driving at once, until the next start. May be called at any time, also from an interrupt or a fault handler, and
 * before hal_clock_start(). */
void hal_motor_off(hal_motor_off_way way);

/* The status bits; 0: no fault, or no monitoring. Not from an interrupt, and neither the supply. */
unsigned hal_motor_status(void);

/* The supply, V, as last measured: at most 10 ms ago. HAL_MOTOR_SUPPLY_BEYOND at the end of its converter, where its
 * value is unknown; that is above every limit, for all settings. */
#define HAL_MOTOR_SUPPLY_BEYOND __builtin_inff()
float hal_motor_supply_V(void);

/* A higher supply trips: the default of the setting supply_most. The rig's own limit is 37.2 V (core/rig/standard.c); a
 * board with a shorter measuring range has a lower one. */
#define HAL_MOTOR_SUPPLY_MOST_mV UINT32_C(37200)
float hal_motor_supply_most_V(void);

/* True if a measurement that ends at end_mV covers this limit, with a margin of 2 %: ten times the errors of the
 * converters here (5 counts of 12 bits, 2 of 10). Each board asserts it. */
#define HAL_MOTOR_SUPPLY_IS_SEEN(most_mV, end_mV) ((end_mV) >= (most_mV) + (most_mV) / 50U)

#ifdef __cplusplus
}
#endif

#endif

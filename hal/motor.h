/* motor.h: the motor's drive stage. One direction only: a chopper (PWM) of the supply, and an enable.
 *
 * The enable is the second way off: with it off nothing drives the motor, whatever the chopper does. */
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

/* What the drive stage says, bits: */
enum {
    HAL_MOTOR_CUT =
        1, /* it was cut, or kept from starting, beside the software, by stop or by its own fault: off until the next hal_motor_off() */
    HAL_MOTOR_FAULT = 2, /* stop is pressed, or the drive stage has a fault: it cannot be driven */
    HAL_MOTOR_NO_SUPPLY = 4 /* none is measured: it is not driven */
};

/* The enable on, at 0 V: from now on it can be driven. Returns hal_motor_status(): 0, or why it cannot; then it is off,
 * but where only the supply is missing. Of one that is started already nothing changes. Not from an interrupt. */
unsigned hal_motor_start(void);

/* Drive the motor with a mean voltage of 0 to hal_motor_supply_V(). What lies outside is clamped, NaN to 0. In effect from
 * this call on, until the next. Has no effect on a motor that is not started, nor once the watchdog has cut the drive: what
 * an interrupt has switched off stays off, whatever the control step that it came into has to say. */
void hal_motor_set_voltage(float volts);

/* Stop driving at once, until the next start. May be called at any time, also from an interrupt or a fault's handler, and
 * before hal_clock_start(). */
void hal_motor_off(hal_motor_off_way way);

/* These bits together; 0: nothing is wrong, or nobody looks. Not from an interrupt, nor the supply. */
unsigned hal_motor_status(void);

/* The supply, V, as last measured: 10 ms ago at most; HAL_MOTOR_SUPPLY_BEYOND at the end of its converter, where nothing tells how
 * high it is. That is above every limit, whatever the settings. */
#define HAL_MOTOR_SUPPLY_BEYOND __builtin_inff()
float hal_motor_supply_V(void);

/* A higher supply trips: what the setting supply_most is by default. The rig's own limit is 37.2 V (core/rig/standard.c); a board
 * whose measurement ends too soon has a lower one. */
#define HAL_MOTOR_SUPPLY_MOST_mV UINT32_C(37200)
float hal_motor_supply_most_V(void);

/* True if a measurement that ends at end_mV shows this limit, with a margin of 2 %: ten times the errors of the converters here (5
 * counts of 12 bits, 2 of 10). Each board asserts it. */
#define HAL_MOTOR_SUPPLY_IS_SEEN(most_mV, end_mV) ((end_mV) >= (most_mV) + (most_mV) / 50U)

#ifdef __cplusplus
}
#endif

#endif

/* motor.h: the motor's drive stage. One direction only: a chopper (PWM) of the supply, and an enable.
 *
 * The enable is the second way off: with it off nothing drives the motor, whatever the chopper does. */
#ifndef HAL_MOTOR_H
#define HAL_MOTOR_H

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

/* The supply, V, as last measured: 10 ms ago at most. */
float hal_motor_supply_V(void);

#ifdef __cplusplus
}
#endif

#endif

/* motor.h: the motor's drive stage. One direction only; zero duty shorts the motor, which brakes it. */
#ifndef HAL_MOTOR_H
#define HAL_MOTOR_H

#ifdef __cplusplus
extern "C" {
#endif

/* Drive the motor with `duty`, 0 (braked) to 1 (full supply). Values outside, and NaN, are clamped
 * to the range (NaN to 0). Has no effect once the watchdog has cut the drive. */
void hal_motor_set_duty(float duty);

/* The mean voltage over the motor, 0 to the supply; clamped to that, NaN to 0. */
void hal_motor_set_voltage(float volts);

typedef enum hal_motor_off_way {
    HAL_MOTOR_COAST, /* the drive's enable goes off; the motor turns freely */
    HAL_MOTOR_BRAKE  /* it stays on, with zero duty */
} hal_motor_off_way;

void hal_motor_off(hal_motor_off_way way);

/* The supply, as it was measured last. */
float hal_motor_supply_V(void);

#ifdef __cplusplus
}
#endif

#endif

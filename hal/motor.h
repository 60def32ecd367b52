/* motor.h: the motor's drive stage. One direction only; zero duty shorts the motor, which brakes it. */
#ifndef HAL_MOTOR_H
#define HAL_MOTOR_H

#ifdef __cplusplus
extern "C" {
#endif

/* Drive the motor with `duty`, 0 (braked) to 1 (full supply). Values outside, and NaN, are clamped
 * to the range (NaN to 0). Has no effect once the watchdog has cut the drive. */
void hal_motor_set_duty(float duty);

#ifdef __cplusplus
}
#endif

#endif

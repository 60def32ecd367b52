/* drive.h: speed drive: a ramp for the set-point and a PI controller with anti-windup. */
#ifndef WH_RIG_DRIVE_H
#define WH_RIG_DRIVE_H

#include "core/real.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct wh_drive_config {
    wh_real proportional_per_radps; /* duty per rad/s of error */
    wh_real integral_per_rad;       /* duty per second, per rad/s of error */
    wh_real ramp_radps2;            /* fastest change of the set-point, > 0 */
    wh_real duty_min;               /* what the motor stage can do */
    wh_real duty_max;
} wh_drive_config;

typedef struct wh_drive {
    wh_real target_radps;   /* where the ramp goes */
    wh_real setpoint_radps; /* where it is */
    wh_real integral;       /* the integral part, duty; always within duty_min ... duty_max */
} wh_drive;

#define wh_drive_start WH_NAME(wh_drive_start)
#define wh_drive_step WH_NAME(wh_drive_step)
#define wh_drive_at_target WH_NAME(wh_drive_at_target)

/* Take over at the present speed and duty without a bump: the set-point starts at the speed, the
 * integral at the duty. */
void wh_drive_start(const wh_drive_config *config, wh_drive *drive, wh_real speed_radps,
                    wh_real duty);

/* One control step of step_s seconds: move the set-point towards the target, return the new duty.
 *
 * The integral stands still while the duty is at a limit and the error would push it further
 * (conditional integration: Astrom & Hagglund, Advanced PID Control, section 3.5). */
wh_real wh_drive_step(const wh_drive_config *config, wh_drive *drive, wh_real speed_radps,
                      wh_real step_s);

/* True when the set-point has arrived. */
bool wh_drive_at_target(const wh_drive *drive);

#ifdef __cplusplus
}
#endif

#endif

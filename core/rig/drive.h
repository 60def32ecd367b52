/* drive.h: speed control: a ramp for the set-point and a PI controller with anti-windup. The output is a voltage, so
 * the supply voltage limits the output and does not change the loop's gain. */
#ifndef WH_RIG_DRIVE_H
#define WH_RIG_DRIVE_H

#include "core/real.h"

WH_C_BEGIN

typedef struct wh_drive_config {
    wh_real proportional_V_per_radps;
    wh_real integral_V_per_rad;
    wh_real ramp_radps2; /* fastest change of the set-point, > 0 */
    /* Below this speed the ramp is a quarter as steep: otherwise gravity could stop the rotor at the top. */
    wh_real gentle_radps;
} wh_drive_config;

typedef struct wh_drive {
    wh_real target_radps;   /* final set-point of the ramp */
    wh_real setpoint_radps; /* present set-point */
    wh_real integral_V;     /* integral part of the voltage, from 0 to the supply */
} wh_drive;

/* Sets target and set-point to the present speed. The integral becomes `volts`, so that the voltage does not jump. */
void wh_drive_start(wh_drive *drive, wh_real speed_radps, wh_real volts);

/* Does one control step of step_s seconds: moves the set-point towards the target. Returns the new voltage, which is
 * from 0 to most_V. most_V must be >= 0.
 *
 * The integral stays constant while the voltage is at a limit and the error would drive it further (conditional
 * integration: Astrom & Hagglund, Advanced PID Control, section 3.5). */
wh_real wh_drive_step(const wh_drive_config *config, wh_drive *drive, wh_real speed_radps,
                      wh_real most_V, wh_real step_s);

bool wh_drive_at_target(const wh_drive *drive);

WH_C_END

#endif

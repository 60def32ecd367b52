/* drive.c: speed control: a ramp for the set-point and a PI controller with anti-windup. */
#include "drive.h"

static wh_real clamp(wh_real value, wh_real low, wh_real high) {
    return value < low ? low : value > high ? high : value;
}

void wh_drive_start(wh_drive *drive, wh_real speed_radps, wh_real volts) {
    drive->target_radps = speed_radps;
    drive->setpoint_radps = speed_radps;
    drive->integral_V = volts;
}

wh_real wh_drive_step(const wh_drive_config *config, wh_drive *drive, wh_real speed_radps,
                      wh_real most_V, wh_real step_s) {
    wh_real most = config->ramp_radps2 * step_s;
    if (drive->setpoint_radps < config->gentle_radps) {
        most *= WH_R(0.25);
    }
    const wh_real way = drive->target_radps - drive->setpoint_radps;
    /* The ramp ends exactly at the target, because wh_drive_at_target() tests for equality. */
    if (WH_ABS(way) <= most) {
        drive->setpoint_radps = drive->target_radps;
    } else {
        drive->setpoint_radps += way < WH_R(0.0) ? -most : most;
    }

    const wh_real error = drive->setpoint_radps - speed_radps;
    const wh_real wanted = config->proportional_V_per_radps * error + drive->integral_V;
    const wh_real volts = clamp(wanted, WH_R(0.0), most_V);
    const bool pushes_further =
        wanted > volts ? error > WH_R(0.0) : wanted < volts && error < WH_R(0.0);
    const wh_real before = drive->integral_V;
    const wh_real after =
        pushes_further ? before : before + config->integral_V_per_rad * error * step_s;
    drive->integral_V = clamp(after, WH_R(0.0), most_V);
    return volts;
}

bool wh_drive_at_target(const wh_drive *drive) {
    return !(WH_ABS(drive->target_radps - drive->setpoint_radps) > WH_R(0.0));
}

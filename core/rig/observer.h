/* observer.h: the rotor's angle and speed at any time, from a generated scene that runs beside the rig.
 *
 * Two slot pulses per turn measure the rotor's position; between pulses the model predicts it from gravity, motor and
 * inertia. The model, a scene (eccentric.whirl, rig_fixed), gets the same drive as the rig. At each pulse the
 * innovation corrects the scene's angle, its speed, and a disturbance torque that is added to the drive (for the
 * bearings' torque, or an error of the supply). This is a Luenberger observer. Its gains are constants if the unit of
 * time is the duration of a turn (Luenberger, IEEE Transactions on Automatic Control 16 (1971) 596).
 *
 *     every control step, in this order:
 *         wh_observer_step(..., now_ticks, drive)      the drive since the last control step
 *         wh_observer_pulse(..., sensor, ticks)        for each slot pulse since then
 *         if (observer.valid) wh_observer_phase(..., now_ticks + lead) is the arms' angle at that time */
#ifndef WH_RIG_OBSERVER_H
#define WH_RIG_OBSERVER_H

#include "core/scene.h"
#include "datasheet.h"

WH_C_BEGIN

typedef struct wh_observer_config {
    /* The scene's input is the motor's voltage as a fraction of the rated voltage. */
    const wh_scene *scene;
    wh_real stall_Nm;      /* standstill torque of the scene's motor at an input of 1, > 0 */
    wh_real no_load_radps; /* motor speed without load at the rated voltage, > 0 */
    /* Factors of the drive and the speed in the scene's input. The factors give the scene's motor the rig's torque. */
    wh_real per_drive;
    wh_real per_radps;
    /* The motor stage cannot brake: a voltage below the back-EMF makes no torque. */
    bool freewheels;
    wh_real pulse_rad[WH_RIG_SENSORS]; /* angle of the arms at a pulse of each sensor, rad */
    /* Corrections at a pulse of each sensor. e is the innovation (rad), n the speed in turns per second: */
    wh_real angle_gain[WH_RIG_SENSORS];       /* angle += gain e */
    wh_real speed_gain[WH_RIG_SENSORS];       /* speed += gain e n */
    wh_real torque_gain_kgm2[WH_RIG_SENSORS]; /* torque += gain e n^2, N m */
    wh_real torque_most_Nm;                   /* largest magnitude of the torque */
    /* The observer is valid only if the last trusted_pulses innovations are at most trusted_rad. */
    wh_real trusted_rad;
    uint32_t trusted_pulses;
    wh_real lost_rad;      /* an innovation above lost_rad restarts the observer; lost_rad < pi */
    wh_real slowest_radps; /* lowest speed at which the observer starts, > 0 */
    wh_real fastest_radps;
    uint32_t silence_ticks; /* after this time without a pulse the state is unknown */
} wh_observer_config;

typedef struct wh_observer {
    bool valid;       /* angle and speed are reliable */
    bool runs;        /* the observer has started: the scene follows the rotor */
    bool had_pulse;   /* there was a pulse since the restart */
    wh_status status; /* result of wh_observer_start(); unless WH_OK, the observer is never valid */
    wh_state state;   /* the scene's state at the time `ticks` */
    uint64_t memory[(WH_MEMORY_BYTES(1, 2, 0) + 7U) / 8U];
    uint32_t ticks;
    uint32_t step_ticks;     /* duration of one step of the scene */
    wh_real torque_Nm;       /* disturbance: torque that the scene does not model */
    wh_real innovation_rad;  /* the rotor's angle minus the scene's, at the last pulse */
    wh_real since_pulse_rad; /* angle turned since the last pulse */
    uint32_t pulse_ticks;    /* time of the last pulse, if had_pulse */
    unsigned pulse_sensor;
    uint32_t good_pulses; /* number of successive pulses with a trusted innovation */
} wh_observer;

/* The configuration for the rig of eccentric.whirl; the caller fills in the scene and pulse_rad. The gains were chosen
 * for 80 to 400 rpm and for rotors with 0.5 to 6 times the scene's inertia, 0.7 to 1.3 times its gravity and up to 0.2
 * N m of friction. At a steady speed, each turn multiplies the errors of angle, speed and torque by about this factor:
 * 0.72 at 80 rpm, 0.65 at 100, 0.32 at 170, 0.59 at 330 and 0.64 at 400 (spectral radius). */
#define WH_OBSERVER_STANDARD \
    { \
        .stall_Nm = WH_RIG_STALL_NM, .no_load_radps = WH_RIG_NO_LOAD_RADPS, \
        .per_drive = WH_R(1.0), .angle_gain = {WH_R(1.2), WH_R(0.6)}, \
        .speed_gain = {WH_R(0.65), WH_R(1.3)}, .torque_gain_kgm2 = {WH_R(0.009), WH_R(0.002)}, \
        .torque_most_Nm = WH_R(0.5), .trusted_rad = WH_R(0.3), .trusted_pulses = 3, \
        .lost_rad = WH_R(2.0), .slowest_radps = WH_R(40.0) * WH_RIG_RADPS_PER_RPM, \
        .fastest_radps = WH_RIG_IMPOSSIBLE_RADPS, .silence_ticks = 3U * (WH_RIG_TICKS_PER_S / 2U), \
    }
extern const wh_observer_config wh_observer_standard;

/* Begin with an unknown state. Do not move *observer in memory after this call. The scene must have one angle of second
 * order, one input, no contacts, no ledger, no compensated sums, and a step of whole microseconds; other scenes give
 * WH_E_ARGUMENT. Other results are those of wh_scene_start(). */
wh_status wh_observer_start(const wh_observer_config *config, wh_observer *observer,
                            uint32_t now_ticks);

/* Advance to now_ticks, in whole steps of the scene. `drive` is the motor's drive since the last call, as a fraction of
 * the rated voltage. The observer restarts if WH_OBSERVER_STEPS_MOST steps or more are due. */
#define WH_OBSERVER_STEPS_MOST 8U
/* Maximum number of steps in one call. After a delay, several calls catch up. */
#define WH_OBSERVER_STEPS_AT_ONCE 2U
void wh_observer_step(const wh_observer_config *config, wh_observer *observer, uint32_t now_ticks,
                      wh_real drive);

/* Process a pulse: the rotor passed sensor 0 or 1 forwards at `ticks`, at most two control steps ago. */
void wh_observer_pulse(const wh_observer_config *config, wh_observer *observer, unsigned sensor,
                       uint32_t ticks);

/* Restart the observer, for example if pulses were wrong. */
void wh_observer_forget(wh_observer *observer);

/* Return the angle at `ticks`, as a phase (angle.h) or in rad from -pi to pi. Valid if observer->valid. `ticks` may be
 * some milliseconds after the last step: extrapolation is linear, and 1 ms at 60 rad/s^2 gives 3e-5 rad of error. */
wh_phase wh_observer_phase(const wh_observer *observer, uint32_t ticks);
wh_real wh_observer_angle_rad(const wh_observer *observer, uint32_t ticks);

wh_real wh_observer_speed_radps(const wh_observer *observer);

/* Returns the drive at which this motor makes no torque: the argument for wh_observer_step() while the motor coasts. */
wh_real wh_observer_coasting(const wh_observer_config *config, const wh_observer *observer);

WH_C_END

#endif

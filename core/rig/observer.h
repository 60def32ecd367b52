/* observer.h: the rotor's angle and speed at any time, from a generated scene that runs beside the rig.
 *
 * Two slot marks a turn say where the rotor was; between them gravity, motor and inertia say where it is. The
 * scene (eccentric.whirl, rig_fixed) is given the drive that the rig is given, and at each mark what it is off by,
 * the innovation, corrects its angle, its speed, and a torque that the scene does not know (bearings, a supply
 * that is off), which is added to the drive: a Luenberger observer with fixed gains, of the speed and of the torque
 * in units of a turn's time (Luenberger, IEEE Transactions on Automatic Control 16 (1971) 596). No physics is here.
 *
 *     every control step, in this order:
 *         wh_observer_step(..., now_ticks, drive)      the drive since the step before
 *         wh_observer_mark(..., sensor, ticks)         for each slot pulse taken since
 *         if (observer.valid) wh_observer_phase(..., now_ticks + lead) is where the arms will be */
#ifndef WH_RIG_OBSERVER_H
#define WH_RIG_OBSERVER_H

#include "core/scene.h"
#include "datasheet.h"

#ifdef __cplusplus
extern "C" {
#endif

#define WH_OBSERVER_SENSORS 2U

typedef struct wh_observer_config {
    const wh_scene
        *scene;       /* one angle, its rate, one input: the motor's voltage over the rated one */
    wh_real stall_Nm; /* the scene's motor torque at standstill and input 1, > 0 */
    /* the motor's speed without load at the rated voltage, > 0 */
    wh_real no_load_radps;
    /* the scene's input that gives this motor's torque: per_drive * drive + per_radps * speed */
    wh_real per_drive;
    wh_real per_radps;
    /* the motor's stage: less than the motor's own voltage makes no torque, not a braking one */
    bool freewheels;
    wh_real mark_rad[WH_OBSERVER_SENSORS]; /* angle of the arms at a pulse of each sensor */
    /* at a mark of each sensor, of its innovation e (rad), n = speed in turns a second: */
    wh_real angle_gain[WH_OBSERVER_SENSORS];       /* angle += gain e */
    wh_real speed_gain[WH_OBSERVER_SENSORS];       /* speed += gain e n */
    wh_real torque_gain_kgm2[WH_OBSERVER_SENSORS]; /* torque += gain e n^2, N m */
    wh_real torque_most_Nm;                        /* it stays within this, either way */
    wh_real trusted_rad;    /* innovations up to this, at so many marks running, */
    uint32_t trusted_marks; /* make it valid; one beyond, and it is not */
    wh_real lost_rad;       /* beyond this it sets out anew; < pi */
    wh_real slowest_radps;  /* speeds at which it sets out, > 0 */
    wh_real fastest_radps;
    uint32_t silence_ticks; /* so long without a mark, and nothing is known any more */
} wh_observer_config;

typedef struct wh_observer {
    bool valid;       /* angle and speed can be relied on */
    bool runs;        /* has set out: the scene goes with the rotor */
    bool marked;      /* there was a mark since it began anew */
    wh_status status; /* of wh_observer_start(); when not WH_OK nothing is ever valid */
    wh_state state;   /* stands at `ticks` */
    uint64_t memory[(WH_MEMORY_BYTES(1, 2, 0) + 7U) / 8U];
    uint32_t ticks;
    uint32_t step_ticks; /* of the scene */
    wh_real torque_Nm;   /* the disturbance: what turns the rotor on and the scene does not know */
    wh_real innovation_rad; /* at the last mark: how far ahead of the scene the rotor was */
    wh_real since_mark_rad; /* turned since the last mark */
    uint32_t mark_ticks;    /* it, when marked */
    unsigned mark_sensor;
    uint32_t good_marks; /* running */
} wh_observer;

/* For the rig of eccentric.whirl; the scene and mark_rad are the caller's to fill in. The gains were drawn for rotors of
 * half to six times the inertia, 30 % more or less gravity and 0.2 N m of friction between 80 and 400 rpm. What the
 * errors of angle, speed and torque are multiplied with in a turn has then, at a steady speed, a spectral radius of 0.72
 * at 80 rpm, 0.65 at 100, 0.32 at 170, 0.59 at 330 and 0.64 at 400: over the top gravity drives errors apart, the more
 * the slower. Sensor 1's mark ends three quarters of a turn, over the top,
 * sensor 2's the other. */
#define WH_OBSERVER_STANDARD \
    { \
        .stall_Nm = WH_RIG_STALL_NM, .no_load_radps = WH_RIG_NO_LOAD_RADPS, \
        .per_drive = WH_R(1.0), .angle_gain = {WH_R(1.2), WH_R(0.6)}, \
        .speed_gain = {WH_R(0.65), WH_R(1.3)}, .torque_gain_kgm2 = {WH_R(0.009), WH_R(0.002)}, \
        .torque_most_Nm = WH_R(0.5), .trusted_rad = WH_R(0.3), .trusted_marks = 3, \
        .lost_rad = WH_R(2.0), .slowest_radps = WH_R(40.0) * WH_RIG_RADPS_PER_RPM, \
        .fastest_radps = WH_RIG_IMPOSSIBLE_RADPS, .silence_ticks = 3U * (WH_RIG_TICKS_PER_S / 2U), \
    }
#define wh_observer_standard WH_NAME(wh_observer_standard)
extern const wh_observer_config wh_observer_standard;

#define wh_observer_start WH_NAME(wh_observer_start)
#define wh_observer_step WH_NAME(wh_observer_step)
#define wh_observer_mark WH_NAME(wh_observer_mark)
#define wh_observer_forget WH_NAME(wh_observer_forget)
#define wh_observer_phase WH_NAME(wh_observer_phase)
#define wh_observer_angle_rad WH_NAME(wh_observer_angle_rad)
#define wh_observer_speed_radps WH_NAME(wh_observer_speed_radps)
#define wh_observer_coasting WH_NAME(wh_observer_coasting)

/* Begin: nothing is known. The observer must not be moved afterwards. Returns WH_OK; what wh_scene_start() returns; or
 * WH_E_ARGUMENT for a scene of another kind (not one angle of second order, one input, no contacts, not compensated,
 * a whole number of microseconds a step). */
wh_status wh_observer_start(const wh_observer_config *config, wh_observer *observer,
                            uint32_t now_ticks);

/* Go on to now_ticks (less than a step of the scene is left to wh_observer_phase()), with the drive, a fraction of
 * the rated voltage, that the motor has had since the last call. A call that comes more than
 * WH_OBSERVER_STEPS_MOST steps of the scene late begins anew. */
#define WH_OBSERVER_STEPS_MOST 8U
#define WH_OBSERVER_STEPS_AT_ONCE 2U /* of the scene in one call: what is late comes up by and by */
void wh_observer_step(const wh_observer_config *config, wh_observer *observer, uint32_t now_ticks,
                      wh_real drive);

/* Sensor 0 or 1 was passed at `ticks`, a control step or two ago at most; the rotor turns forwards. */
void wh_observer_mark(const wh_observer_config *config, wh_observer *observer, unsigned sensor,
                      uint32_t ticks);

/* Begin anew: for who knows that marks are wrong. */
void wh_observer_forget(wh_observer *observer);

/* The angle at a time some milliseconds about the last step, on the straight line: within a ms and an acceleration of
 * 60 rad/s^2 by 3e-5 rad. As a phase (angle.h), and -pi ... pi. What it says is worth something while valid. */
wh_phase wh_observer_phase(const wh_observer *observer, uint32_t ticks);
wh_real wh_observer_angle_rad(const wh_observer *observer, uint32_t ticks);

/* Speed at the last step. */
wh_real wh_observer_speed_radps(const wh_observer *observer);

/* The drive at which this motor makes no torque: what to tell wh_observer_step() while the motor's stage freewheels. */
wh_real wh_observer_coasting(const wh_observer_config *config, const wh_observer *observer);

#ifdef __cplusplus
}
#endif

#endif

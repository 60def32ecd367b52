/* phases.h: a test run of the eccentric-mass rig, as in Almesallmy (2006), I.3.2.1 and I.3.3. Its phases: tare, spin
 * up, hold 330 rpm, record load cell (500 samples per second) and slot pulses for 2 s, slow down, stop. */
#ifndef WH_RIG_PHASES_H
#define WH_RIG_PHASES_H

#include "drive.h"
#include "guard.h"
#include "measure.h"

WH_C_BEGIN

/* The phases of a run, in order: X(name, words) */
#define WH_PHASE_ROWS(X) \
    X(WH_PHASE_NONE, "none")           /* no run: motor off */ \
    X(WH_PHASE_TARE, "tare")           /* motor off; the load cell is read at rest */ \
    X(WH_PHASE_SPIN_UP, "spin up")     /* open loop, until the pulses show a speed */ \
    X(WH_PHASE_RAMP, "ramp")           /* closed loop; the set-point ramps */ \
    X(WH_PHASE_SETTLE, "settle")       /* closed loop; the speed must stay near the target */ \
    X(WH_PHASE_RECORD, "record")       /* closed loop; the load is measured */ \
    X(WH_PHASE_RAMP_DOWN, "ramp down") /* closed loop; the rotor slows; there is a result */ \
    X(WH_PHASE_OFF, "coast")           /* motor off, until the rotor rests */

#define WH_PHASE_NAME(name, words) name,
typedef enum wh_rig_phase { WH_PHASE_ROWS(WH_PHASE_NAME) WH_PHASES } wh_rig_phase;
#undef WH_PHASE_NAME

typedef struct wh_run_config {
    wh_real step_s;
    wh_drive_config drive;
    wh_real rated_V;
    wh_real no_load_radps;   /* motor speed without load at rated_V */
    wh_real drag_V;          /* approximate voltage that overcomes friction */
    wh_real spin_up_V;       /* first voltage of the spin-up */
    wh_real spin_up_V_per_s; /* rise of the spin-up voltage, up to rated_V */
    wh_real take_over_radps; /* speed at which the control loop closes */
    wh_real spin_up_max_s;
    wh_real ramp_max_s;
    /* half-width of the band about the target while the run settles */
    wh_real settle_band_radps;
    wh_real settle_s;          /* least time within the band before the record */
    wh_real settle_max_s;      /* longest time to settle */
    wh_real short_max_s;       /* longest time with too low a supply */
    wh_real record_band_radps; /* half-width of the band for each turn of the record */
    wh_real slow_radps; /* the ramp down ends at this speed, or at the target if that is lower */
} wh_run_config;

/* While the rig settles, the mean of this many whole-turn speeds is compared with the set-point. Two sensors give two
 * new speeds per turn. At 330 rpm with 120 us of jitter, single turns scatter by 0.31 rpm, the mean by 0.11 rpm. */
#define WH_RUN_TURNS 4U

typedef struct wh_run {
    wh_rig_phase phase;
    uint32_t since_ticks;  /* start of the phase */
    uint32_t band_ticks;   /* time at which the speed entered the band */
    uint32_t closed_ticks; /* time at which the loop was closed */
    uint32_t ample_ticks;  /* last time at which the supply sufficed for the set-point */
    wh_real target_radps;
    wh_real volts;     /* commanded mean voltage of the motor */
    wh_real off_radps; /* upper bound on the speed while the motor is off */
    /* Upper bound on the speed at the last pulse. left_radps can exceed a falling set-point. */
    wh_real left_radps;
    uint32_t tare_pulses[WH_RIG_SENSORS];
    uint32_t turns;                   /* turns counted while the run settles and records */
    uint32_t turns_taken;             /* speed.taken when the last of these turns was counted */
    wh_real turn_radps[WH_RUN_TURNS]; /* speeds of the last turns */
    wh_real mean_radps;               /* mean of turn_radps */
    wh_drive drive;
} wh_run;

typedef struct wh_run_scene {
    const wh_run_config *config;
    const wh_measure_config *measuring;
    const wh_guard_config *guarding;
    wh_guard *guard;
    wh_pulses *pulses;
    wh_measure *measure;
    wh_real supply_V;
    bool compensated; /* gravity is compensated: lower set-points are allowed */
    bool busy;        /* this step has a pulse, so a record neither begins nor ends in it */
    uint32_t now_ticks;
} wh_run_scene;

/* Begin a run to target_radps > 0 in WH_PHASE_TARE. */
void wh_run_start(wh_run *run, wh_real target_radps, uint32_t now_ticks);

/* Change the target, in any phase before WH_PHASE_RAMP_DOWN. A record in progress is dropped. */
void wh_run_set(wh_run *run, wh_real target_radps, uint32_t now_ticks);

/* Switch the motor off, from any phase. speed_radps is an upper bound on the speed. */
void wh_run_off(wh_run *run, wh_real speed_radps, uint32_t now_ticks);

/* Does one control step, and trips if a phase fails. Returns true if the step has completed the record's result. */
bool wh_run_step(wh_run *run, const wh_run_scene *scene);

WH_INLINE bool wh_run_drives(const wh_run *run) {
    return run->phase >= WH_PHASE_SPIN_UP && run->phase <= WH_PHASE_RAMP_DOWN;
}
WH_INLINE bool wh_run_is_closed(const wh_run *run) {
    return run->phase >= WH_PHASE_RAMP && run->phase <= WH_PHASE_RAMP_DOWN;
}

/* The rotor still accelerates for this time after the loop has closed. */
#define WH_RUN_START_S WH_R(1.5)

typedef struct wh_setpoint {
    wh_real setpoint_radps;
    wh_real limit_radps; /* upper bound on the rotor's speed */
    bool jumps;          /* the speeds of successive turns differ widely */
} wh_setpoint;
wh_setpoint wh_run_setpoint(const wh_run_config *config, const wh_run *run, uint32_t ticks);

wh_real wh_run_needs_V(const wh_run_config *config, wh_real speed_radps);

/* Returns the phase in words, perhaps in flash: print the words by wh_text_add(). WH_PHASES gives "brake". */
const char *wh_phase_text(wh_rig_phase phase);

/* === bounds on the speed and time of the next slot pulse, from the drive's set-point ========= */

/* Sets run->left_radps, pulses->bound_radps, pulses->climb_radps2 and pulses->window for the pulse captured at `ticks`.
 * Call this before wh_pulses_take(), with the motor on or off. `open` means that the motor neither drives nor brakes.
 * If `open`, bound_radps is higher (WH_GUARD_LIGHTER). */
void wh_pulse_window_set(const wh_guard_config *guard, const wh_run_config *running, wh_run *run,
                         wh_pulses *pulses, bool open, uint32_t ticks);

/* Updates pulses->slow, and lowers run->off_radps to the speed since the last pulse. Call this before wh_pulses_take(),
 * with the motor off. If one sensor fires twice in succession, the function calls wh_pulses_forget(). */
void wh_pulse_window_off(wh_run *run, wh_pulses *pulses, bool brakes, unsigned sensor,
                         uint32_t ticks);

WH_C_END

#endif

/* phases.h: a test run of the eccentric-mass rig, phase by phase.
 *
 * Repeats Almesallmy (2006), I.3.2.1 and I.3.3: tare, spin up, hold 330 rpm, record the load cell for 2 s at 500
 * samples a second together with the slot pulses, slow down, stop. */
#ifndef WH_RIG_PHASES_H
#define WH_RIG_PHASES_H

#include "drive.h"
#include "guard.h"
#include "measure.h"

#ifdef __cplusplus
extern "C" {
#endif

/* X(name, words) */
#define WH_PHASE_ROWS(X) \
    X(WH_PHASE_NONE, "none")           /* no run: motor off */ \
    X(WH_PHASE_TARE, "tare")           /* motor off; the load cell's reading at rest */ \
    X(WH_PHASE_SPIN_UP, "spin up")     /* open loop, until the pulses give a speed */ \
    X(WH_PHASE_RAMP, "ramp")           /* closed loop, set-point ramping */ \
    X(WH_PHASE_SETTLE, "settle")       /* closed loop, speed must stay near the target */ \
    X(WH_PHASE_RECORD, "record")       /* closed loop, measuring */ \
    X(WH_PHASE_RAMP_DOWN, "ramp down") /* closed loop, slowing; the result is available */ \
    X(WH_PHASE_OFF, "coast")           /* motor off, until the rotor rests */

#define WH_PHASE_NAME(name, words) name,
typedef enum wh_rig_phase { WH_PHASE_ROWS(WH_PHASE_NAME) WH_PHASES } wh_rig_phase;
#undef WH_PHASE_NAME

typedef struct wh_run_config {
    wh_real step_s; /* time between control steps */
    wh_drive_config drive;
    wh_real rated_V;         /* rated supply of the rig, */
    wh_real no_load_radps;   /* and the motor's speed at it without load */
    wh_real drag_V;          /* voltage that friction takes, about */
    wh_real spin_up_V;       /* at first, */
    wh_real spin_up_V_per_s; /* and rising at this rate, up to the voltage of rated_V */
    wh_real take_over_radps; /* the loop closes at this speed */
    wh_real spin_up_max_s;
    wh_real ramp_max_s;
    wh_real settle_band_radps; /* of a turn, or of the mean of WH_RUN_TURNS */
    wh_real settle_s;          /* time within the band */
    wh_real settle_max_s;      /* to get there */
    wh_real short_max_s;       /* longest time with a supply too low for the set-point */
    wh_real record_band_radps; /* of each turn, meanwhile */
    wh_real slow_radps;        /* ramp down to this speed (or keep a slower one), then motor off */
} wh_run_config;

/* While the rig settles, the mean speed of turns that overlap by half decides: two and a half turns in all. A jitter s
 * of the marks gives the mean an error of s/2 of a turn's time: 0.11 rpm for 120 us at 330 rpm; single turns scatter by
 * 0.31. A drift, or a hunting slower than a second, changes the mean as well. */
#define WH_RUN_TURNS 4U

typedef struct wh_run {
    wh_rig_phase phase;
    uint32_t since_ticks;  /* the phase began */
    uint32_t band_ticks;   /* speed has been within the band since */
    uint32_t closed_ticks; /* the loop was closed */
    uint32_t ample_ticks;  /* the supply has been enough since */
    wh_real target_radps;
    wh_real volts;     /* commanded mean voltage of the motor */
    wh_real off_radps; /* motor off: no faster than this */
    /* motor on: upper bound on the speed remaining from an earlier set-point, at the last pulse. A drive stage that
     * does not brake cannot slow the rotor as fast as a set-point falls */
    wh_real left_radps;
    uint32_t tare_pulses[WH_SPEED_SENSORS];
    uint32_t turns;                   /* seen while it settles and records, */
    uint32_t turns_taken;             /* the last one with this pulse; */
    wh_real turn_radps[WH_RUN_TURNS]; /* the last of them, */
    wh_real mean_radps;               /* and their mean */
    wh_drive drive;
} wh_run;

/* Inputs and outputs of a run's step. */
typedef struct wh_run_scene {
    const wh_run_config *config;
    const wh_measure_config *measuring;
    const wh_guard_config *guarding;
    wh_guard *guard;
    wh_pulses *pulses;
    wh_measure *measure;
    wh_real supply_V;
    bool fed;  /* gravity is fed forward: slower set-points are possible */
    bool busy; /* a pulse came in this step: a record begins and ends in the next */
    uint32_t now_ticks;
} wh_run_scene;

#define wh_run_start WH_NAME(wh_run_start)
#define wh_run_set WH_NAME(wh_run_set)
#define wh_run_off WH_NAME(wh_run_off)
#define wh_run_step WH_NAME(wh_run_step)
#define wh_run_setpoint WH_NAME(wh_run_setpoint)
#define wh_run_needs_V WH_NAME(wh_run_needs_V)
#define wh_phase_text WH_NAME(wh_phase_text)

/* Begin a run to target_radps > 0, with the tare. */
void wh_run_start(wh_run *run, wh_real target_radps, uint32_t now_ticks);

/* Another target, in any phase before WH_PHASE_RAMP_DOWN: the record so far is dropped. */
void wh_run_set(wh_run *run, wh_real target_radps, uint32_t now_ticks);

/* Motor off, from any phase: WH_PHASE_OFF. */
void wh_run_off(wh_run *run, wh_real speed_radps, uint32_t now_ticks);

/* One control step. Trips if a phase takes too long or meets an invalid condition. Returns true in the step in which
 * the record is finished and measured. */
bool wh_run_step(wh_run *run, const wh_run_scene *scene);

/* Does the motor drive; is the loop closed? */
WH_INLINE bool wh_run_drives(const wh_run *run) {
    return run->phase >= WH_PHASE_SPIN_UP && run->phase <= WH_PHASE_RAMP_DOWN;
}
WH_INLINE bool wh_run_is_closed(const wh_run *run) {
    return run->phase >= WH_PHASE_RAMP && run->phase <= WH_PHASE_RAMP_DOWN;
}

/* After the take-over the rotor accelerates for this time. */
#define WH_RUN_START_S WH_R(1.5)

/* The set-point at a pulse's time, for the guard. */
typedef struct wh_setpoint {
    wh_real setpoint_radps;
    wh_real
        limit_radps; /* upper bound on the actual speed: the rotor may not have slowed as far yet */
    bool jumps;      /* the speeds of its first turns differ widely */
} wh_setpoint;
wh_setpoint wh_run_setpoint(const wh_run_config *config, const wh_run *run, uint32_t ticks);

/* The voltage for a steady speed. */
wh_real wh_run_needs_V(const wh_run_config *config, wh_real speed_radps);

/* The phase in words, for consoles, by wh_text_add(). WH_PHASES is a motor that brakes when it is off
 * (wh_rig_shown_stage()). */
const char *wh_phase_text(wh_rig_phase phase);

#ifdef __cplusplus
}
#endif

#endif

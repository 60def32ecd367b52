/* rig.h: the eccentric-mass rig's controller, without hardware: life cycle, guard, test run, measurement. At a steady
 * rate, the caller passes it data and gets the motor's command:
 *
 *     wh_rig_start(&config, &rig, now_ticks, NULL);
 *     every control step:
 *         wh_rig_pulse(&config, &rig, ...) for each slot pulse, in the order of time
 *         wh_rig_load(&config, &rig, ...) for each load sample
 *         wh_rig_post(&rig, ...) for each order from outside: nothing moves without `arm` and then `start`
 *         command = wh_rig_step(&config, &rig, &inputs)
 *         set the motor as commanded and kick the watchdog: also when the rig is tripped */
#ifndef WH_RIG_RIG_H
#define WH_RIG_RIG_H

#include "free_swing.h"
#include "gravity_compensation.h"
#include "phases.h"
#include "state_machine.h"

WH_C_BEGIN

/* === the record of a trip, in bytes with the same layout on every processor =========== */

/* After a reset, wh_rig_start() restores the trip from this record. */
typedef struct wh_trip_record {
    wh_trip trip;
    wh_rig_phase phase;
    uint32_t ticks; /* time of the trip, on a timer that a reset may have restarted */
    wh_real speed_radps;
    wh_real volts;
    wh_real supply_V;
} wh_trip_record;

#define WH_TRIP_RECORD_BYTES 18U

void wh_trip_record_put(const wh_trip_record *record, uint8_t *bytes);

/* Read a record. Returns false if the number of bytes is wrong, or the trip or the phase is unknown. */
bool wh_trip_record_get(wh_trip_record *record, const uint8_t *bytes, unsigned length);

/* === a control step's inputs ================================================================= */

/* Source of a stop request. EITHER: one line carries both the drive stage's fault and the stop contacts. */
typedef enum wh_stop_by { WH_STOP_BY_EITHER, WH_STOP_BY_INPUT, WH_STOP_BY_DRIVE } wh_stop_by;

typedef struct wh_rig_inputs {
    uint32_t now_ticks;
    wh_real supply_V;
    bool stop_pressed;
    wh_stop_by stop_by;
    bool clock_is_fallback; /* the clock is too inaccurate to measure a speed */
    bool watchdog_has_cut;
} wh_rig_inputs;

typedef struct wh_rig_order {
    wh_rig_event event;
    wh_real value;
} wh_rig_order;

/* === the controller ========================================================================== */

#define WH_RIG_ORDERS_MOST 4U /* maximum number of orders between two control steps */

/* When to compensate gravity. Compensation removes the speed ripple that gravity causes. */
typedef enum wh_compensation_when {
    WH_COMPENSATION_NEVER,
    WH_COMPENSATION_SLOW, /* only for set-points below guard.target_min_radps */
    WH_COMPENSATION_ALWAYS
} wh_compensation_when;

/* 0 in builds for small chips: gravity is never compensated, and observer.scene is NULL. */
#ifndef WH_RIG_COMPENSATES
#define WH_RIG_COMPENSATES 1
#endif

typedef struct wh_rig_config {
    wh_run_config run;
    wh_guard_config guard;
    wh_measure_config measure;
    wh_observer_config observer;
    wh_compensation_config compensation;
    wh_swing_config swing;
    wh_compensation_when compensation_when;
    wh_real impossible_radps; /* for wh_speed_start() */
    wh_real armed_max_s;
    wh_real tripped_max_s; /* longest wait for the rotor to come to rest after a trip */
    /* Longest wait for rest after a run. After a trip for unreliable pulses, `clear` is refused for this time. */
    wh_real rest_max_s;
    /* If true, the motor brakes at a run's end and after `stop`. After a trip or the stop input it always coasts. */
    bool stop_brakes;
    /* If true, the motor coasts after a completed run, even if stop_brakes. The free swing then locates the sensors. */
    bool swings;
    bool host_loss_stops; /* a run ends if the host that gives the orders is lost */
    uint32_t host_max_s;  /* the host is lost after this time without an order; 0: never */
    uint32_t settings;    /* hash of the settings (core/station/conf.h); 0: no settings are used */
} wh_rig_config;

typedef enum wh_motor_way { WH_MOTOR_COASTS, WH_MOTOR_BRAKES, WH_MOTOR_DRIVES } wh_motor_way;

typedef struct wh_rig_command {
    wh_motor_way way;
    wh_real volts; /* mean voltage, 0 to the supply; 0 unless the motor drives */
} wh_rig_command;

/* Small members come first: some processors have short instructions that reach only the start of a struct. */
typedef struct wh_rig {
    wh_rig_state state;
    bool brakes; /* the motor brakes instead of coasting */
    /* The observer follows the rotor in this run, and gravity is compensated as soon as the observer is valid. */
    bool compensated;
    bool busy;    /* this step has processed a pulse: other work waits */
    bool decides; /* a pulse of this step decides whether a suspect (pulses.h) was a true pulse */
    /* Samples since the last step. With more than one, the step has less time for other work. */
    uint8_t loads;
    bool rested;     /* after a trip: the wait for rest is over */
    bool at_rest;    /* after a trip: the rotor has come to rest */
    bool has_result; /* the last run has a result */
    wh_rig_end ended;
    wh_rig_event asked; /* the last processed order */
    wh_refusal answer;  /* answer to the last processed order */
    wh_run run;
    wh_guard guard;
    uint32_t answers;     /* processed orders */
    uint32_t since_ticks; /* start of the state */
    uint32_t observed;    /* pulses processed by the observer */
    uint32_t pulses_ever;
    uint32_t pulses_before; /* pulses before `arm` */
    uint32_t runs;          /* starts since the reset */
    uint32_t settings;      /* config->settings when the result was measured */
    uint32_t result_s;      /* age of the result at result_ticks, whole seconds */
    uint32_t result_ticks;
    /* Times of each sensor's last two pulses, the newest first, accepted or not. */
    uint32_t heard_ticks[WH_RIG_SENSORS][2];
    wh_compensation compensation;
    wh_rig_command command;
    wh_pulses pulses;
    wh_trip_record record;
    unsigned orders;
    wh_rig_order order[WH_RIG_ORDERS_MOST];
    wh_observer observer;
    wh_rig_result result; /* valid if has_result; stays until the next start */
    wh_swing swing;       /* swing.result: the last evaluated free swing */
    wh_measure measure;
} wh_rig;

/* The configuration for the rig of eccentric.whirl. The caller fills in what depends on the hardware: measure.cell and
 * the sensors' angles (wh_rig_slots()). observer.scene is rig_fixed, or NULL: then gravity is never compensated. */
extern const wh_rig_config wh_rig_standard;

/* Returns the rig's stage as one number: in a run WH_RIG_STAGE_OF_PHASE plus its phase, otherwise the state. */
#define WH_RIG_STAGE_OF_PHASE 8U
unsigned wh_rig_stage(const wh_rig *rig);

/* Returns WH_RIG_STAGE_BRAKES if the motor brakes in WH_PHASE_OFF, otherwise wh_rig_stage(). */
#define WH_RIG_STAGE_BRAKES (WH_RIG_STAGE_OF_PHASE + (unsigned)WH_PHASES)
#define WH_RIG_STAGES (WH_RIG_STAGE_BRAKES + 1U)
unsigned wh_rig_shown_stage(const wh_rig *rig);

const char *wh_rig_stage_text(unsigned stage);

/* Sets *speed_radps to the mean speed of the last whole turn, or 0 at rest. Returns false if the speed is unknown:
 * before the first turn, or if the rotor swings. */
bool wh_rig_speed(const wh_rig *rig, uint32_t now_ticks, wh_real *speed_radps);

uint32_t wh_rig_result_age_s(const wh_rig *rig, uint32_t now_ticks);

/* Set the rotor's angles at the pulses: -lead_rad at sensor 1, pi/2 - lead_rad at sensor 2. */
void wh_rig_slots(wh_rig_config *config, wh_real lead_rad);

/* The torque line of a brushed motor; all numbers are > 0. */
typedef struct wh_rig_motor {
    wh_real stall_Nm;      /* at the rated voltage */
    wh_real no_load_radps; /* at the rated voltage */
    wh_real rated_V;
} wh_rig_motor;

/* Sets *motor to the motor for which the configuration is made. */
void wh_rig_motor_of(const wh_rig_config *config, wh_rig_motor *motor);

/* Scale the configuration to this motor: gains, spin-up, supply, bounds of the guard, damping, gravity compensation.
 * Call this only once: before the call, the configuration must be for the motor of observer.scene. */
void wh_rig_use_motor(wh_rig_config *config, const wh_rig_motor *motor);

/* Set impossible_radps to the motor's no-load speed at guard.supply_max_V. Call this after that voltage changes. */
void wh_rig_bound_pulses(wh_rig_config *config);

/* Start idle, motor off; the rotor may be moving. If `before`, which may be NULL, has a trip, start tripped. */
void wh_rig_start(const wh_rig_config *config, wh_rig *rig, uint32_t now_ticks,
                  const wh_trip_record *before);

/* Post an order for the next control step, which sets rig->answer. Returns false if WH_RIG_ORDERS_MOST orders are
 * waiting. */
bool wh_rig_post(wh_rig *rig, wh_rig_event event, wh_real value);

/* Take a slot pulse captured at `ticks`. A pulse of a sensor other than 0 and 1 only counts as rejected. */
void wh_rig_pulse(const wh_rig_config *config, wh_rig *rig, unsigned sensor, uint32_t ticks);

/* Take a load sample from the hardware, in counts, with its time stamp `ticks`. */
void wh_rig_load(const wh_rig_config *config, wh_rig *rig, uint32_t ticks, int32_t raw,
                 wh_load_status status);

wh_rig_command wh_rig_step(const wh_rig_config *config, wh_rig *rig, const wh_rig_inputs *inputs);

/* === the rig on a carriage =================================================================== */
/* The rig on a carriage that moves freely along a level rail, with arms in a level plane.
 *
 * M is the carriage's mass, m the eccentric mass, and S the unbalance. The load cell is between the shaft's pin and the
 * carriage. On a fixed mount, the cell would measure a force F0. On the carriage, the cell measures F0 M/(M + m). The
 * carriage moves to and fro with the amplitude S/(M + m) at any speed. Source: Almesallmy (2006), I.3.2.2 and I.3.5. */

typedef struct wh_carriage {
    wh_real disc_m; /* distance of the discs' centres from the shaft */
    wh_real ratio;  /* m/M; 0: the carriage is too heavy to move */
} wh_carriage;

/* Change a copy of wh_rig_standard to the rig on that carriage, without observer and gravity compensation. */
void wh_carriage_mount(wh_rig_config *config, const wh_carriage *carriage);

/* Returns the displacement amplitude X of the carriage, m; 0 for a fixed mount. X = F/(M <w^2>): F is the amplitude of
 * the cell's force, M the carriage's mass, and <w^2> the mean of the squared speed over the angles of a turn. */
wh_real wh_carriage_displacement_m(const wh_rig_config *config, const wh_carriage *carriage,
                                   const wh_measured *force);

WH_C_END

#endif

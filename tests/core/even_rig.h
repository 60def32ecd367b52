/* even_rig.h: the rig's controller on an imitated rotor whose speed is constant within each turn, for the suites of the
 * run and of the life cycle.
 *
 * The rotor stands still for the first tenth of a second of spin-up, then turns at EVEN_BEGIN_RPM until the loop is
 * closed. After that each turn has the speed of the loop's set-point, whatever the voltage. The rotor stops when the
 * motor goes off. Its load is EVEN_LOAD_N cos(theta), so the right answer is known. */
#ifndef TESTS_CORE_EVEN_RIG_H
#define TESTS_CORE_EVEN_RIG_H

#include "core/rig/datasheet.h"
#include "core/rig/rig.h"

#define EVEN_RPM WH_RIG_RADPS_PER_RPM
#define EVEN_STEP_TICKS UINT32_C(2000)           /* an AVR's unsigned has 16 bits */
#define EVEN_START_TICKS (UINT32_MAX - 5000000U) /* the timer wraps during a run */
#define EVEN_BEGIN_RPM WH_R(160.0)
#define EVEN_TARE_RAW 5000
#define EVEN_LOAD_N WH_R(42.0)
#define EVEN_COUNTS_PER_N WH_R(100.0)
#define EVEN_ALWAYS (~0U)
#define EVEN_NEVER WH_PHASES

/* The failures of a run. They begin `after_ticks` after the phase `in` has begun. */
typedef struct even_failure {
    wh_rig_phase in; /* EVEN_NEVER: no failure */
    uint32_t after_ticks;
    unsigned lose[WH_RIG_SENSORS]; /* number of pulses that each sensor loses */
    unsigned lose_samples;
    bool swapped; /* the sensors are swapped from the start of the run */
    bool jams;    /* the rotor jams, permanently */
    /* Amplitude, in counts, of a square wave that the cell shows instead of the load; 0: none. */
    int shows;
    int creeps;                /* drift of the cell, counts per second */
    wh_load_status status;     /* status of all samples */
    bool adds[WH_RIG_SENSORS]; /* each of these sensors gives one false pulse */
    /* From the start to the end of the run: pulses are late by up to jitter_ticks (uniform). The speed oscillates by
     * hunts_rpm at hunts_Hz, and drifts. */
    uint32_t jitter_ticks;
    wh_real hunts_rpm;
    wh_real hunts_Hz;
    wh_real drifts_rpm_s;
} even_failure;

typedef struct even_rig {
    wh_rig rig;
    wh_rig_config config;
    wh_rig_inputs inputs; /* inputs of the next step, which advances now_ticks */
    wh_rig_command command;
    even_failure fails;
    bool failing;         /* the failure has begun */
    wh_rig_phase phase;   /* phase after the last step */
    uint32_t phase_ticks; /* time at which that phase began */
    bool turns;
    wh_real hand_rpm; /* if not 0, a hand turns the rotor at this speed, whatever the motor does */
    uint32_t turn_ticks;
    uint32_t from_ticks;   /* time at which the present turn began */
    unsigned due_sensor;   /* sensor of the next pulse */
    uint32_t late_ticks;   /* delay of the next pulse */
    uint32_t settle_ticks; /* time at which settling began */
    uint64_t seed;
} even_rig;

wh_rig_config even_config(void);

void even_start(even_rig *even);

void even_step(even_rig *even);
void even_steps(even_rig *even, unsigned steps);

/* Posts an order, steps, and returns the answer. */
wh_refusal even_order(even_rig *even, wh_rig_event event, wh_real value);
/* Posts an order that must be allowed, and steps. */
void even_obeys(even_rig *even, wh_rig_event event, wh_real value);

/* From now on a hand turns the rotor at this speed. With 0 the hand lets go, and the rotor stops. */
void even_turn_by_hand(even_rig *even, wh_real rpm);

/* Steps until the controller knows that the rotor is at rest, so that `arm` is allowed. */
void even_rest(even_rig *even);

/* even_arm() runs from even_start() until `arm` is done; the next function runs until the tare of a run. */
void even_arm(even_rig *even);
void even_begin(even_rig *even, wh_real target_rpm, const even_failure *failure);

bool even_is_over(const even_rig *even);

/* Steps until a phase begins, or the rig is done. */
void even_go_on_until(even_rig *even, wh_rig_phase phase);

/* Runs from even_start() to this phase of a run to 330 rpm. For WH_PHASE_OFF the order is `stop`. */
void even_reach(even_rig *even, wh_rig_phase phase);

/* Makes a whole run, and checks that the motor is off at the end. */
void even_run(even_rig *even, wh_real target_rpm, const even_failure *failure);

bool even_is_done(const even_rig *even);

#endif

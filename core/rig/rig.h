/* rig.h: the eccentric-mass rig's test run as a state machine, without hardware.
 *
 * The run repeats Almesallmy (2006), I.3.2.1 and I.3.3: tare, spin up, hold 330 rpm, record the load
 * cell for 2 s at 500 samples a second together with the slot pulses, stop. The caller moves data in
 * and the duty out, at a steady rate; nothing here waits or touches hardware:
 *
 *     wh_rig_start(&config, &rig, target_radps, now_ticks);
 *     every control step, until wh_rig_is_over(&rig):
 *         wh_rig_pulse(&rig, ...) for each slot pulse, in order of time
 *         wh_rig_load(&config, &rig, ...) for each load sample
 *         duty = wh_rig_step(&config, &rig, now_ticks, watchdog_has_cut)
 */
#ifndef WH_RIG_RIG_H
#define WH_RIG_RIG_H

#include "drive.h"
#include "guard.h"
#include "lockin.h"
#include "result.h"
#include "speed.h"
#include "tare.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum wh_rig_state {
    WH_RIG_TARE,      /* motor off; the load cell's reading at rest */
    WH_RIG_SPIN_UP,   /* constant duty, until the pulses give a speed */
    WH_RIG_RAMP,      /* closed loop, set-point on its way */
    WH_RIG_SETTLE,    /* closed loop, speed must stay near the target */
    WH_RIG_RECORD,    /* closed loop, measuring */
    WH_RIG_RAMP_DOWN, /* closed loop, slowing */
    WH_RIG_COAST,     /* motor off, until the rotor rests */
    WH_RIG_DONE,      /* the result is there */
    WH_RIG_TRIPPED    /* motor off; guard.trip says why */
} wh_rig_state;

typedef struct wh_rig_config {
    wh_real step_s; /* time between calls of wh_rig_step() */
    wh_drive_config drive;
    wh_guard_config guard;
    wh_real impossible_radps; /* see wh_speed_start() */
    wh_rotor_config rotor;
    wh_cell_config cell;
    wh_tare_config tare;
    wh_result_config result;
    wh_real spin_up_duty;
    wh_real take_over_radps; /* from this speed on the loop is closed */
    wh_real spin_up_max_s;
    wh_real settle_band_radps;
    wh_real settle_s;          /* so long within the band */
    wh_real settle_max_s;      /* to get there */
    wh_real record_s;          /* whole turns within this time are measured */
    wh_real record_band_radps; /* meanwhile */
    wh_real slow_radps; /* ramp down to here (or stay, when slower already), then motor off */
    wh_real rest_s;     /* so long without a pulse: at rest */
    wh_real rest_max_s; /* to get there */
} wh_rig_config;

typedef struct wh_rig_result {
    wh_measured force;    /* the load's once-per-turn part: see result.h */
    wh_real tare_N;       /* reading at rest */
    wh_real tare_error_N; /* its standard error */
    wh_real low_N;        /* peaks of the whole record, without tare */
    wh_real high_N;
    wh_real duty;  /* at the record's end */
    uint32_t lost; /* pulses */
    uint32_t rejected;
} wh_rig_result;

typedef struct wh_rig {
    wh_rig_state state;
    uint32_t since_ticks; /* the state began */
    uint32_t band_ticks;  /* speed has been within the band since */
    wh_real target_radps;
    wh_real duty;
    bool at_rest;
    wh_speed speed;
    wh_drive drive;
    wh_guard guard;
    wh_tare tare;
    uint32_t tare_pulses[WH_SPEED_SENSORS];
    wh_lockin lockin;        /* lockin.turn: the last turn's load, whatever the state */
    wh_merge merge;          /* of the record */
    uint8_t due;             /* pieces of work that the last turn has left */
    bool peaks;              /* low_N and high_N are of something */
    bool ends;               /* the record's last turn is through */
    uint32_t skipped_before; /* turns, when the record began */
    wh_rig_result result;    /* grows with each turn of the record, whole from RAMP_DOWN on */
} wh_rig;

/* The rig of eccentric.whirl. cell and rotor.mark_rad come from the hardware: wh_rig_slots() and the caller
 * fill them in. */
#define wh_rig_standard WH_NAME(wh_rig_standard)
extern const wh_rig_config wh_rig_standard;

#define wh_rig_slots WH_NAME(wh_rig_slots)
#define wh_rig_start WH_NAME(wh_rig_start)
#define wh_rig_pulse WH_NAME(wh_rig_pulse)
#define wh_rig_load WH_NAME(wh_rig_load)
#define wh_rig_step WH_NAME(wh_rig_step)
#define wh_rig_is_over WH_NAME(wh_rig_is_over)
#define wh_rig_state_text WH_NAME(wh_rig_state_text)

/* Sensors on the loading-train axis and a quarter turn on, whose pulses come with the arms so far short. */
void wh_rig_slots(wh_rig_config *config, wh_real lead_rad);

/* Begin a run to target_radps. A target that the guard refuses trips at once. */
void wh_rig_start(const wh_rig_config *config, wh_rig *rig, wh_real target_radps,
                  uint32_t now_ticks);

/* A slot pulse of sensor 0 or 1, captured at `ticks`. */
void wh_rig_pulse(wh_rig *rig, unsigned sensor, uint32_t ticks);

/* A load sample as the hardware has it: counts, stamped `ticks`, and what it says of it. */
void wh_rig_load(const wh_rig_config *config, wh_rig *rig, uint32_t ticks, int32_t raw,
                 wh_load_status status);

/* One control step. Returns the motor's duty, 0 to 1; 0 whenever the rig is tripped. */
wh_real wh_rig_step(const wh_rig_config *config, wh_rig *rig, uint32_t now_ticks,
                    bool watchdog_has_cut);

/* True when the run is done, or has tripped and the rotor rests (or will not rest). */
bool wh_rig_is_over(const wh_rig *rig);

/* The state in words, for consoles. */
const char *wh_rig_state_text(wh_rig_state state);

#ifdef __cplusplus
}
#endif

#endif

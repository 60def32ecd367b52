/* guard.h: what stops the rig. The first reason to stop stays; nothing but a restart clears it. */
#ifndef WH_RIG_GUARD_H
#define WH_RIG_GUARD_H

#include "speed.h"

typedef enum wh_trip {
    WH_TRIP_NONE,
    WH_TRIP_TARGET,    /* the set-point is above what the shaft carries */
    WH_TRIP_OVERSPEED, /* faster than the shaft carries */
    WH_TRIP_PULSES,    /* slot pulses lost or missing while the motor drives */
    WH_TRIP_STALLED,   /* the rotor does not start */
    WH_TRIP_LOAD_CELL, /* stuck, or overloaded */
    WH_TRIP_WATCHDOG,  /* the controller was late and the watchdog cut the motor */
    WH_TRIP_MOVING,    /* the tare was not at rest */
    WH_TRIP_UNSETTLED, /* the speed does not settle */
    WH_TRIP_RECORD,    /* the record has no whole turn */
    WH_TRIP_RUNS_ON    /* the rotor does not stop with the motor off */
} wh_trip;

typedef struct wh_guard_config {
    wh_real target_max_radps; /* largest set-point, see docs/rig.md */
    wh_real limit_radps;      /* largest speed, mean of a turn */
    wh_real ripple;           /* by how much a part of a turn may be faster, as a fraction */
    uint32_t lost_max;        /* pulses that may be lost in a run */
    wh_real silence_max_s;    /* longest time without a pulse while the motor drives */
    unsigned stuck_samples;   /* equal load samples running, with the rotor turning: stuck */
    int16_t load_raw_max;     /* counts of a full-scale load, either sign: overloaded */
} wh_guard_config;

typedef struct wh_guard {
    wh_trip trip;
    unsigned fast_intervals; /* too fast, running */
    uint32_t pulses_seen;
    uint32_t lost_before;   /* pulses already lost when the motor began to drive */
    unsigned equal_samples; /* equal load samples, running */
    int16_t last_raw;
} wh_guard;

#define wh_guard_start WH_NAME(wh_guard_start)
#define wh_guard_allows WH_NAME(wh_guard_allows)
#define wh_guard_trip WH_NAME(wh_guard_trip)
#define wh_guard_speed WH_NAME(wh_guard_speed)
#define wh_guard_load WH_NAME(wh_guard_load)
#define wh_trip_text WH_NAME(wh_trip_text)

void wh_guard_start(wh_guard *guard);

/* True for set-points that the shaft carries; false for negative ones and NaN too. */
bool wh_guard_allows(const wh_guard_config *config, wh_real target_radps);

/* Stop for this reason, unless there is one already. */
void wh_guard_trip(wh_guard *guard, wh_trip reason);

/* Look at the speed, each control step while the motor drives: over-speed (of a turn; or of two
 * pulse intervals running beyond limit and ripple, which is seen sooner), lost pulses, silence. */
void wh_guard_speed(const wh_guard_config *config, wh_guard *guard, const wh_speed *speed,
                    uint32_t now_ticks);

/* Look at a load sample, counts with the tare in them. `turning`: the load must be changing. */
void wh_guard_load(const wh_guard_config *config, wh_guard *guard, int16_t raw, bool turning);

/* The reason in words, for consoles. */
const char *wh_trip_text(wh_trip reason);

#endif

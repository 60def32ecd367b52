/* guard.h: what stops the rig. The first reason to stop stays; nothing but a restart clears it. */
#ifndef WH_RIG_GUARD_H
#define WH_RIG_GUARD_H

#include "cell.h"
#include "speed.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum wh_trip {
    WH_TRIP_NONE,
    WH_TRIP_TARGET, /* the set-point is below what the loop holds or above what the shaft carries */
    WH_TRIP_OVERSPEED, /* faster than the shaft carries */
    WH_TRIP_PULSES,    /* slot pulses lost, missing or in the wrong order while the motor drives */
    WH_TRIP_STALLED,   /* the rotor does not start */
    WH_TRIP_LOAD_CELL, /* silent, stuck, overloaded or disconnected */
    WH_TRIP_WATCHDOG,  /* the controller was late and the watchdog cut the motor */
    WH_TRIP_MOVING,    /* the tare was not at rest */
    WH_TRIP_UNSETTLED, /* the speed does not settle, or does not stay during the record */
    WH_TRIP_RECORD,    /* the record lacks load samples, or the count of its turns */
    WH_TRIP_RUNS_ON    /* the rotor does not stop with the motor off */
} wh_trip;

typedef struct wh_guard_config {
    wh_real target_min_radps;   /* smallest set-point, see docs/rig.md */
    wh_real target_max_radps;   /* largest */
    wh_real limit_radps;        /* largest speed, mean of a turn */
    wh_real ripple;             /* by how much a part of a turn may be faster, as a fraction */
    uint32_t lost_max;          /* pulses that may be lost in a run */
    wh_real silence_max_s;      /* longest time without a pulse while the motor drives */
    wh_real load_silence_max_s; /* longest time without a load sample */
    wh_real
        load_still_kgm; /* a load that moves by less than this times the speed's square is still */
    uint32_t stuck_pulses; /* slot pulses that come while the load does not move: stuck */
} wh_guard_config;

typedef struct wh_guard {
    wh_trip trip;
    unsigned fast_intervals; /* too fast, running */
    uint32_t pulses_seen;
    uint32_t lost_before;  /* pulses already lost when the motor began to drive */
    uint32_t load_ticks;   /* of the last load sample; at first, the start */
    uint32_t load_pulses;  /* pulses taken by then */
    uint32_t still_pulses; /* samples with a new pulse since the load last moved, */
    wh_real still_N;       /* and where to */
} wh_guard;

#define wh_guard_start WH_NAME(wh_guard_start)
#define wh_guard_allows WH_NAME(wh_guard_allows)
#define wh_guard_trip WH_NAME(wh_guard_trip)
#define wh_guard_speed WH_NAME(wh_guard_speed)
#define wh_guard_load WH_NAME(wh_guard_load)
#define wh_guard_load_silence WH_NAME(wh_guard_load_silence)
#define wh_trip_text WH_NAME(wh_trip_text)

void wh_guard_start(wh_guard *guard, uint32_t now_ticks);

/* True for set-points that the loop can hold and the shaft carries; false for NaN. */
bool wh_guard_allows(const wh_guard_config *config, wh_real target_radps);

/* Stop for this reason, unless there is one already. */
void wh_guard_trip(wh_guard *guard, wh_trip reason);

/* Look at the speed, each control step while the motor drives: over-speed (of a turn; or of two
 * pulse intervals running beyond limit and ripple, which is seen sooner), lost pulses, silence. */
void wh_guard_speed(const wh_guard_config *config, wh_guard *guard, const wh_speed *speed,
                    uint32_t now_ticks);

/* Look at a load sample, the tare in it. `turning`: the load must be changing with the rotor's turns. A
 * sample that repeats the last one is none. */
void wh_guard_load(const wh_guard_config *config, wh_guard *guard, const wh_speed *speed,
                   const wh_load *load, bool turning);

/* Look whether load samples still come, each control step in which they are needed. */
void wh_guard_load_silence(const wh_guard_config *config, wh_guard *guard, uint32_t now_ticks);

/* The reason in words, for consoles. */
const char *wh_trip_text(wh_trip reason);

#ifdef __cplusplus
}
#endif

#endif

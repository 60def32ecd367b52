/* pulses.h: separates true slot pulses from disturbances.
 *
 * Noise must neither count as a pulse nor cause the next true pulse to be rejected. Therefore:
 *
 * - A pulse is a suspect if it comes before its predicted time by more than `window`, or if it would need a speed above
 * bound_radps. The next pulse decides: two successive short intervals show that the rotor is that fast.
 * - If a pulse comes impossibly soon after the last one, the one that is further from its predicted time is rejected.
 * - A pulse is confirmed when no later pulse can reject it: an eighth of a turn later, or at the next pulse. Then it
 * goes to the measurement. */
#ifndef WH_RIG_PULSES_H
#define WH_RIG_PULSES_H

#include "speed.h"

WH_C_BEGIN

#define WH_PULSES_CONFIRMED 4U

typedef struct wh_pulse {
    uint32_t ticks;
    unsigned sensor; /* 0 or 1 */
} wh_pulse;

/* An index pulse: a slot pulse that no later pulse can reject. */
typedef struct wh_index_pulse {
    wh_pulse pulse;
    uint32_t quarter; /* the rotor's position, quarter turns, wrapping */
    bool gap;         /* the number of turns since the previous pulse is unknown */
} wh_index_pulse;

typedef struct wh_pulses {
    bool suspects; /* `suspect` is set: the next pulse decides about it */
    bool waits;    /* the last pulse is not yet confirmed */
    bool alert;    /* the last pulse was early: the next pulse is no suspect, even if early */
    /* Set by the caller: motor off, rotor almost at rest. A speed far above bound_radps then adds 2 to `fast`. */
    bool slow;
    wh_real bound_radps; /* set by the caller: limit on the speed between two pulses; 0: no limit */
    wh_real window;      /* set by the caller: fraction of a turn by which a pulse may be early */
    wh_real climb_radps2; /* set by the caller: limit on the rise of the turns' speed */
    /* rise of speed.turn_radps at the last pulse, minus the rise that climb_radps2 allows; 0 if negative */
    wh_real climb_radps;
    wh_real climb_before_radps; /* climb_radps at the previous pulse */
    unsigned fast;              /* number of successive intervals with a speed above bound_radps */
    unsigned alternate;         /* number of successive pulses that alternate between the sensors */
    unsigned doubt;    /* +2 at a false pulse that is no bounce, -1 at a pulse accepted at once */
    uint32_t rejected; /* number of rejected pulses */
    wh_pulse suspect;
    wh_index_pulse last; /* the last pulse */
    wh_speed speed;      /* speed from the accepted pulses */
    wh_speed before;     /* the speed before the last pulse was taken */
    wh_speed suspected;  /* the speed if the suspect is a true pulse */
    unsigned confirmed_count;
    wh_index_pulse confirmed[WH_PULSES_CONFIRMED]; /* not yet taken by the caller */
} wh_pulses;

/* Begin with an unknown state. impossible_radps is that of wh_speed_start(). */
void wh_pulses_start(wh_pulses *pulses, wh_real impossible_radps);

/* Restart as wh_pulses_start() does, with the same impossible_radps. The counters become 0. */
void wh_pulses_forget(wh_pulses *pulses);

/* Process a pulse of sensor 0 or 1 captured at `ticks`, in the order of time. */
void wh_pulses_take(wh_pulses *pulses, unsigned sensor, uint32_t ticks);

/* The slow part of wh_pulses_confirmed(), after its quick check. */
bool wh_pulses_sure(wh_pulses *pulses, uint32_t now_ticks, wh_index_pulse *index);

/* Take the next confirmed pulse. Returns false if there is none. Call it in each step until it returns false. */
WH_INLINE bool wh_pulses_confirmed(wh_pulses *pulses, uint32_t now_ticks, wh_index_pulse *index) {
    return (pulses->waits || pulses->confirmed_count > 0) &&
           wh_pulses_sure(pulses, now_ticks, index);
}

WH_C_END

#endif

/* pulses.h: separates true slot pulses from disturbances.
 *
 * Noise must neither count as a pulse nor cause the next true pulse to be rejected. So
 *
 * - a pulse is a suspect if it is early (before the window around the time predicted from the last turn) or needs more
 *   than the possible speed (`bound`). The next pulse decides. Two successive fast intervals are a speed.
 * - a pulse that cannot follow the last one may be the true one of the two: the one closer to its predicted time stays,
 *   the other is withdrawn.
 * - a mark goes to the measurement once no pulse can withdraw it: an eighth of a turn later, or with the next. */
#ifndef WH_RIG_PULSES_H
#define WH_RIG_PULSES_H

#include "speed.h"

#ifdef __cplusplus
extern "C" {
#endif

#define WH_PULSES_MARKS 4U

typedef struct wh_pulse {
    uint32_t ticks;
    unsigned sensor; /* 0 or 1 */
} wh_pulse;

/* A confirmed pulse. */
typedef struct wh_mark {
    wh_pulse pulse;
    uint32_t quarter; /* the rotor's position, quarter turns, wrapping */
    bool gap;         /* the number of turns before this mark is unknown */
} wh_mark;

typedef struct wh_pulses {
    bool suspects; /* `suspect` is a suspect */
    bool waits;    /* the last pulse is unconfirmed */
    bool alert;    /* the last pulse was a little early: the next early one is no disturbance */
    /* the rotor almost rests without drive: one interval far beyond the bound counts as two. Set by the caller */
    bool slow;
    wh_real bound_radps;  /* faster intervals are not expected; 0: no bound. Set by the caller */
    wh_real window;       /* share of a turn by which a pulse may be early. Set by the caller */
    wh_real climb_radps2; /* limit on the rise of a turn's speed per second. Set by the caller */
    /* excess of the turn's speed over that limit, else 0: */
    wh_real climb_radps;        /* at the last pulse */
    wh_real climb_before_radps; /* at the previous pulse */
    unsigned fast;              /* successive intervals beyond the bound */
    /* number of successive pulses of alternating sensors: 0 for a rotor that swings */
    unsigned alternate;
    /* grows by two with each doubtful pulse and shrinks by one with each expected one */
    unsigned doubt;
    uint32_t rejected; /* false pulses */
    wh_pulse suspect;
    wh_mark last;       /* pulse */
    wh_speed speed;     /* from the accepted pulses */
    wh_speed before;    /* the speed without the last pulse */
    wh_speed suspected; /* the speed with the suspect */
    unsigned marks;
    wh_mark mark[WH_PULSES_MARKS]; /* confirmed marks, not yet taken */
} wh_pulses;

#define wh_pulses_start WH_NAME(wh_pulses_start)
#define wh_pulses_forget WH_NAME(wh_pulses_forget)
#define wh_pulses_take WH_NAME(wh_pulses_take)
#define wh_pulses_sure WH_NAME(wh_pulses_sure)

/* Begin with unknown state. impossible_radps as for wh_speed_start(). */
void wh_pulses_start(wh_pulses *pulses, wh_real impossible_radps);

/* Restart with unknown state; the counters stay. */
void wh_pulses_forget(wh_pulses *pulses);

/* A pulse of sensor 0 or 1 captured at `ticks`, in order of time. */
void wh_pulses_take(wh_pulses *pulses, unsigned sensor, uint32_t ticks);

/* wh_pulses_mark() after its quick check. */
bool wh_pulses_sure(wh_pulses *pulses, uint32_t now_ticks, wh_mark *mark);

/* Take the next mark that is confirmed by now. Returns false if there is none. Call it in each control step until it
 * returns false. */
WH_INLINE bool wh_pulses_mark(wh_pulses *pulses, uint32_t now_ticks, wh_mark *mark) {
    return (pulses->waits || pulses->marks > 0) && wh_pulses_sure(pulses, now_ticks, mark);
}

#ifdef __cplusplus
}
#endif

#endif

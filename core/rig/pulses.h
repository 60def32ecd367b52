/* pulses.h: which slot pulses are true.
 *
 * A disturbance that counts as a pulse must not be taken for the rotor, nor make the next true pulse be rejected. So
 *
 *  - a pulse that comes early (before the window round what the last turn lets expect) or needs more than the speed that
 *    can be (`bound`) is a suspect: the next pulse tells whether it was one. Two fast intervals running are a speed;
 *  - a pulse that cannot follow the last one may be the true one of the two: the one that is closer to its time stays,
 *    the other is taken back;
 *  - a mark goes to the measurement when nothing can take it back any more: an eighth of a turn later, or with the next. */
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

/* A pulse that is sure. */
typedef struct wh_mark {
    wh_pulse pulse;
    uint32_t quarter; /* the rotor's position, quarter turns, wrapping */
    bool gap;         /* before it nobody knows how many turns there were */
} wh_mark;

typedef struct wh_pulses {
    bool suspects; /* `suspect` is one */
    bool waits;    /* the last pulse is not sure yet */
    bool alert;    /* the last pulse came a little early: the next that does is no disturbance */
    /* the rotor all but rests, undriven: an interval far beyond the bound is as good as two; the caller renews it */
    bool slow;
    wh_real bound_radps;  /* a faster interval is not expected; ditto. 0: no bound */
    wh_real window;       /* so early, as a part of a turn, a pulse may come; ditto */
    wh_real climb_radps2; /* a turn's speed may rise by so much each second; ditto */
    /* by so much more than it may the turn's speed rose, else 0: */
    wh_real climb_radps;        /* with the last pulse, */
    wh_real climb_before_radps; /* and with the one before */
    unsigned fast;              /* intervals beyond the bound, running */
    /* pulses running whose sensor was not the one before's: a rotor that swings has none */
    unsigned alternate;
    /* grows by two with each pulse whose truth was doubtful and shrinks by one with each that fits */
    unsigned doubt;
    uint32_t rejected; /* pulses that are none */
    wh_pulse suspect;
    wh_mark last;       /* pulse */
    wh_speed speed;     /* of the pulses that were taken */
    wh_speed before;    /* the same without the last one */
    wh_speed suspected; /* the same with the suspect */
    unsigned marks;
    wh_mark mark[WH_PULSES_MARKS]; /* sure, not yet taken */
} wh_pulses;

#define wh_pulses_start WH_NAME(wh_pulses_start)
#define wh_pulses_forget WH_NAME(wh_pulses_forget)
#define wh_pulses_take WH_NAME(wh_pulses_take)
#define wh_pulses_sure WH_NAME(wh_pulses_sure)

/* Begin: nothing is known. impossible_radps as for wh_speed_start(). */
void wh_pulses_start(wh_pulses *pulses, wh_real impossible_radps);

/* Begin anew. */
void wh_pulses_forget(wh_pulses *pulses);

/* A pulse of sensor 0 or 1 captured at `ticks`, in order of time. */
void wh_pulses_take(wh_pulses *pulses, unsigned sensor, uint32_t ticks);

/* The same where there may be one. */
bool wh_pulses_sure(wh_pulses *pulses, uint32_t now_ticks, wh_mark *mark);

/* The next mark that is sure by now; false when there is none. To be asked until there is none, each control step. */
WH_INLINE bool wh_pulses_mark(wh_pulses *pulses, uint32_t now_ticks, wh_mark *mark) {
    return (pulses->waits || pulses->marks > 0) && wh_pulses_sure(pulses, now_ticks, mark);
}

#ifdef __cplusplus
}
#endif

#endif

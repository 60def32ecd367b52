/* speed.h: speed of the rotor from the pulses of the two slot sensors. Sensor 0 is at angle 0, sensor 1 a quarter turn
 * later. So the pulses of a turning rotor alternate, and the rotor advances by 1, 3, 1, 3, ... quarters. If a sensor
 * fires twice in succession, a pulse of the other sensor was lost in between. Speed is measured from a sensor's pulse
 * to its next one. Over this whole turn gravity's ripple cancels; each turn gives two new values. */
#ifndef WH_RIG_SPEED_H
#define WH_RIG_SPEED_H

#include "core/real.h"
#include "datasheet.h"

WH_C_BEGIN

typedef struct wh_speed {
    bool known;                /* a whole turn has been measured */
    bool running;              /* at least one pulse has been taken since the last gap */
    bool seen[WH_RIG_SENSORS]; /* seen_ticks and seen_quarter of the sensor are valid */
    wh_real impossible_radps;  /* a pulse that would need a higher speed is rejected */
    wh_real turn_radps;        /* mean over the last whole turn; valid if `known` */
    wh_real interval_radps;    /* mean over the last interval, 0 after a gap; valid if `known` */
    uint32_t ticks;            /* time of the last pulse taken */
    uint32_t quarter;          /* rotor's position at the last pulse, quarter turns, wrapping */
    uint32_t taken;            /* number of pulses taken */
    uint32_t lost;             /* number of missing pulses */
    uint32_t restarts;         /* number of gaps after which `quarter` restarted */
    uint32_t rejected;         /* number of impossible pulses */
    uint32_t seen_ticks[WH_RIG_SENSORS];
    uint32_t seen_quarter[WH_RIG_SENSORS];
} wh_speed;

/* Begin with an unknown speed; impossible_radps > 0. */
void wh_speed_start(wh_speed *speed, wh_real impossible_radps);

/* Process a pulse of `sensor` (0 or 1) captured at `ticks`, in the order of time. Returns false if the pulse is
 * rejected, because it would need a speed above impossible_radps.
 *
 * If a pulse is more than a quarter turn late, `lost` rises by 2, and `quarter` restarts. turn_radps stays valid after
 * one restart. After two restarts in succession, `known` is false. If one sensor gives two pulses in succession without
 * a restart, `lost` rises by 1, and `quarter` by 4. If the sensors are swapped, or the rotor turns backwards, `quarter`
 * restarts in each turn. */
bool wh_speed_pulse(wh_speed *speed, unsigned sensor, uint32_t ticks);

/* Returns the seconds since the last accepted pulse, or 0 without one. */
WH_INLINE wh_real wh_speed_silence_s(const wh_speed *speed, uint32_t now_ticks) {
    /* signed: a pulse's time stamp may be later than the time at which the step read the timer */
    const int32_t age_ticks = (int32_t)(now_ticks - speed->ticks);
    return speed->running && age_ticks > 0
               ? (wh_real)age_ticks * (WH_R(1.0) / (wh_real)WH_RIG_TICKS_PER_S)
               : WH_R(0.0);
}

/* True if no pulse has come for more than a whole turn at the known speed. At least one pulse was then lost, because
 * regular intervals are at most three quarters of a turn. */
WH_INLINE bool wh_speed_is_overdue(const wh_speed *speed, uint32_t now_ticks) {
    return speed->known && wh_speed_silence_s(speed, now_ticks) * speed->turn_radps > WH_RIG_TWO_PI;
}

WH_C_END

#endif

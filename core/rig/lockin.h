/* lockin.h: amplitude of the load's once-per-turn part, and its phase to the masses.
 *
 * Almesallmy (2006), I.3.3 and I.3.4, read the phase off an oscilloscope: sensor 1's spike sits on
 * the load's peak. Here the load is multiplied with the cosine and sine of the rotor's angle and
 * averaged over whole turns (lock-in, or order tracking with one mark a turn): what is not once per
 * turn averages out.
 *
 * The reference runs evenly from one mark of sensor 1 to the next (over two turns when the mark in
 * between was lost), so `amplitude` is the component at the frequency of rotation, as a spectrum of
 * the record would show it. Signs: the load counts
 * positive along the loading-train axis towards the mass at theta = 0, and
 *     load(theta) = mean + amplitude cos(theta + phase) + the rest:
 * phase 0 has the load's peak with the mass on the axis; positive, the peak comes before the mass. */
#ifndef WH_RIG_LOCKIN_H
#define WH_RIG_LOCKIN_H

#include "core/real.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Evenly sampled load: sample i was taken at first_ticks + i period_ticks. */
typedef struct wh_load_record {
    const int16_t *raw; /* [samples] counts */
    unsigned samples;
    uint32_t first_ticks;
    uint32_t period_ticks;
} wh_load_record;

/* A passing of a sensor: when, and the count of quarter turns (wrapping) the rotor had made by then. */
typedef struct wh_mark {
    uint32_t ticks;
    uint32_t quarter;
} wh_mark;

typedef struct wh_lockin_result {
    unsigned turns;            /* whole turns used */
    wh_real turn_s;            /* mean time of one */
    wh_real mean_counts;       /* over these turns */
    wh_real in_phase_counts;   /* amplitude cos(phase) */
    wh_real quadrature_counts; /* -amplitude sin(phase): the sine's coefficient */
    wh_real amplitude_counts;
    wh_real phase_rad; /* -pi ... pi */
} wh_lockin_result;

#define wh_lockin WH_NAME(wh_lockin)
#define wh_polar WH_NAME(wh_polar)
#define wh_load_at WH_NAME(wh_load_at)

/* Lock in over the turns between marks[0] and marks[mark_count - 1] that lie within the record;
 * marks are of one sensor, rising in time and by one or more whole turns of four quarters each: at
 * each the rotor's angle was mark_rad. Returns false, with
 * nothing written, when that is less than one whole turn or the turns have no samples. */
bool wh_lockin(const wh_load_record *record, const wh_mark *marks, unsigned mark_count,
               wh_real mark_rad, wh_lockin_result *result);

/* x = radius cos(angle), y = radius sin(angle) without square root and arc tangent: the angle is
 * improved with the core's own sine until y vanishes in the turned frame. angle_rad: -pi ... pi.
 * (0, 0) gives 0 and 0. */
void wh_polar(wh_real x, wh_real y, wh_real *radius, wh_real *angle_rad);

/* Load at a time within the record, counts, on the straight line between two samples; *counts is
 * left alone and false returned outside it. */
bool wh_load_at(const wh_load_record *record, uint32_t ticks, wh_real *counts);

#ifdef __cplusplus
}
#endif

#endif

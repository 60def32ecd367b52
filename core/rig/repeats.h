/* repeats.h: the part of the load's residual that repeats from turn to turn, in harmonics 3 to 6.
 *
 * Synchronous averaging (Braun, Acustica 32 (1975) 69): the residual of orders 0 to 2 is summed by the rotor's angle over
 * the turns of a record. Noise and mains hum average out. The errors of a cell with clipping, backlash or a nonlinear gain
 * do not. Neither does a torque twice a turn, which changes the speed and so gives the force a third harmonic.
 *
 * A rigid rotor on a fixed mount has no such harmonics: w^2 = A + B cos(theta + psi - gamma) gives F = S (w^2 cos theta +
 * w' sin theta) the orders 0, 1 and 2 only. Damping's effect on w^2 and the angle's third order add a little (result.c).
 *
 * The noise is estimated from successive differences, as for the tare: hum and slow changes do not count. */
#ifndef WH_RIG_REPEATS_H
#define WH_RIG_REPEATS_H

#include "datasheet.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Hum that is locked to the turn aliases from harmonic 26 on (115 rpm, 50 Hz), with a fifth of its amplitude. */
#define WH_REPEATS_BINS 32U

/* The harmonics. The second serves to check the swing of the speed (result.h). */
#define WH_REPEATS_FIRST 3U
#define WH_REPEATS_LAST 6U

typedef struct wh_repeats {
    uint32_t samples;   /* of the merged turns */
    wh_real changes_N2; /* sum of squared differences of successive samples' residuals */
    wh_real bin_N[WH_REPEATS_BINS]; /* integral of the residual over the angle */
} wh_repeats;

#define wh_repeats_merge WH_NAME(wh_repeats_merge)
#define wh_repeats_power_N2 WH_NAME(wh_repeats_power_N2)

/* The residual at an angle of about one turn, times the angle it represents. */
WH_INLINE void wh_repeats_add(wh_repeats *repeats, wh_real theta_rad, wh_real residual_Nrad) {
    const wh_real bins = (wh_real)WH_REPEATS_BINS;
    const wh_real bin = theta_rad * (bins / WH_RIG_TWO_PI) + bins;
    if (!(WH_ABS(bin) < WH_R(3.0) * bins)) {
        return; /* NaN, for example */
    }
    repeats->bin_N[(uint32_t)(int32_t)bin % WH_REPEATS_BINS] += residual_Nrad;
}

/* Add a turn of `samples` samples. */
void wh_repeats_merge(wh_repeats *sum, const wh_repeats *turn, uint32_t samples);

/* Squared amplitude of a harmonic, averaged over the turns. */
wh_real wh_repeats_power_N2(const wh_repeats *sum, uint32_t turns, unsigned harmonic);

#ifdef __cplusplus
}
#endif

#endif

/* repeats.h: the part of the load's residual that repeats from turn to turn, in harmonics 3 to 6.
 *
 * Synchronous averaging (Braun, Acustica 32 (1975) 69): the residual of orders 0 to 2 is summed by the rotor's angle over
 * the turns of a record. Noise and mains hum average out. The errors of a cell that clips, plays or bends its gain
 * do not, nor does a torque twice a turn: it changes the speed, and so the force has a third harmonic.
 *
 * A rigid rotor on a fixed mount has none of these harmonics itself: w^2 = A + B cos(theta + psi - gamma) gives
 * F = S (w^2 cos theta + w' sin theta) the orders 0, 1 and 2 only. Damping that bends w^2 and the angle's third order
 * add a little (result.c).
 *
 * The noise comes from successive differences, as the tare's did: hum and everything slow are not in it. */
#ifndef WH_RIG_REPEATS_H
#define WH_RIG_REPEATS_H

#include "datasheet.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Hum that is locked to the turn aliases from harmonic 26 on (115 rpm, 50 Hz), with a fifth of its amplitude. */
#define WH_REPEATS_BINS 32U

/* The harmonics. The swing of the speed judges the second (result.h). */
#define WH_REPEATS_FIRST 3U
#define WH_REPEATS_LAST 6U

typedef struct wh_repeats {
    uint32_t samples;   /* of the turns that were merged */
    wh_real changes_N2; /* sum of squared differences of successive samples' residuals */
    wh_real bin_N[WH_REPEATS_BINS]; /* integral of the residual over the angle */
} wh_repeats;

#define wh_repeats_merge WH_NAME(wh_repeats_merge)
#define wh_repeats_power_N2 WH_NAME(wh_repeats_power_N2)

/* The residual at an angle of one turn or so, times the angle for which it stands. */
WH_INLINE void wh_repeats_add(wh_repeats *repeats, wh_real theta_rad, wh_real residual_Nrad) {
    const wh_real bins = (wh_real)WH_REPEATS_BINS;
    const wh_real bin = theta_rad * (bins / WH_RIG_TWO_PI) + bins;
    if (!(WH_ABS(bin) < WH_R(3.0) * bins)) {
        return; /* not a number, for one */
    }
    repeats->bin_N[(uint32_t)(int32_t)bin % WH_REPEATS_BINS] += residual_Nrad;
}

/* Add a turn of so many samples. */
void wh_repeats_merge(wh_repeats *sum, const wh_repeats *turn, uint32_t samples);

/* Square of the amplitude of a harmonic, over so many turns. */
wh_real wh_repeats_power_N2(const wh_repeats *sum, uint32_t turns, unsigned harmonic);

#ifdef __cplusplus
}
#endif

#endif

/* tare.c: the load cell's reading at rest, from noisy samples. */
#include "tare.h"

#include "core/root.h"

void wh_tare_add(wh_tare *tare, wh_real force_N) {
    if (tare->count > 0) {
        const wh_real change = force_N - tare->last_N;
        tare->changes_N2 += change * change;
    }
    tare->last_N = force_N;
    tare->count++;
    const wh_real off = force_N - tare->mean_N;
    tare->mean_N += off / (wh_real)tare->count;
    tare->square_N2 += off * (force_N - tare->mean_N);
}

WH_CALLED wh_real wh_tare_error_N(const wh_tare *tare) {
    if (tare->count < 2U) {
        return WH_R(0.0);
    }
    const wh_real n = (wh_real)tare->count;
    return WH_SQRT(tare->square_N2 / (n * (n - WH_R(1.0))));
}

bool wh_tare_is_still(const wh_tare_config *config, const wh_tare *tare) {
    if (tare->count < 2U) {
        return false;
    }
    const wh_real n1 = (wh_real)(tare->count - 1U);
    const wh_real variance = tare->square_N2 / n1;
    const wh_real noise = WH_R(0.5) * tare->changes_N2 / n1;
    /* of 250 samples of noise alone the one is within 30 % of the other, at five standard deviations */
    return variance <= WH_R(2.0) * noise + config->still_N * config->still_N &&
           wh_tare_error_N(tare) <= config->most_N;
}

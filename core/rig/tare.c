/* tare.c: the load cell's reading at rest, from noisy samples. */
#include "tare.h"

#include "core/root.h"

/* Four times the variance of a mean with triangular weights: 2/3 of the samples' over a block's number of them. */
#define SLOW_NOISE (WH_R(8.0) / (WH_R(3.0) * (wh_real)WH_TARE_BLOCK))

/* A block is full: the mean of this one and the one before, with triangular weights. */
static void end_block(wh_tare *tare) {
    if (tare->count > WH_TARE_BLOCK) {
        const wh_real mean = (tare->before_N + tare->falls_N) / (wh_real)WH_TARE_BLOCK;
        const wh_real off = mean - tare->slow_N;
        tare->means++;
        tare->slow_N += off / (wh_real)tare->means;
        tare->slow_N2 += off * (mean - tare->slow_N);
    }
    tare->before_N = tare->rises_N;
    tare->rises_N = tare->falls_N = WH_R(0.0);
}

void wh_tare_add(wh_tare *tare, wh_real force_N) {
    if (tare->count > 0) {
        const wh_real change = force_N - tare->last_N;
        tare->changes_N2 += change * change;
    }
    tare->last_N = force_N;
    const wh_real weight =
        ((wh_real)(tare->count % WH_TARE_BLOCK) + WH_R(0.5)) / (wh_real)WH_TARE_BLOCK;
    tare->rises_N += weight * force_N;
    tare->falls_N += (WH_R(1.0) - weight) * force_N;
    tare->count++;
    if (tare->count % WH_TARE_BLOCK == 0) {
        end_block(tare);
    }
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
    if (tare->means < 3U) {
        return false;
    }
    const wh_real slow = tare->slow_N2 / (wh_real)(tare->means - 1U);
    const wh_real noise = WH_R(0.5) * tare->changes_N2 / (wh_real)(tare->count - 1U);
    return slow <= SLOW_NOISE * noise + config->still_N * config->still_N &&
           wh_tare_error_N(tare) <= config->most_N;
}

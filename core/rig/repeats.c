/* repeats.c: the part of the load's residual that repeats from turn to turn. */
#include "repeats.h"

#define PI WH_R(3.141592653589793)

void wh_repeats_merge(wh_repeats *sum, const wh_repeats *turn, uint32_t samples) {
    sum->samples += samples;
    sum->changes_N2 += turn->changes_N2;
    for (unsigned i = 0; i < WH_REPEATS_BINS; i++) {
        sum->bin_N[i] += turn->bin_N[i];
    }
}

/* Goertzel's recurrence (American Mathematical Monthly 65 (1958) 34). */
wh_real wh_repeats_power_N2(const wh_repeats *sum, uint32_t turns, unsigned harmonic) {
    /* 2 cos(2 pi harmonic / 32) */
    static const wh_real factors[] = {WH_R(1.6629392246), WH_R(1.4142135624), WH_R(1.1111404660),
                                      WH_R(0.7653668647)};
    const wh_real factor = factors[harmonic - WH_REPEATS_FIRST];
    wh_real last = WH_R(0.0);
    wh_real before = WH_R(0.0);
    for (unsigned i = 0; i < WH_REPEATS_BINS; i++) {
        const wh_real now = sum->bin_N[i] + factor * last - before;
        before = last;
        last = now;
    }
    const wh_real per = WH_R(1.0) / (PI * (wh_real)turns);
    return per * per * (last * last + before * before - factor * last * before);
}

/* wave.h: sine and cosine of an angle. */
#ifndef WH_RIG_WAVE_H
#define WH_RIG_WAVE_H

#include "core/angle.h"

#ifdef __cplusplus
extern "C" {
#endif

WH_SHARED wh_wave wh_wave_at(wh_phase phase) {
    wh_wave both;
    wh_sincos(phase, &both.sine, &both.cosine);
    return both;
}

WH_SHARED wh_wave wh_wave_of(wh_real rad) { return wh_wave_at(wh_phase_from_rad(rad)); }

#ifdef __cplusplus
}
#endif

#endif

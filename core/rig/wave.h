/* wave.h: sine and cosine of an angle, which the rig asks for in many places. */
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

/* The phase of radians: as wh_phase_from_rad() has it, in whose place a call stands where flash is short. */
#if WH_SMALL
WH_INLINE wh_phase wh_phase_at(wh_real rad) { return wh_phase_of(wh_angle_from_rad(rad)); }
#else
WH_INLINE wh_phase wh_phase_at(wh_real rad) { return wh_phase_from_rad(rad); }
#endif

WH_SHARED wh_wave wh_wave_of(wh_real rad) { return wh_wave_at(wh_phase_at(rad)); }

#ifdef __cplusplus
}
#endif

#endif

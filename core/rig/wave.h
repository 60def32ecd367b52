/* wave.h: sine and cosine of an angle, as a call: the rig asks for them in places enough, and its flash is small. */
#ifndef WH_RIG_WAVE_H
#define WH_RIG_WAVE_H

#include "core/angle.h"

#ifdef __cplusplus
extern "C" {
#endif

#define wh_wave_at WH_NAME(wh_wave_at)
#define wh_wave_of WH_NAME(wh_wave_of)

wh_wave wh_wave_at(wh_phase phase);
wh_wave wh_wave_of(wh_real rad);

/* The phase of radians: as wh_phase_from_rad() has it, in whose place a call stands here. */
WH_INLINE wh_phase wh_phase_at(wh_real rad) { return wh_phase_of(wh_angle_from_rad(rad)); }

#ifdef __cplusplus
}
#endif

#endif

/* polar.h: amplitude and phase from a cosine and a sine component. */
#ifndef WH_RIG_POLAR_H
#define WH_RIG_POLAR_H

#include "core/angle.h"
#include "core/real.h"

WH_C_BEGIN

WH_SHARED wh_wave wh_wave_at(wh_phase phase) {
    wh_wave both;
    wh_sincos(phase, &both.sine, &both.cosine);
    return both;
}

WH_SHARED wh_wave wh_wave_of(wh_real rad) { return wh_wave_at(wh_phase_from_rad(rad)); }

/* Radius and angle (-pi ... pi) of the point (x, y), without square root and arc tangent. (0, 0) gives 0 and 0.
 *
 * wh_polar_begin() returns a first guess of the angle. Then come WH_POLAR_ROUNDS rounds of correction, in one call or
 * several. The tangent t of the guess's error is at most 1. Each round reduces it to about t^5/5, so four rounds are
 * more than enough. */
#define WH_POLAR_ROUNDS 4U
wh_real wh_polar_begin(wh_real x, wh_real y);
void wh_polar_rounds(wh_real x, wh_real y, unsigned rounds, wh_real *radius, wh_real *angle_rad);

WH_INLINE void wh_polar(wh_real x, wh_real y, wh_real *radius, wh_real *angle_rad) {
    *angle_rad = wh_polar_begin(x, y);
    wh_polar_rounds(x, y, WH_POLAR_ROUNDS, radius, angle_rad);
}

WH_C_END

#endif

/* polar.h: amplitude and phase of what has a cosine's and a sine's part. */
#ifndef WH_RIG_POLAR_H
#define WH_RIG_POLAR_H

#include "core/real.h"

#ifdef __cplusplus
extern "C" {
#endif

#define wh_polar WH_NAME(wh_polar)

/* x = radius cos(angle), y = radius sin(angle) without square root and arc tangent: the angle is
 * improved with the core's own sine until y vanishes in the turned frame. angle_rad: -pi ... pi.
 * (0, 0) gives 0 and 0. */
void wh_polar(wh_real x, wh_real y, wh_real *radius, wh_real *angle_rad);

#ifdef __cplusplus
}
#endif

#endif

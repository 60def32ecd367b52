/* polar.c: amplitude and phase of what has a cosine's and a sine's part. */
#include "polar.h"

#include "core/angle.h"

#define PI WH_R(3.141592653589793)

void wh_polar(wh_real x, wh_real y, wh_real *radius, wh_real *angle_rad) {
    wh_real angle = WH_R(0.0);
    if (WH_ABS(y) > WH_ABS(x)) {
        angle = y < WH_R(0.0) ? WH_R(-0.5) * PI : WH_R(0.5) * PI;
    } else if (x < WH_R(0.0)) {
        angle = y < WH_R(0.0) ? -PI : PI;
    }
    wh_real along = WH_R(0.0);
    /* |t| <= 1 at first and each round takes it to about its fifth power: four are plenty */
    for (unsigned round = 0; round < 4; round++) {
        wh_real sine;
        wh_real cosine;
        wh_sincos(wh_phase_from_rad(angle), &sine, &cosine);
        along = x * cosine + y * sine;
        if (!(along > WH_R(0.0))) {
            break;
        }
        const wh_real t = (y * cosine - x * sine) / along;
        angle += t * (WH_R(1.0) - t * t * (WH_R(1.0) / WH_R(3.0)));
    }
    *radius = along;
    *angle_rad = angle;
}

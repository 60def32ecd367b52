/* polar.c: amplitude and phase from a cosine and a sine component. */
#include "polar.h"

#define PI WH_R(3.141592653589793)

wh_real wh_polar_begin(wh_real x, wh_real y) {
    if (WH_ABS(y) > WH_ABS(x)) {
        return y < WH_R(0.0) ? WH_R(-0.5) * PI : WH_R(0.5) * PI;
    }
    if (x < WH_R(0.0)) {
        return y < WH_R(0.0) ? -PI : PI;
    }
    return WH_R(0.0);
}

void wh_polar_rounds(wh_real x, wh_real y, unsigned rounds, wh_real *radius, wh_real *angle_rad) {
    wh_real angle = *angle_rad;
    wh_real along = WH_R(0.0);
    for (unsigned round = 0; round < rounds; round++) {
        const wh_wave u = wh_wave_of(angle);
        along = x * u.cosine + y * u.sine;
        if (!(along > WH_R(0.0))) {
            break;
        }
        const wh_real t = (y * u.cosine - x * u.sine) / along;
        angle += t * (WH_R(1.0) - t * t * (WH_R(1.0) / WH_R(3.0)));
    }
    *radius = along;
    *angle_rad = angle;
}

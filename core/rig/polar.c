/* polar.c: amplitude and phase of what has a cosine's and a sine's part. */
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

void wh_polar(wh_real x, wh_real y, wh_real *radius, wh_real *angle_rad) {
    *angle_rad = wh_polar_begin(x, y);
    wh_polar_rounds(x, y, WH_POLAR_ROUNDS, radius, angle_rad);
}

/* sincos_small.h: sin d and cos d - 1 by two short polynomials, to rotate a sine-cosine pair. Part of stage_turn.h. */
#ifndef WH_SINCOS_SMALL_H
#define WH_SINCOS_SMALL_H

#ifdef __cplusplus
#error \
    "core/number/sincos_small.h is C only, for generated .c files: in C++ include core/scene.h and the generated headers"
#endif

#include "sine.h"

/* Largest angle of a small rotation, rad. */
#define WH_SINCOS_SMALL WH_R(0.5)

/* Maximum number of halvings of a rotation: enough for 2^15 rad. */
#define WH_SINCOS_HALVINGS 16U

/* Returns sin d and cos d - 1 for |d| <= 1/2. Before rounding, the sine's error is at most 4.1e-8 in float and 7e-18 in
 * double, and the cosine's is at most 1.9e-9 in float and 2e-19 in double. */
WH_INLINE_WITH_FPU wh_wave wh_sincos_small(wh_real d) {
    const wh_real z = d * d;
    wh_wave turn;
#if WH_DOUBLE
    turn.sine = d + d * z *
                        (-0.16666666666666 +
                         z * (0.0083333333330238924 +
                              z * (-0.0001984126934116413 +
                                   z * (2.7556952900446698e-06 + z * -2.4927410423791707e-08))));
    turn.cosine =
        z * (-0.5 + z * (0.04166666666666596 +
                         z * (-0.0013888888888601047 +
                              z * (2.480158687820224e-05 +
                                   z * (-2.7557030226024543e-07 + z * 2.078364892532402e-09)))));
#else
    turn.sine = d + d * z * (-0.16666032f + z * 0.008259796f);
    turn.cosine = z * (-0.5f + z * (0.041665776f + z * -0.0013792582f));
#endif
    return turn;
}

/* Like wh_sincos_small(), for |d| <= 2^15: halves d until it is small, then doubles the rotation as often. The error is
 * at most 7e-7 |d| in float and 1.3e-15 |d| in double. If `surely`, |d| is above WH_SINCOS_SMALL. */
WH_INLINE_WITH_FPU WH_COLD wh_wave wh_sincos_far(wh_real d, bool surely) {
    unsigned doublings = 0;
    if (surely || WH_ABS(d) > WH_SINCOS_SMALL) {
        do {
            d *= WH_R(0.5);
            doublings++;
        } while (WH_ABS(d) > WH_SINCOS_SMALL && doublings < WH_SINCOS_HALVINGS);
    }
    wh_wave turn = wh_sincos_small(d);
    if (surely || doublings > 0) {
        do {
            const wh_real less = turn.cosine;
            turn.sine = WH_R(2.0) * (turn.sine + turn.sine * less);
            turn.cosine = WH_R(2.0) * less * (WH_R(2.0) + less);
        } while (--doublings > 0);
    }
    return turn;
}

#define wh_sincos_far_called WH_NAME(wh_sincos_far_called)
wh_wave wh_sincos_far_called(wh_real d);

#endif

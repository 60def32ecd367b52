/* free_rotor.h: a rotor under gravity and friction alone, and the derivatives of its motion with respect to its causes.
 *
 *     q'' = -g sin q - f sign q' - c q'          q its angle from hanging; g = S g/I, f and c friction over I
 *
 * Stoermer's steps: drift, kick, drift, forwards in time or backwards. Friction changes sign with the motion within the
 * step. There the rate has a kink, and the derivatives are multiplied with the ratio of the accelerations after and
 * before. */
#ifndef WH_RIG_FREE_ROTOR_H
#define WH_RIG_FREE_ROTOR_H

#include "core/real.h"
#include "datasheet.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The causes of the motion: initial q and q', g, f, c. */
enum { WH_FREE_Q, WH_FREE_RATE, WH_FREE_GRAVITY, WH_FREE_FRICTION, WH_FREE_DRAG, WH_FREE_CAUSES };

typedef struct wh_free_rotor {
    wh_real q_rad; /* -pi ... pi */
    wh_real rate_radps;
    wh_real q_by[WH_FREE_CAUSES]; /* derivatives */
    wh_real rate_by[WH_FREE_CAUSES];
} wh_free_rotor;

#define wh_free_rotor_start WH_NAME(wh_free_rotor_start)
#define wh_free_rotor_step WH_NAME(wh_free_rotor_step)

void wh_free_rotor_start(wh_free_rotor *rotor, wh_real q_rad, wh_real rate_radps);

/* A step of h seconds, forwards or (h < 0) backwards, much shorter than a swing. `cause` has g, f and c in its places. */
void wh_free_rotor_step(const wh_real *cause, wh_free_rotor *rotor, wh_real h);

/* Wrap into -pi ... pi, from less than a turn beyond; 0 for larger angles and NaN. */
WH_SHARED wh_real wh_free_angle(wh_real rad) {
    const wh_real half = WH_R(0.5) * WH_RIG_TWO_PI;
    const wh_real near = rad > half ? rad - WH_RIG_TWO_PI : rad < -half ? rad + WH_RIG_TWO_PI : rad;
    return near >= -half && near <= half ? near : WH_R(0.0);
}

#ifdef __cplusplus
}
#endif

#endif

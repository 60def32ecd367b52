/* gravity_compensation.h: feed-forward of gravity's torque to the motor.
 *
 * Gravity's torque on arms in a vertical plane is -S g sin(theta - gamma). S is the sum of mass times radius, gamma the
 * direction of gravity. Without compensation, gravity varies the speed omega by the fraction E = S g/(I omega^2). The
 * observer predicts theta for the time lead_ticks from now. lead_ticks is half a control step (zero-order hold), plus
 * the delays of computing and of the motor's inductance. */
#ifndef WH_RIG_GRAVITY_COMPENSATION_H
#define WH_RIG_GRAVITY_COMPENSATION_H

#include "observer.h"

WH_C_BEGIN

typedef struct wh_compensation_config {
    wh_real weight_Nm;   /* S g: the largest torque of gravity */
    wh_real gravity_rad; /* gamma: the angle at which the arms hang */
    wh_real stall_Nm;    /* motor torque at standstill and rated voltage, > 0 */
    uint32_t lead_ticks; /* theta is predicted this far ahead */
    wh_real fade_s;      /* duration of the fade-in; 0: no fade-in */
    wh_real most;        /* limit of the result, a multiple of the rated voltage, >= 0 */
} wh_compensation_config;

typedef struct wh_compensation {
    wh_real part; /* the present factor of the fade-in, from 0 to 1; initially 0 */
} wh_compensation;

#define WH_COMPENSATION_STANDARD \
    { \
        .weight_Nm = WH_RIG_UNBALANCE_KGM * WH_RIG_GRAVITY_MPS2, .stall_Nm = WH_RIG_STALL_NM, \
        .lead_ticks = 3000, .fade_s = WH_R(0.5), .most = WH_R(0.3), \
    }
extern const wh_compensation_config wh_compensation_standard;

/* Does one control step of step_s seconds; call it after the observer's step. Returns the voltage to add to the drive's
 * voltage, as a multiple of the rated voltage. Returns 0 if the voltage is NaN, or while the observer is not valid. The
 * voltage fades in after the observer has become valid. */
wh_real wh_compensation_step(const wh_compensation_config *config, wh_compensation *compensation,
                             const wh_observer *observer, uint32_t now_ticks, wh_real step_s);

WH_C_END

#endif

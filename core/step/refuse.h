/* refuse.h: bounds on a mechanism's numbers; a step that exceeds them is refused. Part of step_end.h. */
#ifndef WH_REFUSE_H
#define WH_REFUSE_H

#ifdef __cplusplus
#error \
    "core/step/refuse.h is C only, for generated .c files: in C++ include core/scene.h and the generated headers"
#endif

#include "../state.h"

/* Limit on linear positions and rates. */
#define WH_ABSURD WH_R(1e15)

/* True for finite numbers within the limit; false for NaN. */
WH_INLINE bool wh_believable(wh_real value, wh_real limit) { return WH_ABS(value) < limit; }

WH_INLINE wh_status wh_refuse(wh_state *state, unsigned fault) {
    state->fault = (int)fault;
    return WH_E_DIVERGED;
}

/* wh_refuse_first() (step_end.h) for n = 2 to 4, and for n = 5 to 8. Arguments after the first n are ignored. */
#define wh_refuse_four WH_NAME(wh_refuse_four)
#define wh_refuse_eight WH_NAME(wh_refuse_eight)
wh_status wh_refuse_four(wh_state *state, unsigned first, unsigned n, wh_real a, wh_real b,
                         wh_real c, wh_real d);
wh_status wh_refuse_eight(wh_state *state, unsigned first, unsigned n, wh_real a, wh_real b,
                          wh_real c, wh_real d, wh_real e, wh_real f, wh_real g, wh_real h);

#endif

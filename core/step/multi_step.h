/* multi_step.h: many steps in one call, with the state in registers between them. Part of step.h. Compiled only if
 * WH_MULTI_STEP is 1, because it is a second copy of the step. */
#ifndef WH_MULTI_STEP_H
#define WH_MULTI_STEP_H

#include "../scene.h"
#include "unroll.h"

/* With ira-loop-pressure, gcc loads as many constants before the loop as fit into registers. */
#if defined(WH_MULTI_STEP) && WH_MULTI_STEP && defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("ira-loop-pressure")
#if defined(WH_WAVES) && WH_WAVES <= 1
#pragma GCC optimize("no-gcse")
#endif
/* With tree-ter, gcc computes an expression just before its use, and the use waits for the result. */
#if defined(WH_COORDS) && WH_COORDS <= 1
#pragma GCC optimize("no-tree-ter")
#endif
#endif

/* Calls one() `steps` times, or until one() fails; steps > 0. Returns what wh_scene_steps() returns. */
WH_INLINE wh_status wh_multi_step(const wh_scene *of,
                                  wh_status (*one)(const wh_scene *of, wh_state *state),
                                  unsigned angles, unsigned reals, bool compensated,
                                  wh_state *state, uint32_t steps) {
    wh_angle angle[WH_COORDS];
    wh_real real[2 * WH_COORDS];
    wh_real carry[2 * WH_COORDS];
    wh_state now = {0, angle, real, carry, state->input, NULL, NULL, NULL, -1};
    uint32_t left = steps;
    wh_status status;
    WH_UNROLL
    for (unsigned i = 0; i < angles; i++) {
        angle[i] = state->angle[i];
    }
    WH_UNROLL
    for (unsigned i = 0; i < reals; i++) {
        real[i] = state->real[i];
    }
    if (compensated) {
        WH_UNROLL
        for (unsigned i = 0; i < angles + reals; i++) {
            carry[i] = state->carry[i];
        }
    }
    do {
        status = one(of, &now);
        if (status != WH_OK) {
            state->fault = now.fault;
            break;
        }
    } while (--left > 0);
    WH_UNROLL
    for (unsigned i = 0; i < angles; i++) {
        state->angle[i] = angle[i];
    }
    WH_UNROLL
    for (unsigned i = 0; i < reals; i++) {
        state->real[i] = real[i];
    }
    if (compensated) {
        WH_UNROLL
        for (unsigned i = 0; i < angles + reals; i++) {
            state->carry[i] = carry[i];
        }
    }
    state->steps += steps - left;
    return status;
}

#endif

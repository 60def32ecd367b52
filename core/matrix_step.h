/* matrix_step.h: a whole step as one constant matrix, of a scene that is linear: x+ = Phi x + Gamma u + g.
 *
 * The scene's list computes the products; what is 0 is left out there, what is 1 costs no product. Where a step hardly
 * changes a component, x+ = x + ((Phi - 1) x + Gamma u + g): rounding the entries of Phi - 1, not those of Phi, is a small
 * part of the change and not of the state. Bounds, statuses and turn angles are those of every step (step_end.h).
 */
#ifndef WH_MATRIX_STEP_H
#define WH_MATRIX_STEP_H

#ifdef __cplusplus
#error \
    "core/matrix_step.h is C only, as generated .c files are: C++ includes core/scene.h and generated headers"
#endif

#include "ahead.h"
#include "arithmetic.h"
#include "step_end.h"

/* One step of h, from the list `matrix`, which is called as accelerations are, but without phases. The rates are behind
 * `rates_at` other reals (second order; else it does not matter). The list gives, of the
 *
 *     angles             the mean rate over the step
 *     reals              where they stand after it; compensated, by how much they change
 *     reals once more    compensated: what rounding the constants to float takes from that
 *
 * angles <= WH_COORDS, reals <= 2 WH_COORDS. Returns WH_OK, or WH_E_DIVERGED with state->fault set and the rest of the
 * state as it was. */
WH_INLINE wh_status wh_step_matrix(const void *model, wh_accel_fn *matrix, bool compensated,
                                   unsigned angles, unsigned reals, unsigned rates_at, wh_span h,
                                   wh_state *state) {
    wh_real given[5 * WH_COORDS];
    wh_trial trial = {0};
    matrix(model, NULL, state->real, state->real + rates_at, state->input, given);
    WH_REFUSE_FAR(wh_angles_move(given, h, h.s, compensated, angles, state, &trial));
    WH_UNROLL
    for (unsigned i = 0; i < reals; i++) {
        if (compensated) {
            wh_real *carry = &trial.carry[angles + i];
            *carry = state->carry[angles + i];
            if (!WH_DOUBLE) {
                *carry += given[angles + reals + i];
            }
            trial.real[i] = wh_sum(state->real[i], given[angles + i], true, carry);
        } else {
            trial.real[i] = given[angles + i];
        }
    }
    return wh_accept(&trial, angles, reals, compensated, state);
}

#endif

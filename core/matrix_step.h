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

/* As wh_all_believable(). Without floating-point arithmetic in the processor, sizes are compared by their bits: a tenth of
 * what three sums and a comparison take on an ATmega328P. */
WH_INLINE bool wh_matrix_believable(const wh_real *value, unsigned n) {
#if WH_SOFT_FLOAT && !WH_DOUBLE
    /* the upper byte of 2^39: what is below cannot sum up to WH_ABSURD */
    static const uint8_t large = 0x53;
    unsigned i = 0;
    for (; i < n; i++) {
        const union {
            wh_real value;
            uint32_t bits;
        } size = {value[i]};
        if (((uint8_t)(size.bits >> 24) & 0x7fU) >= large) {
            break;
        }
    }
    if (i == n) {
        return true;
    }
#endif
    return wh_all_believable(value, n);
}

/* Take over what a list gave of a scene without turn angles and low parts, or refuse the step. */
WH_INLINE wh_status wh_matrix_accept(const wh_real *given, unsigned reals, wh_state *state) {
    if (!wh_matrix_believable(given, reals)) {
        return wh_refuse_among(given, reals, 0, state);
    }
    WH_UNROLL
    for (unsigned i = 0; i < reals; i++) {
        state->real[i] = given[i];
    }
    return WH_OK;
}

/* value + increment + *carry, which is replaced by what rounding took from both sums. Most of *carry is whole units of the
 * increment's last place, as what was taken before is; what the constants' rounding adds is less than half of one, so that
 * wh_sum() would lose it in every step: 2.5e-5 rad in 1e6 steps of an oscillator, where so it is 5e-8. */
WH_INLINE wh_real wh_matrix_sum(wh_real value, wh_real increment, wh_real *carry) {
    const wh_real wanted = increment + *carry;
    const wh_real of_carry = wanted - increment;
    const wh_real lost = (increment - (wanted - of_carry)) + (*carry - of_carry);
    const wh_real sum = value + wanted;
    *carry = (wanted - (sum - value)) + lost;
    return sum;
}

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
    wh_real given[4 * WH_COORDS];
    matrix(model, NULL, state->real, state->real + rates_at, state->input, given);
    if (angles == 0 && !compensated) {
        return wh_matrix_accept(given, reals, state);
    }
    wh_trial trial = {0};
    wh_carry_begin(state, compensated, angles, &trial);
    WH_REFUSE_FAR(wh_angles_move(given, h, h.s, compensated, angles, state, &trial));
    WH_UNROLL
    for (unsigned i = 0; i < reals; i++) {
        if (compensated) {
            wh_real *carry = &trial.carry[angles + i];
            *carry = state->carry[angles + i];
            if (!WH_DOUBLE) {
                *carry += given[angles + reals + i];
            }
            trial.real[i] = wh_matrix_sum(state->real[i], given[angles + i], carry);
        } else {
            trial.real[i] = given[angles + i];
        }
    }
    return wh_accept(&trial, angles, reals, compensated, state);
}

#endif

/* matrix_step.h: a whole step of a linear scene as one constant matrix: x+ = Phi x + Gamma u + g. The scene's operation
 * list computes the products, except those by 0 and 1. If a diagonal entry of Phi is near 1, the list adds the change
 * (Phi - 1) x + Gamma u + g to x, to reduce the round-off. step_end.h handles bounds, statuses and turn angles. */
#ifndef WH_MATRIX_STEP_H
#define WH_MATRIX_STEP_H

#include "../number/arithmetic.h"
#include "multi_step.h"
#include "step_end.h"

/* Returns as wh_all_believable(). Without an FPU, compares bytes first: ten times as fast on an ATmega328P. */
WH_INLINE bool wh_matrix_believable(const wh_real *value, unsigned n) {
#if WH_SOFT_FLOAT && !WH_DOUBLE
    /* the upper byte of 2^39: the sum of n numbers below 2^39 is below WH_ABSURD */
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

/* Makes given[reals] the new state, or refuses the step. The scene must have neither turn angles nor carries. */
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

/* Returns value + increment + *carry; *carry becomes the round-off of both sums. wh_sum() would lose the round-off
 * of increment + *carry: 2.5e-5 rad in 1e6 steps of an oscillator. This sum loses 5e-8 rad. */
WH_INLINE wh_real wh_matrix_sum(wh_real value, wh_real increment, wh_real *carry) {
    const wh_real wanted = increment + *carry;
    const wh_real of_carry = wanted - increment;
    const wh_real lost = (increment - (wanted - of_carry)) + (*carry - of_carry);
    const wh_real sum = value + wanted;
    *carry = (wanted - (sum - value)) + lost;
    return sum;
}

/* Does one step of h by the operation list `matrix`, a wh_accel_fn that does not use the phases. In a second-order
 * scene, `rates_at` is the index of the first rate in the reals. The list's results are, in this order:
 *
 *      [angles]    mean rate of each angle over the step
 *      [reals]     the reals after the step; if compensated, the changes of the reals
 *      [reals]     if compensated, and in float: addends for the carries
 *
 * angles <= WH_COORDS, reals <= 2 WH_COORDS. Returns WH_OK, or WH_E_DIVERGED with state->fault set and the rest of the
 * state unchanged. */
WH_INLINE wh_status wh_step_matrix(const void *model, wh_accel_fn *matrix, bool compensated,
                                   unsigned angles, unsigned reals, unsigned rates_at,
                                   wh_two_part h, wh_state *state) {
    wh_real given[4 * WH_COORDS];
    matrix(model, NULL, state->real, state->real + rates_at, state->input, given);
    if (angles == 0 && !compensated) {
        return wh_matrix_accept(given, reals, state);
    }
    wh_trial trial = {0};
    wh_carry_begin(state, compensated, angles, &trial);
    WH_REFUSE_FAR(wh_angles_move(given, h, h.high, compensated, angles, state, &trial));
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

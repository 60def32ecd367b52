/* stabilize.h: energy stabilization by small corrections along the rates, for long runs, in which the method's error or
 * round-off would accumulate. Part of ledger_step.h.
 *
 * The drift D is the energy's change minus all its entries in the ledger (ledger.h) except that of the corrections: the
 * error that remains. P is sum q_i' p_i, with the momenta p_i. If the kinetic energy is a quadratic form of the rates,
 * scaling all rates by 1 + s changes the energy by s P. So each step scales them with
 *
 *      s = -D / (1024 max P),     at most 2^-20 in size.
 *
 * This has the form x' = f(x) - g F(x) D(x), with a gain g and the correction's direction F, here along the rates
 * (Ascher, Chin & Reich, Stabilization of DAEs and invariant manifolds, Numerische Mathematik 67, 1994). A step
 * corrects only a thousandth of D, because in float D is mostly round-off, which a thousand steps average. max P is the
 * largest P so far: with the present P, s would grow whenever an oscillation reverses.
 *
 * A correction changes all motions, because D does not show which of them lost the energy. The method is for motions
 * without drive and damping. In others, D includes the quadrature error of the ledger. */
#ifndef WH_STABILIZE_H
#define WH_STABILIZE_H

#include <stddef.h>

#include "../ledger.h"
#include "refuse.h"

/* The share of the drift that a step corrects (2^-10), and the largest relative change of the rates (2^-20). */
#define WH_STABILIZE_SHARE WH_R(0.0009765625)
#define WH_STABILIZE_MOST WH_R(9.5367431640625e-7)

/* Call this after a step whose entries are complete. `level` [form->accounts] is working space. */
WH_INLINE void wh_stabilize(const wh_ledger_form *form, wh_state *state, wh_real *level) {
    wh_real *most = wh_ledger_most(form, state);
    if (state->steps == 0) { /* the first step starts the ledger */
        *most = WH_R(0.0);
        return;
    }
    const unsigned n = form->coordinates;
    const bool compensated = state->carry != NULL;
    wh_real *rate = state->real + (n - form->angles);
    wh_real *total = state->ledger + wh_ledger_of_stabilized(form);
    wh_real *rest = total + form->entries;
    const wh_real drift = wh_ledger_error(form, state, 0, level) + (*total + *rest);
    wh_real gain = WH_R(0.0); /* P, in joules */
    for (unsigned i = 0; i < n; i++) {
        gain += rate[i] * level[1 + i];
    }
    *most = gain > *most ? gain : *most;
    if (!(gain > WH_R(0.0)) || !(WH_ABS(drift) < WH_ABSURD)) {
        return;
    }
    wh_real part = -drift * WH_STABILIZE_SHARE / *most;
    part = part > WH_STABILIZE_MOST ? WH_STABILIZE_MOST
                                    : (part < -WH_STABILIZE_MOST ? -WH_STABILIZE_MOST : part);
    wh_real given = WH_R(0.0);
    for (unsigned i = 0; i < n; i++) {
        const wh_real before = rate[i];
        const wh_real more = part * before;
        wh_real unused = WH_R(0.0);
        rate[i] = wh_sum(before, more, compensated, compensated ? &state->carry[n + i] : &unused);
        given += level[1 + i] * (compensated ? more : rate[i] - before);
    }
    *total = wh_sum(*total, given, true, rest);
}

#endif

/* stabilize.h: what the energy drifts by is given back along the rates, a little in every step, for runs so long that a
 * method's own error, or rounding's, would sum up. Part of ledger_step.h.
 *
 * The books say by how much the energy has changed more than what went in and out (ledger.h): the drift D, in which what was
 * given back before does not count. Rates that are all made longer by a part s change the energy by s P, P = sum q_i' p_i with
 * the momenta p_i, where the kinetic energy is a quadratic form of the rates; and the directions of motion, what stands still
 * and the ratios of momenta stay. So each step sets
 *
 *     s = -D / (1024 max P),     at most 2^-20 in size,
 *
 * which is x' = f(x) - g F(x) D(x) with F along the rates (Ascher, Chin & Reich, Stabilization of DAEs and invariant manifolds,
 * Numerische Mathematik 67, 1994). A thousandth of the drift, and not all of it, for a float's D is noise of its last digits:
 * that is averaged over a thousand steps, and the rest goes into the carries of compensated sums. max P is the most that P has
 * been, so that s is the same where a swing turns back: of the P of that moment, a small one, all would be given to what is
 * slow and goes on.
 *
 * One number says nothing of where energy was lost: what a fast motion lost is given to all. So what is given back is an entry of
 * the books, and to be looked at as the loss that it makes up for. It is for motions that nothing drives or damps: elsewhere D
 * is also what the books' own rule errs by, of which the motion knows nothing.
 */
#ifndef WH_STABILIZE_H
#define WH_STABILIZE_H

#ifdef __cplusplus
#error \
    "core/stabilize.h is C only, as generated .c files are: C++ includes core/scene.h and generated headers"
#endif

#include <stddef.h>

#include "ledger.h"
#include "refuse.h"

/* Part of the drift that a step gives back, 2^-10, and the largest part of themselves that rates change by, 2^-20. */
#define WH_STABILIZE_SHARE WH_R(0.0009765625)
#define WH_STABILIZE_MOST WH_R(9.5367431640625e-7)

/* Behind a step and its entries. `level` [form->accounts] is room to work in. */
WH_INLINE void wh_stabilize(const wh_ledger_form *form, wh_state *state, wh_real *level) {
    wh_real *most = wh_ledger_most(form, state);
    if (state->steps == 0) { /* the books begin */
        *most = WH_R(0.0);
        return;
    }
    const unsigned n = form->coordinates;
    const bool compensated = state->carry != NULL;
    wh_real *rate = state->real + (n - form->angles);
    wh_real *total = state->ledger + wh_ledger_of_stabilized(form);
    wh_real *rest = total + form->entries;
    const wh_real drift = wh_ledger_error(form, state, 0, level) + (*total + *rest);
    wh_real gain = WH_R(0.0); /* of energy, where the rates grow by all of themselves */
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

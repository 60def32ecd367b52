/* contact_share.h: how contacts share a load, each within what it can take (see contact.h).
 *
 * A resting stop pushes and does not pull, and what sticks takes no more than its static friction. So the
 * forces of the contacts that hold something solve
 *
 *     a = J M^-1 J^T lambda - wanted,   low <= lambda <= high,
 *     a_k = 0 between the limits, a_k >= 0 at the low one (it gives way), a_k <= 0 at the high one
 *
 * Normal forces do not depend on lambda, so this is a convex problem: its accelerations are unique. Its
 * forces are, too, unless contacts repeat what others hold. It is solved by principal pivoting, the least
 * index first (Murty, Linear Complementarity, Linear and Nonlinear Programming, chapters 2 to 4; Judice &
 * Pires 1994 for limits on both sides). With impulses for forces and rates for accelerations it is the
 * impact's problem. */
#ifndef WH_CONTACT_SHARE_H
#define WH_CONTACT_SHARE_H

#include "contact_ledger.h"

/* Beyond any force: no limit. */
#define WH_LIMITLESS WH_R(1e30)

/* What counts as rounding beside the terms of a sum. */
#define WH_CONTACT_ROUNDING (WH_DOUBLE ? WH_R(1e-11) : WH_R(1e-5))

/* The factor of k's own force in its acceleration: J_k M^-1 J_k^T. */
WH_INLINE wh_real wh_contact_yield(const wh_hybrid *of, const wh_contact_work *w, unsigned k) {
    return wh_along(of, w, k, wh_law(of, w, k) + WH_LAW_ROWS + of->coordinates);
}

/* Solve sum_l (J_k M^-1 J_l^T) amount_l = wanted_k for the `count` contacts in member[], by elimination
 * without pivoting: the matrix is positive definite, but for contacts that repeat what others hold
 * already, which get nothing to do. Returns whether there are such. Those with at[] other than zero get
 * nothing, too; at may be NULL. */
static inline bool wh_contact_solve(const wh_hybrid *of, const wh_contact_work *w,
                                    const uint8_t *member, unsigned count, const int8_t *at,
                                    const wh_real *wanted, wh_real *amount) {
    wh_real matrix[WH_CONTACTS_MAX][WH_CONTACTS_MAX] = {{WH_R(0.0)}};
    bool idle[WH_CONTACTS_MAX] = {false};
    bool repeat = false;
    for (unsigned r = 0; r < count; r++) {
        amount[r] = wanted[r];
        for (unsigned c = 0; c < count; c++) {
            matrix[r][c] = wh_along(of, w, member[r],
                                    wh_law(of, w, member[c]) + WH_LAW_ROWS + of->coordinates);
        }
    }
    for (unsigned p = 0; p < count; p++) {
        const bool fixed = at != NULL && at[p] != 0;
        const bool repeats =
            !(matrix[p][p] > WH_CONTACT_ROUNDING * wh_contact_yield(of, w, member[p]));
        idle[p] = fixed || repeats;
        repeat = repeat || (repeats && !fixed);
        for (unsigned r = p + 1; r < count && !idle[p]; r++) {
            const wh_real factor = matrix[r][p] / matrix[p][p];
            for (unsigned c = p; c < count; c++) {
                matrix[r][c] -= factor * matrix[p][c];
            }
            amount[r] -= factor * amount[p];
        }
    }
    for (unsigned p = count; p-- > 0;) {
        wh_real sum = amount[p];
        for (unsigned c = p + 1; c < count; c++) {
            sum -= matrix[p][c] * amount[c];
        }
        amount[p] = idle[p] ? WH_R(0.0) : sum / matrix[p][p];
    }
    return repeat;
}

/* Between what and what contact k can push; holds, and contacts in `keep`, as bits, have no limits. */
WH_INLINE wh_real wh_contact_high(const wh_hybrid *of, const wh_contact_work *w, unsigned k,
                                  unsigned keep) {
    const bool limited = of->contact[k].kind == WH_FRICTION && (keep >> k & 1U) == 0;
    return limited ? wh_law(of, w, k)[WH_LAW_FIRST] : WH_LIMITLESS;
}

WH_INLINE wh_real wh_contact_low(const wh_hybrid *of, const wh_contact_work *w, unsigned k,
                                 unsigned keep) {
    const bool pushes = of->contact[k].kind == WH_STOP && (keep >> k & 1U) == 0;
    return pushes ? WH_R(0.0) : -wh_contact_high(of, w, k, keep);
}

/* Is contact k's share beyond what it can take? */
WH_INLINE bool wh_contact_exceeds(const wh_hybrid *of, const wh_contact_work *w, unsigned k,
                                  unsigned keep, wh_real amount) {
    return amount < wh_contact_low(of, w, k, keep) || amount > wh_contact_high(of, w, k, keep);
}

/* The forces (or impulses) amount[count] of the contacts in member[] within their limits, and left[count],
 * what they leave of the accelerations (or rates). Returns the contacts that give way, as bits. */
static inline unsigned wh_contact_share(const wh_hybrid *of, const wh_contact_work *w,
                                        const uint8_t *member, unsigned count,
                                        const wh_real *wanted, unsigned keep, wh_real *amount,
                                        wh_real *left) {
    int8_t at[WH_CONTACTS_MAX] = {0}; /* -1, 1: at the low, at the high limit */
    unsigned giving = 0;
    for (unsigned round = 0; round <= 4U * count; round++) {
        wh_real limit[WH_CONTACTS_MAX] = {WH_R(0.0)};
        wh_real need[WH_CONTACTS_MAX] = {WH_R(0.0)};
        wh_real way[WH_COORDS] = {WH_R(0.0)};
        for (unsigned i = 0; i < count; i++) {
            if (at[i] != 0) {
                limit[i] = at[i] < 0 ? wh_contact_low(of, w, member[i], keep)
                                     : wh_contact_high(of, w, member[i], keep);
                wh_push(of, w, member[i], limit[i], way);
            }
        }
        for (unsigned i = 0; i < count; i++) {
            need[i] = wanted[i] - wh_along(of, w, member[i], way);
        }
        (void)wh_contact_solve(of, w, member, count, at, need, amount);
        for (unsigned i = 0; i < count; i++) {
            if (at[i] != 0) {
                amount[i] = limit[i];
            } else {
                wh_push(of, w, member[i], amount[i], way);
            }
        }
        unsigned wrong = count;
        giving = 0;
        for (unsigned i = count; i-- > 0;) {
            const unsigned k = member[i];
            left[i] = WH_R(0.0);
            if (at[i] == 0) {
                wrong = wh_contact_exceeds(of, w, k, keep, amount[i]) ? i : wrong;
                continue;
            }
            const wh_real made = wh_along(of, w, k, way);
            const wh_real rounding =
                WH_CONTACT_ROUNDING *
                (WH_ABS(wanted[i]) + WH_ABS(made) + WH_ABS(amount[i]) * wh_contact_yield(of, w, k));
            left[i] = made - wanted[i];
            const wh_real outwards = at[i] < 0 ? left[i] : -left[i];
            wrong = outwards < -rounding ? i : wrong;
            giving |= outwards > rounding ? 1U << k : 0U;
        }
        if (wrong == count) {
            break;
        }
        at[wrong] = (int8_t)(at[wrong] != 0                                               ? 0
                             : amount[wrong] < wh_contact_low(of, w, member[wrong], keep) ? -1
                                                                                          : 1);
    }
    return giving;
}

#endif

/* contact_lcp.h: forces of contacts with limits, as a linear complementarity problem.
 *
 * A resting stop pushes and does not pull, and a sticking friction takes no more than its static limit. So the forces
 * of the active contacts solve, with the Delassus matrix J M^-1 J^T,
 *
 *      a = J M^-1 J^T lambda - wanted, low <= lambda <= high,
 *      a_k = 0 between the limits, a_k >= 0 at the low limit, a_k <= 0 at the high limit (contact k gives way).
 *
 * Normal forces do not depend on lambda, so the problem is convex. Its accelerations are unique, and so are its forces
 * unless contacts are redundant. In an impact, impulses and rates take the place of forces and accelerations (Moreau;
 * Pfeiffer & Glocker, chapter 8).
 *
 * The method is principal pivoting by least index (Murty, Linear Complementarity, Linear and Nonlinear Programming,
 * chapters 2 to 4; Judice & Pires 1994 for limits on both sides). In the first round all active contacts stay active.
 * If the rows are independent, the matrix is a P-matrix, and the method provably ends. With redundant rows the matrix
 * is only semidefinite, and each redundant contact is tested for a contradiction with the others. The leaving contact
 * is found by a ratio test along the null direction (Keller; Graves; Cottle, Pang & Stone, section 4.2). With these
 * tests the pivoting is not proved to end, so it has at most 4 n + 1 rounds. A step that reaches this limit counts as
 * an overrun. The random problems of tests/core/test_contact_pivot.c stay below it. */
#ifndef WH_CONTACT_LCP_H
#define WH_CONTACT_LCP_H

#include "contact_ledger.h"

/* Stands for "no limit": larger than any force. */
#define WH_LIMITLESS WH_R(1e30)

/* Forces and accelerations below this fraction of the sum of their terms' magnitudes count as zero. Otherwise round-off
 * would release and hit an unloaded resting stop for ever. */
#define WH_CONTACT_QUIET (WH_DOUBLE ? WH_R(1e-13) : WH_R(2e-6))

/* Differences of curvature terms J' q' below this fraction of work->rough count as zero. */
#define WH_CONTACT_CREEP (WH_DOUBLE ? WH_R(1e-22) : WH_R(1e-12))

#define WH_CONTACT_SHOWS WH_R(0.001)

WH_INLINE wh_real wh_contact_rounding(wh_real a, wh_real b, wh_real c) {
    return WH_CONTACT_ROUNDING * (WH_ABS(a) + WH_ABS(b) + WH_ABS(c));
}

typedef struct wh_contact_set {
    const uint8_t *member; /* [count] contact numbers */
    unsigned count;
    const int8_t *at; /* [count] -1: at low limit, 0: between, 1: at high limit; NULL: all 0 */
} wh_contact_set;

/* Sets push[i] to the sign of the part of wanted[i] that the forces do not produce, or to 0. `repeats` has the
 * redundant contacts, as bits of indices i. If impulse[] is not NULL, wanted[] and way[] are changes of rates. */
static inline void wh_contact_contradicts(const wh_contact_system *of, const wh_contact_work *w,
                                          const wh_contact_set *set, unsigned repeats,
                                          const wh_real *impulse, const wh_real *wanted,
                                          const wh_real *way, int8_t *push) {
    const uint8_t *member = set->member;
    const unsigned count = set->count;
    wh_real bend[WH_CONTACTS_MAX] = {WH_R(0.0)};
    wh_real lambda[WH_CONTACTS_MAX];
    wh_real bent[WH_COORDS] = {WH_R(0.0)};
    if (impulse == NULL) {
        for (unsigned i = 0; i < count; i++) {
            bend[i] = -wh_contact_law(of, w, member[i])[WH_LAW_BIAS];
        }
        (void)wh_delassus_solve(of, w, member, count, set->at, bend, lambda);
        for (unsigned i = 0; i < count; i++) {
            wh_contact_apply(of, w, member[i], lambda[i], bent);
        }
    }
    for (unsigned i = 0; i < count; i++) {
        push[i] = 0;
        if ((repeats >> i & 1U) != 0) {
            wh_real size = impulse == NULL ? w->rough[member[i]] : WH_ABS(wanted[i]);
            for (unsigned l = 0; l < count && impulse != NULL; l++) {
                size += WH_ABS(wh_delassus(of, w, member[i], member[l]) * impulse[l]);
            }
            const wh_real made = wh_jacobian_times(of, w, member[i], way);
            const wh_real missing = wanted[i] - made;
            const wh_real made_bent = wh_jacobian_times(of, w, member[i], bent);
            const wh_real missing_bend = bend[i] - made_bent;
            wh_real bends_by = WH_R(0.0); /* sum of |terms| of made_bent */
            for (unsigned l = 0; l < count && impulse == NULL; l++) {
                bends_by += WH_ABS(wh_delassus(of, w, member[i], member[l]) * lambda[l]);
            }
            const bool plain = WH_ABS(missing) > wh_contact_rounding(size, made, WH_R(0.0));
            const bool bends =
                WH_ABS(missing_bend) > wh_contact_rounding(bend[i], made_bent, bends_by) &&
                WH_ABS(missing_bend) > WH_CONTACT_CREEP * size;
            const wh_real short_of = plain ? missing : bends ? missing_bend : WH_R(0.0);
            push[i] = (int8_t)((short_of > WH_R(0.0)) - (short_of < WH_R(0.0)));
        }
    }
}

WH_INLINE wh_real wh_contact_high(const wh_contact_system *of, const wh_contact_work *w,
                                  unsigned k) {
    return wh_contact_is(of, k, WH_LIMITED) ? wh_contact_law(of, w, k)[WH_LAW_FIRST] : WH_LIMITLESS;
}

WH_INLINE wh_real wh_contact_low(const wh_contact_system *of, const wh_contact_work *w,
                                 unsigned k) {
    return wh_contact_is(of, k, WH_UNILATERAL) ? WH_R(0.0) : -wh_contact_high(of, w, k);
}

WH_INLINE bool wh_contact_exceeds(const wh_contact_system *of, const wh_contact_work *w, unsigned k,
                                  wh_real lambda) {
    return lambda < wh_contact_low(of, w, k) || lambda > wh_contact_high(of, w, k);
}

/* Stores in work->rough, for each contact in member[], the scale of its acceleration's round-off: the sum of the
 * magnitudes of the terms. accel[] are the accelerations with all forces. */
static inline void wh_contact_magnitudes(const wh_contact_system *of, wh_contact_work *w,
                                         const uint8_t *member, unsigned count,
                                         const wh_real *accel) {
    for (unsigned i = 0; i < count; i++) {
        const wh_real *row = wh_contact_law(of, w, member[i]) + WH_LAW_ROWS;
        w->rough[member[i]] = WH_ABS(wh_contact_law(of, w, member[i])[WH_LAW_BIAS]);
        for (unsigned c = 0; c < of->coordinates; c++) {
            wh_real size = WH_ABS(accel[c]);
            for (unsigned l = 0; l < of->forced; l++) {
                const wh_real *way = wh_contact_law(of, w, l) + WH_LAW_ROWS + of->coordinates;
                size += WH_ABS(way[c] * w->force[l]);
            }
            w->rough[member[i]] += WH_ABS(row[c]) * size;
        }
    }
    /* Spreads the round-off of each contact to the contacts that it accelerates. */
    for (unsigned round = 0; round < count; round++) {
        for (unsigned i = 0; i < count; i++) {
            for (unsigned l = 0; l < count; l++) {
                const wh_real yield = wh_delassus_diagonal(of, w, member[l]);
                const wh_real *way =
                    wh_contact_law(of, w, member[l]) + WH_LAW_ROWS + of->coordinates;
                const wh_real along =
                    WH_ABS(wh_jacobian_times(of, w, member[i], way)) * w->rough[member[l]];
                if (l != i && along > w->rough[member[i]] * yield) {
                    w->rough[member[i]] = along / yield;
                }
            }
        }
    }
}

/* Finds the contact that gives way if the force of the redundant contact member[i] grows in direction `push`. Returns
 * the contact's index in member[], or `count` if there is none. *limit gets the contact's limit (-1: low, 1: high). */
static inline unsigned wh_contact_gives_way(const wh_contact_system *of, const wh_contact_work *w,
                                            const uint8_t *member, unsigned count, const int8_t *at,
                                            const wh_real *lambda, unsigned i, int8_t push,
                                            int8_t *limit) {
    const bool pulls = wh_contact_is(of, member[i], WH_UNILATERAL) && push < 0;
    int8_t fixed[WH_CONTACTS_MAX];
    wh_real less[WH_CONTACTS_MAX];
    wh_real share[WH_CONTACTS_MAX]; /* decrease of each force per unit of force i */
    wh_real soonest = WH_LIMITLESS;
    unsigned first = count;
    *limit = push;
    if (wh_contact_is(of, member[i], WH_LIMITED) || pulls) {
        return i;
    }
    for (unsigned j = 0; j < count; j++) {
        fixed[j] = j == i ? 1 : at[j];
        less[j] = wh_delassus(of, w, member[j], member[i]);
    }
    (void)wh_delassus_solve(of, w, member, count, fixed, less, share);
    for (unsigned j = 0; j < count; j++) {
        const wh_real falls = push > 0 ? share[j] : -share[j];
        const wh_real room = falls > WH_R(0.0) ? lambda[j] - wh_contact_low(of, w, member[j])
                                               : wh_contact_high(of, w, member[j]) - lambda[j];
        if (fixed[j] == 0 && WH_ABS(falls) > WH_CONTACT_ROUNDING && room < WH_LIMITLESS / 2 &&
            room < soonest * WH_ABS(falls)) {
            soonest = room / WH_ABS(falls);
            first = j;
            *limit = falls > WH_R(0.0) ? -1 : 1;
        }
    }
    return first;
}

/* Computes lambda[]: the limit if at[] is -1 (low) or 1 (high), otherwise the force that gives the acceleration
 * `wanted`. `way`, zero on entry, gets the change of the accelerations by all forces. Returns the redundant contacts,
 * as bits of indices. */
static inline unsigned wh_contact_lcp_round(const wh_contact_system *of, const wh_contact_work *w,
                                            const uint8_t *member, unsigned count, const int8_t *at,
                                            const wh_real *wanted, wh_real *lambda, wh_real *way) {
    wh_real limit[WH_CONTACTS_MAX] = {WH_R(0.0)};
    wh_real need[WH_CONTACTS_MAX] = {WH_R(0.0)};
    for (unsigned i = 0; i < count; i++) {
        if (at[i] != 0) {
            limit[i] =
                at[i] < 0 ? wh_contact_low(of, w, member[i]) : wh_contact_high(of, w, member[i]);
            wh_contact_apply(of, w, member[i], limit[i], way);
        }
    }
    for (unsigned i = 0; i < count; i++) {
        need[i] = wanted[i] - wh_jacobian_times(of, w, member[i], way);
    }
    const unsigned repeats = wh_delassus_solve(of, w, member, count, at, need, lambda);
    for (unsigned i = 0; i < count; i++) {
        if (at[i] != 0) {
            lambda[i] = limit[i];
        } else {
            wh_contact_apply(of, w, member[i], lambda[i], way);
        }
    }
    return repeats;
}

/* Returns the round-off of the residual acceleration of contact k, which is at a limit. */
WH_INLINE wh_real wh_contact_residual_rounding(const wh_contact_system *of,
                                               const wh_contact_work *w, unsigned k, bool forces,
                                               wh_real wanted, wh_real made, wh_real lambda) {
    return wh_contact_rounding(wanted, made, lambda * wh_delassus_diagonal(of, w, k)) +
           (forces ? WH_CONTACT_QUIET * w->rough[k] : WH_R(0.0));
}

/* Solves the problem of a single contact: its force is clamped to its limits. */
WH_INLINE unsigned wh_contact_lcp_one(const wh_contact_system *of, const wh_contact_work *w,
                                      unsigned k, wh_real wanted, bool forces, wh_real *lambda,
                                      wh_real *left) {
    const uint8_t member[1] = {(uint8_t)k};
    (void)wh_delassus_solve(of, w, member, 1, NULL, &wanted, lambda);
    *left = WH_R(0.0);
    if (!wh_contact_exceeds(of, w, k, *lambda)) {
        return 0;
    }
    const bool low = *lambda < wh_contact_low(of, w, k);
    *lambda = low ? wh_contact_low(of, w, k) : wh_contact_high(of, w, k);
    const wh_real made = wh_delassus_diagonal(of, w, k) * *lambda;
    const wh_real rounding = wh_contact_residual_rounding(of, w, k, forces, wanted, made, *lambda);
    *left = made - wanted;
    return (low ? *left : -*left) > rounding ? 1U << k : 0U;
}

/* State of the pivoting. Contacts are in the order of elimination. */
typedef struct wh_contact_pivot {
    uint8_t member[WH_CONTACTS_MAX];
    int8_t at[WH_CONTACTS_MAX]; /* -1: at the low limit, 1: at the high limit, 0: between */
    wh_real wanted[WH_CONTACTS_MAX];
    wh_real lambda[WH_CONTACTS_MAX];
    wh_real left[WH_CONTACTS_MAX];
    unsigned contradicted; /* bits: contacts at a limit because of a contradiction */
    unsigned giving;
} wh_contact_pivot;

/* Moves the contact at index i to its limit `to` (-1: low, 1: high), or frees it (0). A freed contact becomes the last
 * one in the elimination. So if the rows are dependent, the freed contact is the redundant one. */
WH_INLINE void wh_contact_pivot_move(wh_contact_pivot *p, unsigned count, unsigned i, int8_t to) {
    const uint8_t k = p->member[i];
    const wh_real wanted = p->wanted[i];
    p->at[i] = to;
    if (to != 0) {
        return;
    }
    p->contradicted &= ~(1U << k);
    for (; i + 1U < count; i++) {
        p->member[i] = p->member[i + 1U];
        p->at[i] = p->at[i + 1U];
        p->wanted[i] = p->wanted[i + 1U];
    }
    p->member[i] = k;
    p->at[i] = 0;
    p->wanted[i] = wanted;
}

/* Returns the index of a contact that violates its complementarity condition, or `count`. *to gets a new p->at[]. */
static inline unsigned wh_contact_pivot_wrong(const wh_contact_system *of, const wh_contact_work *w,
                                              wh_contact_pivot *p, unsigned count, bool forces,
                                              const wh_real *way, int8_t *to) {
    unsigned wrong = count;
    p->giving = 0;
    for (unsigned i = 0; i < count; i++) {
        const unsigned k = p->member[i];
        const wh_real made = wh_jacobian_times(of, w, k, way);
        const wh_real rounding =
            wh_contact_residual_rounding(of, w, k, forces, p->wanted[i], made, p->lambda[i]);
        const bool less = wrong == count || k < p->member[wrong];
        p->left[i] = p->at[i] == 0 ? WH_R(0.0) : made - p->wanted[i];
        const wh_real outwards = p->at[i] < 0 ? p->left[i] : -p->left[i];
        if (p->at[i] == 0) {
            if (less && wh_contact_exceeds(of, w, k, p->lambda[i])) {
                wrong = i;
                *to = p->lambda[i] < wh_contact_low(of, w, k) ? -1 : 1;
            }
        } else if (outwards < -rounding) {
            wrong = less ? i : wrong;
            *to = less ? 0 : *to;
        } else if (outwards > rounding) {
            p->giving |= 1U << k;
        } else if ((p->contradicted >> k & 1U) != 0) { /* only the sign matters */
            p->left[i] = p->at[i] < 0 ? rounding : -rounding;
            p->giving |= 1U << k;
        }
    }
    return wrong;
}

/* Solves for the forces lambda[count] and the residual accelerations left[count] of the contacts in member[count]. If
 * !forces, solves for impulses and residual rates. Returns the contacts that open or slide, as bits. */
static inline unsigned wh_contact_lcp(const wh_contact_system *of, wh_contact_work *w,
                                      const uint8_t *member, unsigned count, const wh_real *wanted,
                                      bool forces, wh_real *lambda, wh_real *left) {
    if (of->forced == 1 || count == 1) {
        return wh_contact_lcp_one(of, w, member[0], wanted[0], forces, lambda, left);
    }
    wh_contact_pivot p = {.contradicted = 0};
    const wh_contact_set set = {p.member, count, p.at};
    for (unsigned i = 0; i < count; i++) {
        p.member[i] = member[i];
        p.wanted[i] = wanted[i];
    }
    unsigned wrong = 0;
    for (unsigned round = 0; wrong < count && round <= 4U * count; round++) {
        wh_real way[WH_COORDS] = {WH_R(0.0)};
        int8_t push[WH_CONTACTS_MAX] = {0};
        int8_t to = 0;
        const unsigned repeats =
            wh_contact_lcp_round(of, w, p.member, count, p.at, p.wanted, p.lambda, way);
        if (repeats != 0) {
            wh_contact_contradicts(of, w, &set, repeats, forces ? NULL : p.lambda, p.wanted, way,
                                   push);
        }
        wrong = wh_contact_pivot_wrong(of, w, &p, count, forces, way, &to);
        for (unsigned i = 0; i < count && wrong == count; i++) {
            if (push[i] != 0) {
                wrong =
                    wh_contact_gives_way(of, w, p.member, count, p.at, p.lambda, i, push[i], &to);
                p.contradicted |= wrong < count ? 1U << p.member[wrong] : 0U;
            }
        }
        if (wrong < count) {
            wh_contact_pivot_move(&p, count, wrong, to);
        }
    }
    w->capped = w->capped || wrong < count;
    for (unsigned i = 0; i < count; i++) {
        for (unsigned j = 0; j < count; j++) {
            if (member[j] == p.member[i]) {
                lambda[j] = p.lambda[i];
                left[j] = p.left[i];
            }
        }
    }
    return p.giving;
}

#endif

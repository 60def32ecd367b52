/* contact_resolve.h: resolves the events of one moment.
 *
 * wh_contact_resolve() takes all contacts with an event at once, so the order in which contacts are declared does not
 * matter, except for the assignments of crossings:
 *
 * 1. Velocities: one linear complementarity problem gives the impulses of the stops that are hit and of the active
 * contacts. Then a second one gives those of the holds that capture and of the active contacts. Friction gives no
 * impulse, because its normal force is finite.
 *
 * 2. Crossings make their assignments, and the contacts that an assignment disturbs are revised.
 *
 * 3. Accelerations: resting stops that would have to pull give way, and so do frictions beyond their limit, until all
 * forces are within their limits.
 *
 * 4. If a friction came to stick, the rates along all active contacts are projected to zero.
 *
 * The law of impacts is Newton's, for all stops that are hit together. J v are the rates of their gaps:
 *
 *      v+ = v- + M^-1 J^T Lambda, 0 <= Lambda_k, J_k v+ >= -e_k J_k v-.
 *
 * For each k at least one of the two inequalities is an equality. Resting and held contacts take part with J_k v- = 0
 * and e_k = 0 (Moreau; Pfeiffer & Glocker, chapter 8). The energy changes by 1/2 sum Lambda_k (1 - e_k) J_k v-. Even
 * with different restitutions, that is never positive, because only closing stops take part. A touching stop that
 * closes because of an impact is hit in the next round, at the same time. So an impact runs through a row of balls. */
#ifndef WH_CONTACT_RESOLVE_H
#define WH_CONTACT_RESOLVE_H

#include "contact_crossing.h"

/* --- disturbance by crossings -------------------------------------------------------------------- */

/* Repairs the contacts in work->moved after a crossing's assignments. Bodies beyond a stop are moved back onto it.
 * The stops become free. Active holds capture again if their condition is still true; otherwise they are released. */
static inline void wh_contact_revise(const wh_contact_system *of, wh_contact_work *w,
                                     const wh_real *input, wh_contact_state *s) {
    wh_real accel[WH_COORDS];
    wh_real signal[2 * WH_CONTACTS_MAX];
    wh_real zero[WH_CONTACTS_MAX] = {WH_R(0.0)};
    wh_real impulse[WH_CONTACTS_MAX] = {WH_R(0.0)};
    wh_contact_look(of, w, s, input, accel, signal);
    wh_contact_place spot = {NULL, WH_R(0.0), 0, w->mover};
    const unsigned stops = w->moved & (wh_contact_which(of, w, WH_STOP, true) |
                                       wh_contact_which(of, w, WH_STOP, false));
    const unsigned holds = w->moved & wh_contact_which(of, w, WH_HOLD, true);
    unsigned kept = 0;
    unsigned passed = 0;
    for (unsigned k = 0; k < of->forced; k++) {
        const bool below = signal[2 * k] < WH_R(0.0);
        passed |= below ? stops & 1U << k : 0U;
        const wh_real limit = (holds >> k & 1U) != 0
                                  ? wh_contact_at_limit(of, w, k, input, s, signal[2 * k])
                                  : WH_R(0.0);
        kept |= signal[2 * k] > -WH_ABS(limit) ? holds & 1U << k : 0U;
    }
    w->moved = 0;
    wh_contact_set_modes(of, w, holds & ~kept, WH_FREE);
    for (unsigned k = 0; k < of->forced; k++) {
        if ((kept >> k & 1U) != 0) {
            wh_contact_capture(of, w, k);
        }
    }
    wh_contact_set_modes(of, w, stops, WH_FREE);
    if (passed != 0) {
        /* the stops are active only during the projection */
        wh_contact_set_modes(of, w, passed, WH_ACTIVE);
        wh_real before[2 * WH_CONTACTS_MAX];
        wh_contact_remember(of, signal, before);
        (void)wh_contact_project_places(of, w, &spot, signal, input, s);
        wh_contact_look(of, w, s, input, accel, signal);
        wh_contact_set_modes(of, w, passed, WH_FREE);
        wh_contact_carry(of, w, before, signal);
    }
    if (kept != 0) {
        const unsigned released =
            wh_contact_impulses(of, w, kept, 0, zero, wh_contact_rates(of, s), impulse);
        wh_contact_set_modes(of, w, released, WH_FREE);
    }
}

/* Returns, as bits, the stops in `giving` (bits) or, if there are none, the frictions in `giving` that are nearest to
 * sliding: those with the largest ratio of force to limit. */
WH_INLINE unsigned wh_contact_first(const wh_contact_system *of, const wh_contact_work *w,
                                    unsigned giving) {
    const unsigned stops = giving & wh_contact_which(of, w, WH_STOP, true);
    if (stops != 0 || (giving & (giving - 1U)) == 0 || of->forced == 1) {
        return stops != 0 ? stops : giving;
    }
    unsigned bits = 0;
    for (unsigned k = 0; k < of->forced; k++) {
        bool most = (giving >> k & 1U) != 0;
        for (unsigned l = 0; l < of->forced && most; l++) {
            const wh_real above = WH_ABS(w->force[l]) * wh_contact_law(of, w, k)[WH_LAW_FIRST];
            const wh_real own = WH_ABS(w->force[k]) * wh_contact_law(of, w, l)[WH_LAW_FIRST];
            most = (giving >> l & 1U) == 0 || !(above - own > WH_CONTACT_ROUNDING * above);
        }
        bits |= most ? 1U << k : 0U;
    }
    return bits;
}

/* Sets the frictions' modes by their rates. A friction in `zeros` (bits) sticks if no impulse has changed its rate. */
WH_INLINE void wh_contact_slide(const wh_contact_system *of, wh_contact_work *w, unsigned zeros,
                                wh_real h, const wh_real *rate) {
    unsigned stick = 0;
    unsigned slides[2] = {0, 0}; /* bits: backward, forward */
    for (unsigned k = 0; k < of->forced; k++) {
        if (!wh_contact_of(of, k, WH_FRICTION)) {
            continue;
        }
        const wh_real v = rate[wh_contact_pin(of, k)];
        const wh_real forward = w->mode[k] > 0 ? v : -v;
        const bool left = w->slack[k] > WH_R(0.0) && forward + w->slack[k] >= WH_R(0.0);
        const wh_real none = h > WH_R(0.0)
                                 ? WH_CONTACT_STILL * h * wh_contact_law(of, w, k)[WH_LAW_FIRST] *
                                       wh_delassus_diagonal(of, w, k)
                                 : WH_R(0.0);
        const bool zero = (zeros >> k & 1U) != 0 && v == w->came[wh_contact_pin(of, k)];
        if (zero || (v != WH_R(0.0) && WH_ABS(v) <= none)) {
            stick |= 1U << k;
        } else if (v != WH_R(0.0) && !left) {
            slides[v > WH_R(0.0)] |= 1U << k;
            w->slack[k] = WH_R(0.0);
        }
    }
    w->turned |= stick;
    wh_contact_set_modes(of, w, stick, WH_STUCK);
    wh_contact_set_modes(of, w, slides[0], -1);
    wh_contact_set_modes(of, w, slides[1], 1);
}

/* Returns, as bits, the unloaded resting stops whose force would open a stop in `gone` (bits). */
WH_INLINE unsigned wh_contact_idle(const wh_contact_system *of, const wh_contact_work *w,
                                   unsigned gone) {
    unsigned bits = 0;
    for (unsigned k = 0; k < of->forced && of->forced > 1; k++) {
        const bool rests = wh_contact_of(of, k, WH_STOP) && wh_contact_constrains(of, w, k);
        bool along = false;
        for (unsigned l = 0; l < of->forced && rests; l++) {
            const bool lets_go = (gone >> l & 1U) != 0 && wh_contact_of(of, l, WH_STOP) && l != k;
            along = along || (lets_go && wh_delassus(of, w, l, k) > WH_R(0.0));
        }
        const bool idle = along && wh_contact_beyond(of, w, k, -WH_ABS(w->force[k])) >= WH_R(0.0);
        bits |= idle ? 1U << k : 0U;
    }
    return bits;
}

/* Releases resting stops that would have to pull, and stuck frictions beyond their limits. If all forces are within
 * their limits, releases contacts in `must` (bits), whose event was located. */
static inline void wh_contact_give_way(const wh_contact_system *of, wh_contact_work *w,
                                       unsigned must, const wh_real *input, wh_contact_state *s) {
    wh_real accel[WH_COORDS];
    wh_real signal[2 * WH_CONTACTS_MAX];
    unsigned first = ~0U;
    while (first != 0 && wh_contact_watched(of, w)) {
        uint8_t member[WH_CONTACTS_MAX] = {0};
        wh_real lambda[WH_CONTACTS_MAX];
        wh_real left[WH_CONTACTS_MAX] = {WH_R(0.0)};
        unsigned giving = 0;
        unsigned slides[2] = {0, 0}; /* bits: backward, forward */
        bool exceeds = false;
        wh_contact_look(of, w, s, input, accel, signal);
        const unsigned count = wh_contact_members(of, w, 0, member);
        for (unsigned i = 0; i < count; i++) {
            exceeds = exceeds || wh_contact_exceeds(of, w, member[i], w->force[member[i]]);
        }
        if (exceeds) {
            wh_contact_magnitudes(of, w, member, count, accel);
            giving = wh_contact_lcp(of, w, member, count, w->wanted, true, lambda, left);
        }
        for (unsigned i = 0; i < count && giving == 0; i++) {
            left[i] = -w->force[member[i]];
        }
        giving = giving != 0 ? giving : must;
        first = wh_contact_first(of, w, giving);
        for (unsigned i = 0; i < count && exceeds; i++) {
            w->force[member[i]] = lambda[i];
        }
        first |= wh_contact_idle(of, w, first);
        for (unsigned i = 0; i < count; i++) {
            const unsigned bit = first & 1U << member[i];
            slides[left[i] > WH_R(0.0)] |= wh_contact_of(of, member[i], WH_FRICTION) ? bit : 0U;
            must &= bit != 0 ? 0U : ~0U;
        }
        wh_contact_set_modes(of, w, first, WH_FREE);
        wh_contact_set_modes(of, w, slides[0], -1);
        wh_contact_set_modes(of, w, slides[1], 1);
    }
}

/* If a friction in work->turned sticks, makes the rates along all active contacts zero. */
WH_INLINE void wh_contact_stick(const wh_contact_system *of, wh_contact_work *w, wh_real *rate) {
    bool sticks = false;
    for (unsigned k = 0; k < of->forced; k++) {
        if ((w->turned >> k & 1U) != 0) {
            const wh_real v = rate[wh_contact_pin(of, k)];
            const wh_real forward = w->mode[k] > 0 ? v : -v;
            sticks = sticks || w->mode[k] == WH_STUCK;
            w->slack[k] =
                w->mode[k] != WH_STUCK && forward < WH_R(0.0) ? -(forward + forward) : WH_R(0.0);
        }
    }
    w->turned = 0;
    if (sticks) {
        wh_contact_project_rates(of, w, 0, true, rate);
    }
}

/* Resolves one moment. Returns the contacts with an event, as bits, and the impulse of each in impulse[contacts]. */
WH_APART unsigned wh_contact_resolve(const wh_contact_system *of, wh_contact_work *w,
                                     const wh_contact_moment *m, const wh_real *input,
                                     wh_contact_state *now, wh_real *impulse) {
    wh_real *rate = wh_contact_rates(of, now);
    unsigned events = m->events;
    const unsigned loads = events & (wh_contact_which(of, w, WH_STOP, true) |
                                     wh_contact_which(of, w, WH_FRICTION, true));
    const unsigned hits = events & wh_contact_which(of, w, WH_STOP, false);
    const unsigned let_go = events & wh_contact_which(of, w, WH_HOLD, true);
    const unsigned captures = events & wh_contact_which(of, w, WH_HOLD, false);
    const unsigned zeros = events & wh_contact_which(of, w, WH_FRICTION, false);
    for (unsigned i = 0; i < of->coordinates && wh_contact_any_of(of, WH_FRICTION); i++) {
        w->came[i] = rate[i];
    }
    for (unsigned k = 0; k < of->contacts; k++) {
        impulse[k] = WH_R(0.0);
    }
    wh_contact_set_modes(of, w, m->falls, WH_FREE);
    if (hits != 0) {
        events |= wh_contact_hit(of, w, hits, m, input, now, impulse);
    }
    wh_contact_set_modes(of, w, let_go, WH_FREE);
    if (captures != 0) {
        wh_contact_captures(of, w, captures, m->h, input, now, impulse);
    }
    for (unsigned k = of->forced; k < of->contacts; k++) {
        if ((events >> k & 1U) != 0) {
            wh_contact_assign(of, w, k, input, now);
        }
    }
    if (of->contacts > of->forced) {
        w->located = w->located && hits == 0 && captures == 0 && w->moved == 0;
        if (w->moved != 0) {
            wh_contact_revise(of, w, input, now);
        }
    }
    if (wh_contact_any_of(of, WH_FRICTION)) {
        wh_contact_slide(of, w, zeros, m->h, rate);
    }
    unsigned must = 0;
    for (unsigned k = 0; k < of->forced; k++) {
        must |= wh_contact_constrains(of, w, k) ? loads & 1U << k : 0U;
    }
    wh_contact_give_way(of, w, must, input, now);
    if (wh_contact_any_of(of, WH_FRICTION)) {
        wh_contact_stick(of, w, rate);
    }
    for (unsigned k = 0; k < of->forced; k++) {
        /* A contact in `must` that is still active has no event. */
        events &= (must >> k & 1U) != 0 && wh_contact_constrains(of, w, k) ? ~(1U << k) : ~0U;
    }
    return events;
}

/* Ends a step of length h with too many events. A friction whose rate has passed zero sticks if its force is then
 * within its limit. A stuck friction slides if an impulse has changed its rate. */
static inline void wh_contact_overrun(const wh_contact_system *of, wh_contact_work *w, wh_real h,
                                      const wh_real *input, wh_contact_state *s) {
    wh_contact_moment end = {0, 0, h, true};
    wh_real accel[WH_COORDS];
    wh_real signal[2 * WH_CONTACTS_MAX];
    wh_real impulse[WH_CONTACTS_MAX];
    if (wh_contact_any_of(of, WH_STOP)) {
        wh_contact_squeeze(of, w, input, s);
    }
    if (!wh_contact_any_of(of, WH_FRICTION)) {
        return;
    }
    wh_contact_look(of, w, s, input, accel, signal);
    for (unsigned k = 0; k < of->forced; k++) {
        if (wh_contact_of(of, k, WH_FRICTION) && w->mode[k] != WH_STUCK) {
            const wh_real v = wh_contact_rates(of, s)[wh_contact_pin(of, k)];
            const wh_real forward = w->mode[k] > 0 ? v : -v;
            end.events |= forward + w->slack[k] < WH_R(0.0) ? 1U << k : 0U;
        }
    }
    (void)wh_contact_resolve(of, w, &end, input, s, impulse);
}

/* True if an input may have moved contact k since the last step. */
WH_INLINE bool wh_contact_may_move(const wh_contact_system *of, const wh_contact_work *w,
                                   unsigned k) {
    const wh_contact *c = &of->contact[k];
    return wh_contact_of(of, k, WH_STOP) ? c->direction != 0 && w->mode[k] == WH_ACTIVE
                                         : c->direction < 0 && wh_contact_slips(of, w, k);
}

WH_INLINE bool wh_contact_follows(const wh_contact_system *of, const wh_contact_work *w) {
    WH_UNROLL
    for (unsigned k = 0; k < of->forced; k++) {
        if (wh_contact_may_move(of, w, k)) {
            return true;
        }
    }
    return false;
}

/* Adapts the active contacts outside `but` (bits) to input rates that changed between two steps. Returns `but` and the
 * stops that open, as bits. *hits gets the stops that are hit. */
static inline unsigned wh_contact_follow_rates(const wh_contact_system *of, wh_contact_work *w,
                                               wh_real h, unsigned but, unsigned *hits,
                                               wh_real *rate) {
    bool off = false;
    *hits = 0;
    for (unsigned k = 0; k < of->forced; k++) {
        const int8_t direction = of->contact[k].direction;
        const bool stop = wh_contact_of(of, k, WH_STOP);
        const bool follows = stop ? direction > 1 : wh_contact_of(of, k, WH_HOLD) && direction < 0;
        if (!follows || w->mode[k] != WH_ACTIVE || (but >> k & 1U) != 0) {
            continue;
        }
        const wh_real speed = wh_jacobian_times(of, w, k, rate);
        const wh_real near = h * w->force[k] * wh_delassus_diagonal(of, w, k);
        const bool moves = WH_ABS(speed) > WH_CONTACT_ROUNDING * wh_contact_terms(of, w, k, rate);
        if (stop && moves && WH_ABS(speed) > near) {
            but |= speed > WH_R(0.0) ? 1U << k : 0U;
            *hits |= speed > WH_R(0.0) ? 0U : 1U << k;
        } else {
            off = off || moves;
        }
    }
    if (off) {
        wh_contact_project_rates(of, w, but | *hits, true, rate);
    }
    return but;
}

/* Adapts stops and holds to inputs that changed between two steps. A body that rests on a stop is moved with the stop,
 * or falls if the force that presses it onto the stop cannot close the gap within the step. */
static inline void wh_contact_follow(const wh_contact_system *of, wh_contact_work *w, wh_real h,
                                     const wh_real *input, wh_contact_state *s) {
    wh_real accel[WH_COORDS];
    wh_real signal[2 * WH_CONTACTS_MAX];
    wh_contact_place spot = WH_CONTACT_HERE;
    unsigned hits = 0;
    if (!wh_contact_follows(of, w)) {
        return;
    }
    wh_contact_look(of, w, s, input, accel, signal);
    for (unsigned k = 0; k < of->forced; k++) {
        if (!wh_contact_may_move(of, w, k)) {
            continue;
        }
        spot.mover = k;
        if (wh_contact_of(of, k, WH_STOP)) {
            const wh_real closes = WH_R(0.5) * h * h * w->force[k] * wh_delassus_diagonal(of, w, k);
            spot.but |= signal[2 * k] > closes ? 1U << k : 0U;
        }
    }
    (void)wh_contact_project_places(of, w, &spot, signal, input, s);
    if (of->driven != 0) {
        spot.but = wh_contact_follow_rates(of, w, h, spot.but, &hits, wh_contact_rates(of, s));
        wh_contact_set_modes(of, w, hits, WH_FREE);
    }
    if (spot.but != 0 || hits != 0) {
        const wh_contact_moment m = {hits, spot.but, h, false};
        wh_real impulse[WH_CONTACTS_MAX];
        (void)wh_contact_resolve(of, w, &m, input, s, impulse);
    }
}

#endif

/* contact_impact.h: impulses of stops that are hit and of holds that capture (see contact_resolve.h). */
#ifndef WH_CONTACT_IMPACT_H
#define WH_CONTACT_IMPACT_H

#include "contact_project.h"

/* A rate counts as zero below this fraction of the rate change that an impact or friction causes. */
#define WH_CONTACT_STILL (WH_DOUBLE ? WH_R(1e-9) : WH_R(1e-4))

/* A gap counts as closed if the gap is at most this fraction of the sum of its terms' magnitudes. */
#define WH_CONTACT_TIE (WH_DOUBLE ? WH_R(0x1p-50) : WH_R(0x1p-21))

typedef struct wh_contact_moment {
    unsigned events; /* contacts with an event, as bits */
    unsigned falls;  /* resting stops that are to open, as bits */
    wh_real h;       /* length of the step, s */
    bool last;       /* a stop that is hit must rest */
} wh_contact_moment;

WH_INLINE void wh_contact_set_modes(const wh_contact_system *of, wh_contact_work *w, unsigned bits,
                                    int8_t mode) {
    for (unsigned k = 0; k < of->forced; k++) {
        w->mode[k] = (bits >> k & 1U) != 0 ? mode : w->mode[k];
    }
}

/* Sets the signs of the crossings in `bits` to those of their values. A zero value leaves the sign unchanged. */
WH_INLINE void wh_contact_set_sides(const wh_contact_system *of, wh_contact_work *w, unsigned bits,
                                    const wh_real *signal) {
    WH_UNROLL
    for (unsigned k = of->forced; k < of->contacts; k++) {
        const wh_real value = signal[2 * k];
        if ((bits >> k & 1U) != 0 && value != WH_R(0.0)) {
            w->mode[k] = value > WH_R(0.0) ? 1 : -1;
        }
    }
}

/* Returns, as bits, the contacts of a kind for which wh_contact_constrains() equals `constrains`. */
WH_INLINE unsigned wh_contact_which(const wh_contact_system *of, const wh_contact_work *w,
                                    wh_contact_kind kind, bool constrains) {
    unsigned bits = 0;
    for (unsigned k = 0; k < of->forced; k++) {
        const bool is = wh_contact_of(of, k, kind) && wh_contact_constrains(of, w, k) == constrains;
        bits |= is ? 1U << k : 0U;
    }
    return bits;
}

/* Returns the sum of the magnitudes of the terms of J_k x, the scale of its round-off. */
static inline wh_real wh_contact_terms(const wh_contact_system *of, const wh_contact_work *w,
                                       unsigned k, const wh_real *x) {
    const wh_real *row = wh_contact_law(of, w, k) + WH_LAW_ROWS;
    wh_real size = WH_R(0.0);
    for (unsigned i = 0; i < of->coordinates; i++) {
        size += WH_ABS(row[i] * x[i]);
    }
    return size;
}

/* Returns the acceleration towards stop k, or zero if it is within the round-off of the other contacts' forces.
 * work->law and accel[] must belong to the state. */
static inline wh_real wh_contact_pressing(const wh_contact_system *of, const wh_contact_work *w,
                                          unsigned k, const wh_real *accel) {
    const wh_real bias = wh_contact_law(of, w, k)[WH_LAW_BIAS];
    const wh_real pressing = -(wh_jacobian_times(of, w, k, accel) + bias);
    const wh_real none =
        of->forced > 1 ? WH_CONTACT_ROUNDING * (wh_contact_terms(of, w, k, accel) + WH_ABS(bias))
                       : WH_R(0.0);
    return WH_ABS(pressing) <= none ? WH_R(0.0) : pressing;
}

/* True if the body comes to rest on stop k: a flight with `speed` would be shorter than WH_REST_SHARE of the step. */
static inline bool wh_contact_rests(const wh_contact_system *of, const wh_contact_work *w,
                                    unsigned k, const wh_contact_moment *m, wh_real speed,
                                    const wh_real *accel, const wh_real *rate) {
    const wh_real pressing = wh_contact_pressing(of, w, k, accel);
    if (pressing == WH_R(0.0)) {
        return speed <= (of->forced > 1 ? WH_CONTACT_ROUNDING * wh_contact_terms(of, w, k, rate)
                                        : WH_R(0.0));
    }
    return pressing > WH_R(0.0) && (m->last || speed + speed <= pressing * (m->h * WH_REST_SHARE));
}

/* Returns, as bits, the resting stops that have a restitution and carry no load. If the caller releases them, an
 * impulse can hit them separately in the next round, as in Newton's cradle. work->force must be up to date. */
static inline unsigned wh_contact_loose(const wh_contact_system *of, const wh_contact_work *w,
                                        unsigned resting, const wh_real *accel) {
    unsigned bits = 0;
    for (unsigned k = 0; k < of->forced && of->forced > 1; k++) {
        wh_real size = wh_contact_terms(of, w, k, accel);
        for (unsigned l = 0; l < of->forced; l++) {
            size += l != k ? WH_ABS(wh_delassus(of, w, k, l) * w->force[l]) : WH_R(0.0);
        }
        const bool loose =
            (resting >> k & 1U) != 0 && wh_contact_law(of, w, k)[WH_LAW_FIRST] > WH_R(0.0) &&
            wh_delassus_diagonal(of, w, k) * w->force[k] <= WH_CONTACT_ROUNDING * size;
        bits |= loose ? 1U << k : 0U;
    }
    return bits;
}

/* Returns, as bits, the free stops whose gap shrinks and is nearly zero. */
static inline unsigned wh_contact_tied(const wh_contact_system *of, const wh_contact_work *w,
                                       wh_real h, const wh_real *signal, wh_contact_state *s) {
    const wh_real *rate = wh_contact_rates(of, s);
    unsigned bits = 0;
    for (unsigned k = 0; k < of->forced && of->forced > 1; k++) {
        const wh_real closing = -signal[2 * k + 1];
        const wh_real way =
            closing * (h * WH_BRACKET_FINE) + WH_CONTACT_TIE * wh_contact_extent(of, w, k, s);
        const bool free = wh_contact_of(of, k, WH_STOP) && w->mode[k] == WH_FREE;
        const bool closes = closing > WH_CONTACT_ROUNDING * wh_contact_terms(of, w, k, rate);
        bits |= free && closes && signal[2 * k] <= way ? 1U << k : 0U;
    }
    return bits;
}

/* Adds to work->hit_next the touching stops whose gaps shrink because of the impact. */
static inline void wh_contact_passed_on(const wh_contact_system *of, wh_contact_work *w,
                                        unsigned hits, wh_real h, const wh_real *before,
                                        const wh_real *after) {
    for (unsigned l = 0; l < of->forced && of->forced > 1; l++) {
        const wh_real speed = after[2 * l + 1];
        const bool free =
            wh_contact_of(of, l, WH_STOP) && w->mode[l] == WH_FREE && (hits >> l & 1U) == 0;
        if (free && speed < WH_R(0.0) && speed < before[2 * l + 1] + before[2 * l + 1] &&
            after[2 * l] <= -speed * (h * WH_BRACKET)) {
            w->hit_next |= 1U << l;
        }
    }
}

/* Returns, as bits, touching free stops at rest without restitution. Such stops share the impact of `hits`, because
 * separate impacts could cause each other for ever. */
static inline unsigned wh_contact_beside(const wh_contact_system *of, const wh_contact_work *w,
                                         unsigned hits, wh_real h, const wh_real *was,
                                         const wh_real *target, const wh_real *signal,
                                         const wh_real *rate) {
    unsigned bits = 0;
    for (unsigned l = 0; l < of->forced && of->forced > 1; l++) {
        const bool free =
            wh_contact_of(of, l, WH_STOP) && w->mode[l] == WH_FREE && (hits >> l & 1U) == 0;
        for (unsigned k = 0; k < of->forced && free; k++) {
            if ((hits >> k & 1U) == 0 || wh_contact_law(of, w, l)[WH_LAW_FIRST] > WH_R(0.0)) {
                continue;
            }
            const wh_real passed_on = WH_ABS(wh_delassus(of, w, l, k) * (target[k] - was[k])) /
                                      wh_delassus_diagonal(of, w, k);
            const bool touched = signal[2 * l] <= passed_on * (h * WH_BRACKET);
            const bool rests =
                WH_ABS(wh_jacobian_times(of, w, l, rate)) <= WH_CONTACT_STILL * passed_on;
            bits |= touched && rests && passed_on > WH_R(0.0) ? 1U << l : 0U;
        }
    }
    return bits;
}

/* The interpreter defines this macro to record the restitution of stop k at an impact. */
#ifndef WH_RESTITUTION_SEEN
#define WH_RESTITUTION_SEEN(of, k, given) ((void)0)
#endif

/* Returns the restitution of stop k, limited to 0 ... 1. A value that is not finite is reported (work->undefined). */
WH_INLINE wh_real wh_contact_restitution(const wh_contact_system *of, wh_contact_work *w,
                                         unsigned k) {
    const wh_real given = wh_contact_law(of, w, k)[WH_LAW_FIRST];
    wh_contact_expect(w, k, given);
    WH_RESTITUTION_SEEN(of, k, given);
    return given > WH_R(0.0) ? (given < WH_R(1.0) ? given : WH_R(1.0)) : WH_R(0.0);
}

/* Resolves the impact of the stops in `hits` (bits) and the stops of wh_contact_tied(). Returns all these stops. */
static inline unsigned wh_contact_hit(const wh_contact_system *of, wh_contact_work *w,
                                      unsigned hits, const wh_contact_moment *m,
                                      const wh_real *input, wh_contact_state *s, wh_real *impulse) {
    wh_real accel[WH_COORDS];
    wh_real signal[2 * WH_CONTACTS_MAX];
    wh_real before[2 * WH_CONTACTS_MAX];
    wh_real was[WH_CONTACTS_MAX] = {WH_R(0.0)};
    wh_real speed[WH_CONTACTS_MAX] = {WH_R(0.0)};
    wh_real *rate = wh_contact_rates(of, s);
    const unsigned resting = wh_contact_which(of, w, WH_STOP, true);
    unsigned closing = 0;
    unsigned beside = 0;
    unsigned rest = 0;
    unsigned leaving = 0;
    wh_contact_look(of, w, s, input, accel, signal);
    wh_contact_set_modes(of, w, wh_contact_loose(of, w, resting, accel), WH_FREE);
    hits |= wh_contact_tied(of, w, m->h, signal, s);
    for (unsigned k = 0; k < of->forced; k++) {
        if ((hits >> k & 1U) != 0) {
            was[k] = wh_jacobian_times(of, w, k, rate);
            speed[k] = was[k];
            if (was[k] < WH_R(0.0)) {
                closing |= 1U << k;
                speed[k] *= -wh_contact_restitution(of, w, k);
                speed[k] =
                    wh_contact_rests(of, w, k, m, speed[k], accel, rate) ? WH_R(0.0) : speed[k];
            }
        }
    }
    if (closing != 0) {
        beside = wh_contact_beside(of, w, closing, m->h, was, speed, signal, rate);
        const unsigned released = wh_contact_impulses(of, w, closing, beside, speed, rate, impulse);
        wh_contact_set_modes(of, w, released, WH_FREE);
        for (unsigned i = 0; i < 2U * of->forced; i++) {
            before[i] = signal[i];
        }
        wh_contact_look(of, w, s, input, accel, signal);
        wh_contact_passed_on(of, w, closing, m->h, before, signal);
        for (unsigned k = 0; k < of->forced && of->forced > 1; k++) {
            if ((closing & ~released & 1U << k) == 0) {
                speed[k] = wh_jacobian_times(of, w, k, rate);
            }
        }
    }
    for (unsigned k = 0; k < of->forced; k++) {
        if ((hits >> k & 1U) != 0 && speed[k] >= WH_R(0.0) &&
            wh_contact_rests(of, w, k, m, speed[k], accel, rate)) {
            rest |= 1U << k;
            leaving |= speed[k] > WH_R(0.0) ? 1U << k : 0U;
        }
    }
    wh_contact_place spot = WH_CONTACT_HERE;
    for (unsigned k = 0; k < of->forced; k++) {
        if ((rest >> k & 1U) != 0 && was[k] == WH_R(0.0) && signal[2 * k] < WH_R(0.0)) {
            spot.but = wh_contact_stuck(of, w); /* friction must not keep a body beyond a stop */
        }
    }
    wh_contact_set_modes(of, w, rest, WH_ACTIVE);
    unsigned gone = of->forced > 1 /* a single contact cannot release another contact */
                        ? resting & ~wh_contact_which(of, w, WH_STOP, true) & ~w->hit_next
                        : 0U;
    for (unsigned k = 0; k < of->forced && gone != 0; k++) {
        const bool stays =
            (gone >> k & 1U) != 0 &&
            wh_contact_rests(of, w, k, m, wh_jacobian_times(of, w, k, rate), accel, rate);
        gone &= stays ? ~0U : ~(1U << k);
    }
    wh_contact_set_modes(of, w, gone, WH_ACTIVE);
    if ((gone | leaving) != 0) {
        wh_contact_project_rates(of, w, wh_contact_stuck(of, w), true, rate);
    }
    if ((rest | gone) != 0) {
        (void)wh_contact_project_places(of, w, &spot, signal, input, s);
    }
    return hits;
}

/* Moves bodies that are beyond free stops back onto the stops; if `coarse`, only bodies that wh_contact_far() finds.
 * *pushed gets the stops that pushed a body, as bits. Returns *pushed and the stops that a body had passed, as bits.
 * signal[] and work->law afterwards belong to `s`. */
static inline unsigned wh_contact_push_out(const wh_contact_system *of, wh_contact_work *w,
                                           bool coarse, const wh_real *input, wh_contact_state *s,
                                           wh_real *signal, unsigned *pushed) {
    of = WH_CONTACTS_HERE(of);
    const unsigned looks = coarse ? WH_PUSH_LOOKS : WH_SQUEEZE_LOOKS;
    wh_real accel[WH_COORDS];
    unsigned passed = 0;
    *pushed = 0;
    for (unsigned pass = 0; pass < looks; pass++) {
        uint8_t member[WH_CONTACTS_MAX] = {0};
        wh_real wanted[WH_CONTACTS_MAX] = {WH_R(0.0)};
        wh_real lambda[WH_CONTACTS_MAX];
        wh_real left[WH_CONTACTS_MAX];
        wh_real way[WH_COORDS] = {WH_R(0.0)};
        unsigned mover = WH_CONTACTS_MAX;
        unsigned count = 0;
        unsigned over = 0; /* bits: stops that have pushed a body too far (nonlinear gap) */
        wh_contact_look(of, w, s, input, accel, signal);
        for (unsigned k = 0; k < of->forced; k++) {
            const bool stop = wh_contact_of(of, k, WH_STOP);
            if (!stop && !(wh_contact_of(of, k, WH_HOLD) && w->mode[k] == WH_ACTIVE)) {
                continue;
            }
            over |= coarse && stop && wh_contact_open(of, w, k, signal, s) ? 1U << k & *pushed : 0U;
            if (stop && w->mode[k] == WH_FREE &&
                (coarse ? wh_contact_far(of, w, k, signal, s) : signal[2 * k] < WH_R(0.0))) {
                mover = mover == WH_CONTACTS_MAX ? k : mover;
                passed |= 1U << k;
            }
            wanted[count] = stop ? -signal[2 * k] : WH_R(0.0);
            member[count++] = (uint8_t)k;
        }
        if ((mover == WH_CONTACTS_MAX && over == 0) || pass + 1U == looks) {
            break;
        }
        if (mover == WH_CONTACTS_MAX) {
            /* A push was too large: move the bodies back until they touch. For this, the stops may pull. */
            unsigned kept = 0;
            for (unsigned i = 0; i < count; i++) {
                const unsigned k = member[i];
                if (!wh_contact_of(of, k, WH_STOP) || (*pushed >> k & 1U) != 0) {
                    mover = mover == WH_CONTACTS_MAX && (over >> k & 1U) != 0 ? k : mover;
                    wanted[kept] = wanted[i];
                    member[kept++] = (uint8_t)k;
                }
            }
            count = kept;
            (void)wh_delassus_solve(of, w, member, count, NULL, wanted, lambda);
        } else {
            (void)wh_contact_lcp(of, w, member, count, wanted, false, lambda, left);
        }
        for (unsigned i = 0; i < count; i++) {
            const bool pushes = wh_contact_of(of, member[i], WH_STOP) && lambda[i] > WH_R(0.0);
            *pushed |= pushes ? 1U << member[i] : 0U;
            wh_contact_apply(of, w, member[i], lambda[i], way);
        }
        /* The equations are linearized, so each angle moves by at most half a radian. */
        wh_real part = WH_R(1.0);
        for (unsigned i = 0; coarse && i < of->angles; i++) {
            const wh_real turn = WH_ABS(way[i]);
            part = turn * part > WH_R(0.5) ? WH_R(0.5) / turn : part;
        }
        wh_books_look(of, w, s, input);
        for (unsigned i = 0; i < of->coordinates; i++) {
            wh_contact_move(of, i, part * way[i], s);
        }
        wh_books_moved(of, w, s, input, mover);
    }
    return passed | *pushed;
}

/* Ends a step with too many events: moves bodies back onto free stops that they passed, with plastic impacts. */
static inline void wh_contact_squeeze(const wh_contact_system *of, wh_contact_work *w,
                                      const wh_real *input, wh_contact_state *s) {
    wh_real signal[2 * WH_CONTACTS_MAX];
    wh_real zero[WH_CONTACTS_MAX] = {WH_R(0.0)};
    wh_real impulse[WH_CONTACTS_MAX] = {WH_R(0.0)};
    unsigned pushed;
    const unsigned touched = wh_contact_push_out(of, w, false, input, s, signal, &pushed);
    if (touched != 0) {
        unsigned open = 0; /* bits: stops with an open gap, which get no impulse */
        for (unsigned k = 0; k < of->forced; k++) {
            const bool may = wh_contact_of(of, k, WH_STOP) && (pushed >> k & 1U) == 0;
            open |= may && wh_contact_open(of, w, k, signal, s) ? 1U << k : 0U;
        }
        wh_contact_set_modes(of, w, open, WH_FREE);
        const unsigned released =
            wh_contact_impulses(of, w, touched & ~open, 0, zero, wh_contact_rates(of, s), impulse);
        wh_contact_set_modes(of, w, released, WH_FREE);
    }
}

/* --- conditions that depend on the held expression --------------------------------------------------------------- */

/* A hold's condition may depend on the held expression. To find the condition's round-off, the expression is changed by
 * WH_EDGE_PROBE times wh_contact_extent(). The round-off is WH_EDGE times the resulting change of the condition. */
#define WH_EDGE_PROBE (WH_DOUBLE ? WH_R(0x1p-26) : WH_R(0x1p-13))
#define WH_EDGE (WH_CONTACT_ROUNDING / WH_EDGE_PROBE)

/* Returns how much hold k's condition changes from `now` if the held expression and its rate rise a little
 * (WH_EDGE_PROBE). work->law must belong to `s`. */
WH_APART wh_real wh_contact_own(const wh_contact_system *of, const wh_contact_work *w, unsigned k,
                                const wh_real *input, const wh_contact_state *s, wh_real now) {
    wh_contact_point at;
    wh_contact_state moved = *s;
    wh_real signal[2 * WH_CONTACTS_MAX];
    wh_real *rate = wh_contact_rates(of, &moved);
    const wh_real *row = wh_contact_law(of, w, k) + WH_LAW_ROWS;
    const wh_real probe = WH_EDGE_PROBE * wh_contact_extent(of, w, k, s);
    const wh_real speed = WH_EDGE_PROBE * wh_contact_terms(of, w, k, rate);
    const wh_real square = wh_jacobian_times(of, w, k, row);
    for (unsigned i = 0; i < of->coordinates; i++) {
        wh_contact_move(of, i, probe * row[i] / square, &moved);
        rate[i] += speed * row[i] / square;
    }
    wh_contact_point_of(of, &moved, &at);
    wh_contact_signals(of, at.phase, at.linear, at.rate, input, signal);
    return signal[2 * k] - now;
}

/* Returns the round-off of hold k's condition, signed like wh_contact_own(), or 0 if |now| exceeds the round-off. */
WH_APART wh_real wh_contact_at_limit(const wh_contact_system *of, const wh_contact_work *w,
                                     unsigned k, const wh_real *input, const wh_contact_state *s,
                                     wh_real now) {
    const wh_real known = WH_EDGE * wh_contact_own(of, w, k, input, s, now);
    return WH_ABS(now) <= WH_ABS(known) ? known : WH_R(0.0);
}

/* The time of a capture has an error. So afterwards the condition of a hold (bits: `holds`) may be slightly negative.
 * This function moves the held expression until the condition is positive. rates[]: signals before the capture.
 * signal[]: signals at `s`. */
WH_APART void wh_contact_over_edge(const wh_contact_system *of, wh_contact_work *w, unsigned holds,
                                   wh_real h, const wh_real *rates, const wh_real *signal,
                                   const wh_real *input, wh_contact_state *s) {
    uint8_t member[WH_CONTACTS_MAX] = {0};
    wh_real wanted[WH_CONTACTS_MAX] = {WH_R(0.0)};
    wh_real lambda[WH_CONTACTS_MAX];
    wh_real way[WH_COORDS] = {WH_R(0.0)};
    unsigned mover = WH_CONTACTS_MAX;
    const unsigned count = wh_contact_members(of, w, 0, member);
    for (unsigned i = 0; i < count; i++) {
        const unsigned k = member[i];
        if ((holds >> k & 1U) != 0 && signal[2 * k] < WH_R(0.0)) {
            const wh_real own = wh_contact_own(of, w, k, input, s, signal[2 * k]);
            const wh_real by = -(signal[2 * k] + signal[2 * k]) / own *
                               (WH_EDGE_PROBE * wh_contact_extent(of, w, k, s));
            /* moves no hold whose condition hardly depends on the held expression */
            if (WH_ABS(by) <= WH_ABS(rates[2 * k + 1]) * h / 64) {
                wanted[i] = by;
                mover = k;
            }
        }
    }
    if (mover == WH_CONTACTS_MAX) {
        return;
    }
    (void)wh_delassus_solve(of, w, member, count, NULL, wanted, lambda);
    wh_books_look(of, w, s, input);
    for (unsigned i = 0; i < count; i++) {
        wh_contact_apply(of, w, member[i], lambda[i], way);
        if (wanted[i] != WH_R(0.0) && wh_contact_slips(of, w, member[i]) &&
            of->contact[member[i]].direction <= 0) {
            w->held[of->contact[member[i]].first_set] += wanted[i];
        }
    }
    for (unsigned i = 0; i < of->coordinates; i++) {
        wh_contact_move(of, i, way[i], s);
    }
    wh_books_moved(of, w, s, input, mover);
}

static inline void wh_contact_captures(const wh_contact_system *of, wh_contact_work *w,
                                       unsigned holds, wh_real h, const wh_real *input,
                                       wh_contact_state *s, wh_real *impulse) {
    wh_real accel[WH_COORDS];
    wh_real before[2 * WH_CONTACTS_MAX];
    wh_real after[2 * WH_CONTACTS_MAX];
    wh_real zero[WH_CONTACTS_MAX] = {WH_R(0.0)};
    wh_contact_point at;
    wh_contact_set_modes(of, w, holds, WH_ACTIVE);
    wh_contact_look(of, w, s, input, accel, before);
    for (unsigned k = 0; k < of->forced; k++) {
        if ((holds >> k & 1U) != 0) {
            wh_contact_capture(of, w, k);
        }
    }
    const unsigned released =
        wh_contact_impulses(of, w, holds, 0, zero, wh_contact_rates(of, s), impulse);
    wh_contact_set_modes(of, w, released, WH_FREE);
    wh_contact_point_of(of, s, &at);
    wh_contact_signals(of, at.phase, at.linear, at.rate, input, after);
    wh_contact_passed_on(of, w, 0, h, before, after);
    wh_contact_over_edge(of, w, holds, h, before, after, input, s);
}

#endif

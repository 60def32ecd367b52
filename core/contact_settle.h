/* contact_settle.h: making rates, gaps and modes agree with a state (see contact.h). */
#ifndef WH_CONTACT_SETTLE_H
#define WH_CONTACT_SETTLE_H

#include "contact_events.h"

/* The accelerations, forces and signals at a state, in the modes of work. */
static inline void wh_contact_look(const wh_hybrid *of, wh_contact_work *w, wh_contact_state *s,
                                   const wh_real *input, wh_real *accel, wh_real *signal) {
    const wh_contact_model model = {of, w};
    wh_contact_point at;
    wh_contact_point_of(of, s, &at);
    wh_contact_accel(&model, at.phase, at.linear, at.rate, input, accel);
    if (!wh_feels(of, w)) {
        of->forces(of->model, at.phase, at.linear, at.rate, input, w->law);
    }
    of->signals(of->model, at.phase, at.linear, at.rate, input, signal);
}

/* Move coordinate i by `by`, rad or m. */
WH_INLINE void wh_contact_move(const wh_hybrid *of, unsigned i, wh_real by, wh_contact_state *s) {
    if (i < of->angles) {
        wh_real none = WH_R(0.0);
        (void)wh_angle_move(&s->angle[i], by * WH_PHASE_PER_RAD, false, &none);
    } else {
        s->real[i - of->angles] += by;
    }
}

/* Contacts that hold their J_k q' at zero. Returns how many. */
WH_INLINE unsigned wh_contact_members(const wh_hybrid *of, const wh_contact_work *w,
                                      uint8_t *member) {
    unsigned count = 0;
    for (unsigned k = 0; k < of->forced; k++) {
        if (wh_constrains(of, w, k)) {
            member[count++] = (uint8_t)k;
        }
    }
    return count;
}

/* Put the gaps of resting stops to zero, while what is stuck or held stays. work->law and signal[] must
 * belong to this position. */
static inline void wh_contact_close(const wh_hybrid *of, const wh_contact_work *w,
                                    const wh_real *signal, wh_contact_state *s) {
    uint8_t member[WH_CONTACTS_MAX] = {0};
    wh_real wanted[WH_CONTACTS_MAX];
    wh_real amount[WH_CONTACTS_MAX];
    wh_real way[WH_COORDS] = {0};
    const unsigned count = wh_contact_members(of, w, member);
    bool together = false;
    for (unsigned i = 0; i < count; i++) {
        const unsigned k = member[i];
        const int pin = of->contact[k].pin;
        wanted[i] = WH_R(0.0);
        if (of->contact[k].kind != WH_STOP) {
            continue;
        }
        if (pin >= 0) { /* the others need not move for it */
            const wh_real entry = wh_law(of, w, k)[WH_LAW_ROWS + pin];
            wh_contact_move(of, (unsigned)pin, -signal[2 * k] / entry, s);
        } else {
            wanted[i] = -signal[2 * k];
            together = true;
        }
    }
    if (!together) {
        return;
    }
    (void)wh_contact_solve(of, w, member, count, NULL, wanted, amount);
    for (unsigned i = 0; i < count; i++) {
        wh_push(of, w, member[i], amount[i], way);
    }
    for (unsigned i = 0; i < count; i++) {
        const int pin = of->contact[member[i]].pin;
        if (pin >= 0) {
            way[pin] = WH_R(0.0);
        }
    }
    for (unsigned i = 0; i < of->coordinates; i++) {
        wh_contact_move(of, i, way[i], s);
    }
}

/* Take the rates along what is held away, of all contacts together; `booked`: as impulses of theirs.
 * work->law must belong to this position. */
static inline void wh_contact_still(const wh_hybrid *of, const wh_contact_work *w, bool booked,
                                    wh_real *rate) {
    uint8_t member[WH_CONTACTS_MAX] = {0};
    wh_real wanted[WH_CONTACTS_MAX] = {WH_R(0.0)};
    wh_real amount[WH_CONTACTS_MAX];
    wh_real before[WH_CONTACTS_MAX];
    const unsigned count = wh_contact_members(of, w, member);
    for (unsigned i = 0; i < count; i++) {
        before[i] = wh_along(of, w, member[i], rate);
        wanted[i] = -before[i];
    }
    (void)wh_contact_solve(of, w, member, count, NULL, wanted, amount);
    for (unsigned i = 0; i < count; i++) {
        wh_push(of, w, member[i], amount[i], rate);
    }
    for (unsigned i = 0; i < count; i++) {
        const int pin = of->contact[member[i]].pin;
        if (pin >= 0) {
            rate[pin] = WH_R(0.0);
        }
        if (booked) {
            wh_books_impulse(of, w, member[i], amount[i], before[i],
                             wh_along(of, w, member[i], rate));
        }
    }
}

/* What the integrator let slip: rates along what is held, and the gaps of resting stops. A pinned
 * coordinate cannot slip. */
static inline void wh_contact_tidy(const wh_hybrid *of, wh_contact_work *w, const wh_real *input,
                                   wh_contact_state *s) {
    wh_real accel[WH_COORDS];
    wh_real signal[2 * WH_CONTACTS_MAX];
    bool slips = false;
    for (unsigned k = 0; k < of->forced; k++) {
        slips = slips || (of->contact[k].pin < 0 && wh_constrains(of, w, k));
    }
    if (slips) {
        wh_contact_look(of, w, s, input, accel, signal);
        wh_contact_still(of, w, false, wh_contact_rates(of, s));
        wh_contact_close(of, w, signal, s);
    }
}

/* After a crossing's assignments changed the gaps, conditions or rates of the contacts in work->moved: a
 * stop that was passed has its gap closed, and rests no longer, as one that was left; what a hold still
 * keeps is captured again. The gaps are the crossing's doing, and so is their energy. */
static inline void wh_contact_revise(const wh_hybrid *of, wh_contact_work *w, const wh_real *input,
                                     wh_contact_state *s) {
    wh_real accel[WH_COORDS];
    wh_real signal[2 * WH_CONTACTS_MAX];
    wh_contact_look(of, w, s, input, accel, signal);
    unsigned stops = 0;
    unsigned holds = 0;
    bool passed = false;
    for (unsigned k = 0; k < of->forced; k++) {
        const bool moved = (w->moved >> k & 1U) != 0;
        if (of->contact[k].kind == WH_STOP && moved) {
            stops |= 1U << k;
            w->mode[k] = signal[2 * k] < WH_R(0.0) ? WH_ACTIVE : WH_FREE;
            passed = passed || w->mode[k] == WH_ACTIVE;
        } else if (of->contact[k].kind == WH_HOLD && moved && w->mode[k] == WH_ACTIVE) {
            w->mode[k] = signal[2 * k] > WH_R(0.0) ? WH_ACTIVE : WH_FREE;
            holds |= w->mode[k] == WH_ACTIVE ? 1U << k : 0U;
        }
    }
    w->moved = 0;
    if (passed) {
        wh_books_levels(of, w, s, input, w->mover, WH_R(-1.0));
        wh_contact_close(of, w, signal, s);
        wh_books_levels(of, w, s, input, w->mover, WH_R(1.0));
        wh_contact_look(of, w, s, input, accel, signal);
    }
    for (unsigned k = 0; k < of->forced; k++) {
        w->mode[k] = (stops >> k & 1U) != 0 ? (int8_t)WH_FREE : w->mode[k];
    }
    for (unsigned k = 0; k < of->forced; k++) {
        if ((holds >> k & 1U) != 0) {
            (void)wh_contact_impulse(of, w, k, WH_R(0.0), wh_contact_rates(of, s));
        }
    }
}

/* Of the contacts that give way, those that do so first, as bits: all stops; else, since what slides pushes
 * less than what sticks and may relieve the others, the friction whose load is most above its limit: the first
 * to reach it, if the load grew from nothing. */
WH_INLINE unsigned wh_contact_first(const wh_hybrid *of, const wh_contact_work *w,
                                    unsigned giving) {
    unsigned stops = 0;
    unsigned most = WH_CONTACTS_MAX;
    for (unsigned k = 0; k < of->forced; k++) {
        if ((giving >> k & 1U) == 0) {
            continue;
        }
        stops |= of->contact[k].kind == WH_STOP ? 1U << k : 0U;
        const wh_real limit = wh_law(of, w, k)[WH_LAW_FIRST];
        if (most == WH_CONTACTS_MAX || WH_ABS(w->force[k]) * wh_law(of, w, most)[WH_LAW_FIRST] >
                                           WH_ABS(w->force[most]) * limit) {
            most = k;
        }
    }
    return stops != 0 || giving == 0 ? stops : 1U << most;
}

/* Bring the modes to agree with the state: which way friction slides, which resting stops would have to
 * pull, which stuck coordinates (but those in `keep`, as bits) break loose. What breaks loose pushes less
 * than before, so others may follow: each round lets at least one go. */
static inline void wh_contact_settle(const wh_hybrid *of, wh_contact_work *w, unsigned keep,
                                     const wh_real *input, wh_contact_state *s) {
    wh_real accel[WH_COORDS];
    wh_real signal[2 * WH_CONTACTS_MAX];
    const wh_real *rate = wh_contact_rates(of, s);
    if (w->moved != 0) {
        wh_contact_revise(of, w, input, s);
    }
    unsigned frictions = 0;
    for (unsigned k = 0; k < of->forced; k++) {
        if (of->contact[k].kind == WH_FRICTION) {
            const wh_real v = rate[of->contact[k].pin];
            frictions |= 1U << k;
            if (v != WH_R(0.0)) {
                w->mode[k] = v > WH_R(0.0) ? 1 : -1;
            }
        }
    }
    keep &= frictions;
    bool again = true;
    while (again && wh_contact_watched(of, w)) {
        uint8_t member[WH_CONTACTS_MAX] = {0};
        wh_real amount[WH_CONTACTS_MAX];
        wh_real left[WH_CONTACTS_MAX] = {WH_R(0.0)};
        again = false;
        wh_contact_look(of, w, s, input, accel, signal);
        const unsigned count = wh_contact_members(of, w, member);
        for (unsigned i = 0; i < count; i++) {
            again = again || wh_contact_exceeds(of, w, member[i], keep, w->force[member[i]]);
        }
        const unsigned giving =
            again ? wh_contact_share(of, w, member, count, w->wanted, keep, amount, left) : 0;
        const unsigned first = wh_contact_first(of, w, giving);
        for (unsigned i = 0; i < count; i++) {
            const unsigned k = member[i];
            if ((first >> k & 1U) != 0) {
                const int8_t slides = left[i] > WH_R(0.0) ? 1 : -1;
                w->mode[k] = of->contact[k].kind == WH_FRICTION ? slides : (int8_t)WH_FREE;
            }
        }
        again = giving != 0;
    }
}

#endif

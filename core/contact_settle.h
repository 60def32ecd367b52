/* contact_settle.h: making modes agree with a state (see contact.h). */
#ifndef WH_CONTACT_SETTLE_H
#define WH_CONTACT_SETTLE_H

#include "contact_project.h"

/* After a crossing's assignments changed the gaps, conditions or rates of the contacts in work->moved: a
 * stop that was passed has its gap closed, and rests no longer, as one that was left; what a hold still
 * keeps is captured again. The gaps are the crossing's doing, and so is their energy. */
static inline void wh_contact_revise(const wh_contact_system *of, wh_contact_work *w,
                                     const wh_real *input, wh_contact_state *s) {
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
            wh_contact_capture(of, w, k);
        }
    }
    w->moved = 0;
    if (passed) {
        const wh_contact_place place = {NULL, WH_R(0.0), 0, w->mover};
        (void)wh_contact_project_places(of, w, &place, signal, input, s);
        wh_contact_look(of, w, s, input, accel, signal);
    }
    for (unsigned k = 0; k < of->forced; k++) {
        w->mode[k] = (stops >> k & 1U) != 0 ? (int8_t)WH_FREE : w->mode[k];
    }
    for (unsigned k = 0; k < of->forced; k++) {
        if ((holds >> k & 1U) != 0) {
            (void)wh_contact_impulse(of, w, k, 0, WH_R(0.0), wh_contact_rates(of, s));
        }
    }
}

/* Of the contacts that give way, those that do so first, as bits: all stops; else, since what slides pushes
 * less than what sticks and may relieve the others, the friction whose load is most above its limit: the first
 * to reach it, if the load grew from nothing. */
WH_INLINE unsigned wh_contact_first(const wh_contact_system *of, const wh_contact_work *w,
                                    unsigned giving) {
    unsigned stops = 0;
    unsigned most = WH_CONTACTS_MAX;
    for (unsigned k = 0; k < of->forced; k++) {
        if ((giving >> k & 1U) == 0) {
            continue;
        }
        stops |= of->contact[k].kind == WH_STOP ? 1U << k : 0U;
        const wh_real limit = wh_contact_law(of, w, k)[WH_LAW_FIRST];
        if (most == WH_CONTACTS_MAX ||
            WH_ABS(w->force[k]) * wh_contact_law(of, w, most)[WH_LAW_FIRST] >
                WH_ABS(w->force[most]) * limit) {
            most = k;
        }
    }
    return stops != 0 || giving == 0 ? stops : 1U << most;
}

/* A rate that friction takes away in this share of the step is none: whether it sticks is for the forces to say. */
#define WH_CONTACT_STILL (WH_DOUBLE ? WH_R(1e-9) : WH_R(1e-4))

/* Which way friction slides, as its rate says; where the location left it on the side that it comes from, as was
 * found there. What has just come to zero, or is left there by the rounding of what others did, waits for the
 * forces' word. `h`: the step; work->law must belong to this position, but for h = 0. */
WH_INLINE unsigned wh_contact_slides(const wh_contact_system *of, wh_contact_work *w, wh_real h,
                                     const wh_real *rate) {
    unsigned frictions = 0;
    for (unsigned k = 0; k < of->forced; k++) {
        if (of->contact[k].kind != WH_FRICTION) {
            continue;
        }
        frictions |= 1U << k;
        const wh_real v = rate[of->contact[k].pin];
        const wh_real forward = w->mode[k] > 0 ? v : -v;
        const bool left = w->slack[k] > WH_R(0.0) && forward + w->slack[k] >= WH_R(0.0);
        if (v == WH_R(0.0) || (w->turned >> k & 1U) != 0) {
            continue;
        }
        const wh_real none = h > WH_R(0.0)
                                 ? WH_CONTACT_STILL * h * wh_contact_law(of, w, k)[WH_LAW_FIRST] *
                                       wh_delassus_diagonal(of, w, k)
                                 : WH_R(0.0);
        if (WH_ABS(v) <= none) {
            w->mode[k] = WH_STUCK;
            w->turned |= 1U << k;
        } else if (!left) {
            w->mode[k] = v > WH_R(0.0) ? 1 : -1;
            w->slack[k] = WH_R(0.0);
        }
    }
    return frictions;
}

/* Of what has just come to zero, what the forces keep there sticks: friction, which would take the rest of the
 * rate away in no time, does, together with all else that is held, so that two frictions do not shake each
 * other loose. What slides on does so the way it is pushed, on whichever side of zero it is. */
WH_INLINE void wh_contact_stick(const wh_contact_system *of, wh_contact_work *w, wh_real *rate) {
    bool sticks = false;
    for (unsigned k = 0; k < of->forced; k++) {
        if ((w->turned >> k & 1U) != 0) {
            const wh_real v = rate[of->contact[k].pin];
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

/* Bring the modes to agree with the state: which way friction slides, which resting stops would have to
 * pull, which stuck coordinates (but those in `keep`, as bits) break loose. What breaks loose pushes less
 * than before, so others may follow: each round lets at least one go. */
static inline void wh_contact_settle(const wh_contact_system *of, wh_contact_work *w, wh_real h,
                                     unsigned keep, const wh_real *input, wh_contact_state *s) {
    wh_real accel[WH_COORDS];
    wh_real signal[2 * WH_CONTACTS_MAX];
    wh_real *rate = wh_contact_rates(of, s);
    if (w->moved != 0) {
        wh_contact_revise(of, w, input, s);
    }
    keep &= wh_contact_slides(of, w, h, rate);
    bool again = true;
    while (again && wh_contact_watched(of, w)) {
        uint8_t member[WH_CONTACTS_MAX] = {0};
        wh_real lambda[WH_CONTACTS_MAX];
        wh_real left[WH_CONTACTS_MAX] = {WH_R(0.0)};
        again = false;
        wh_contact_look(of, w, s, input, accel, signal);
        const unsigned count = wh_contact_members(of, w, 0, member);
        for (unsigned i = 0; i < count; i++) {
            again = again || wh_contact_exceeds(of, w, member[i], keep, w->force[member[i]]);
        }
        if (again) {
            wh_contact_magnitudes(of, w, member, count, accel);
        }
        const unsigned giving =
            again ? wh_contact_lcp(of, w, member, count, w->wanted, keep, true, lambda, left) : 0;
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
    wh_contact_stick(of, w, rate);
}

#endif

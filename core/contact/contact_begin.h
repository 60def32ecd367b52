/* contact_begin.h: the contacts' modes at the start of a run. */
#ifndef WH_CONTACT_BEGIN_H
#define WH_CONTACT_BEGIN_H

#include "contact_resolve.h"

/* Finds, as bits, the contacts that act: at rest (*still) or in motion (*moving). w->law must be up to date. */
static inline void wh_contact_first_touch(const wh_contact_system *of, const wh_contact_work *w,
                                          unsigned pushed, const wh_real *signal,
                                          const wh_real *input, wh_contact_state *s,
                                          unsigned *still, unsigned *moving) {
    const wh_real *rate = wh_contact_rates(of, s);
    *still = 0;
    *moving = 0;
    for (unsigned k = 0; k < of->forced; k++) {
        const wh_real value = signal[2 * k];
        const bool stop = wh_contact_of(of, k, WH_STOP);
        const wh_real speed = wh_jacobian_times(of, w, k, rate);
        const wh_real none = WH_CONTACT_ROUNDING * wh_contact_terms(of, w, k, rate);
        const bool rests = !wh_contact_pinned(of, k) ? WH_ABS(speed) <= none : speed == WH_R(0.0);
        const bool on = (pushed >> k & 1U) != 0;
        const bool touched =
            stop && (on || value <= WH_CONTACT_TIE * wh_contact_extent(of, w, k, s));
        const bool closes = stop && (on || value <= WH_R(0.0)) && signal[2 * k + 1] <= WH_R(0.0);
        const bool hold = wh_contact_of(of, k, WH_HOLD);
        const wh_real limit = hold ? wh_contact_at_limit(of, w, k, input, s, value) : WH_R(0.0);
        const bool comes =
            limit == WH_R(0.0) ? value > WH_R(0.0) : rests || limit * speed > WH_R(0.0);
        const bool holds = hold && comes;
        *still |= (touched || holds) && rests ? 1U << k : 0U;
        *moving |= (closes || holds) && !rests ? 1U << k : 0U;
    }
}

/* Sets the modes at the start of a run and after wh_scene_set_real(), and resolves impacts and captures. *hit gets the
 * contacts with an impact or a capture, as bits; impulse[forced] gets the impulses. Returns the number of moments, 0 to
 * 2, that count towards WH_EVENTS_MAX. */
static inline unsigned wh_contact_begin(const wh_contact_system *of, wh_contact_work *w, wh_real h,
                                        const wh_real *input, wh_contact_state *s, unsigned *hit,
                                        wh_real *impulse) {
    wh_real accel[WH_COORDS];
    wh_real signal[2 * WH_CONTACTS_MAX];
    unsigned rounds = 0;
    unsigned pushed = 0;
    wh_contact_place spot = WH_CONTACT_HERE;
    wh_contact_moment m = {0, 0, h, false};
    unsigned still;
    unsigned moving;
    bool below = false;
    *hit = 0;
    for (unsigned k = 0; k < of->contacts; k++) {
        w->mode[k] = 0; /* 0: a free stop or hold, a stuck friction, an undecided crossing */
    }
    if (wh_contact_any_of(of, WH_FRICTION)) {
        wh_contact_slide(of, w, 0, WH_R(0.0), wh_contact_rates(of, s));
    }
    wh_contact_look(of, w, s, input, accel, signal);
    for (unsigned k = 0; k < of->contacts; k++) {
        wh_contact_expect(w, k, signal[2 * k] + signal[2 * k + 1]);
    }
    for (unsigned k = 0; k < of->forced && rounds == 0; k++) {
        if (wh_contact_of(of, k, WH_STOP) && wh_contact_far(of, w, k, signal, s)) {
            (void)wh_contact_push_out(of, w, true, input, s, signal, &pushed);
            rounds = 1;
        }
    }
    wh_contact_first_touch(of, w, pushed, signal, input, s, &still, &moving);
    wh_contact_set_sides(of, w, ~0U, signal);
    if (still == 0) {
        m.events = moving;
        *hit = wh_contact_resolve(of, w, &m, input, s, impulse);
        return rounds;
    }
    m.events = still & wh_contact_which(of, w, WH_HOLD, false);
    wh_contact_set_modes(of, w, still & ~m.events, WH_ACTIVE);
    (void)wh_contact_resolve(of, w, &m, input, s, impulse);
    for (unsigned k = 0; k < of->forced; k++) {
        below = below || (wh_contact_of(of, k, WH_STOP) && w->mode[k] == WH_ACTIVE &&
                          signal[2 * k] < WH_R(0.0));
    }
    if (below) { /* work->law still belongs to this state */
        spot.but = wh_contact_stuck(of, w);
        (void)wh_contact_project_places(of, w, &spot, signal, input, s);
    }
    if (moving == 0) {
        return rounds;
    }
    m.events = moving;
    *hit = wh_contact_resolve(of, w, &m, input, s, impulse);
    return rounds + 1;
}

#endif

/* contact_crossing.h: the assignments of crossings, and the signs of their values.
 *
 * A crossing's mode is the sign of its value, +1 or -1, or 0 while the sign is undecided. An event's time has an error.
 * If this error makes the value pass zero twice, the two passages count as one crossing. */
#ifndef WH_CONTACT_CROSSING_H
#define WH_CONTACT_CROSSING_H

#include "contact_impact.h"
#include "contact_locate.h"

/* Reverses the sign of crossing k and makes its assignments. All values are evaluated before the first assignment. */
static inline void wh_contact_assign(const wh_contact_system *of, wh_contact_work *w, unsigned k,
                                     const wh_real *input, wh_contact_state *s) {
    wh_contact_point at;
    wh_real before[2 * WH_CONTACTS_MAX];
    wh_real after[2 * WH_CONTACTS_MAX];
    wh_real value[WH_SETS_MAX];
    const wh_contact *c = &of->contact[k];
    bool moves = false;
    unsigned sides = 0;
    w->mode[k] = (int8_t)-w->mode[k];
    if (c->sets == 0 || of->sets == NULL) {
        return;
    }
    wh_contact_point_of(of, s, &at);
    wh_contact_signals(of, at.phase, at.linear, at.rate, input, before);
    of->sets(of->model, at.phase, at.linear, at.rate, input, value);
    wh_books_levels(of, w, s, input, k, WH_R(-1.0));
    for (unsigned i = c->first_set; i < (unsigned)c->first_set + c->sets; i++) {
        const unsigned target = of->target[i];
        if (!wh_believable(value[i], target < of->angles ? WH_R(1e9) : WH_ABSURD)) {
            w->fault = (int)target;
        }
        moves = moves || target < of->coordinates;
        if (target < of->angles) {
            s->angle[target] = wh_angle_from_rad(value[i]);
        } else {
            s->real[target - of->angles] = value[i];
        }
        if (of->compensated) {
            s->carry[target] = WH_R(0.0);
        }
    }
    wh_books_levels(of, w, s, input, k, WH_R(1.0));
    wh_contact_point_of(of, s, &at);
    wh_contact_signals(of, at.phase, at.linear, at.rate, input, after);
    w->mover = k;
    for (unsigned l = 0; l < of->forced; l++) {
        const bool same = after[2 * l] == before[2 * l] && after[2 * l + 1] == before[2 * l + 1];
        /* A hold's signals do not include its expression, which may have changed with a coordinate. */
        w->moved |= same && !(moves && wh_contact_slips(of, w, l)) ? 0U : 1U << l;
    }
    unsigned onto = 0; /* bits: crossings whose values were set to zero */
    for (unsigned l = of->forced; l < of->contacts; l++) {
        const unsigned bit = after[2 * l] != before[2 * l] ? 1U << l : 0U;
        sides |= bit;
        onto |= after[2 * l] == WH_R(0.0) ? bit : 0U;
    }
    wh_contact_set_sides(of, w, sides, after);
    w->stands &= ~sides;
    w->stands |= onto | (w->located || after[2 * k] == WH_R(0.0) ? 1U << k & ~sides : 0U);
}

/* Decides the signs of the crossings in work->stands. The sign is that of the value's first derivative or, if that is
 * zero, of the second. If the two derivatives are zero, the sign becomes 0. */
WH_APART void wh_contact_turn_back(const wh_contact_system *of, wh_contact_work *w, wh_real h,
                                   const wh_real *input, wh_contact_state *s) {
    wh_contact_point at;
    wh_real accel[WH_COORDS];
    wh_real now[2 * WH_CONTACTS_MAX];
    wh_real ahead[2 * WH_CONTACTS_MAX];
    const wh_real span = h * WH_R(0.125);
    wh_contact_look(of, w, s, input, accel, now);
    for (unsigned order = 1; order <= 2; order++) {
        wh_contact_point_ahead(of, s, span, order == 2 ? accel : NULL, &at);
        for (unsigned i = 0; i < of->coordinates; i++) {
            at.rate[i] += span * accel[i];
        }
        wh_contact_signals(of, at.phase, at.linear, at.rate, input, ahead);
        for (unsigned k = of->forced; k < of->contacts; k++) {
            const wh_real gain = ahead[2 * k] - now[2 * k];
            if ((w->stands >> k & 1U) != 0 && WH_ABS(gain) > WH_R(0.0)) {
                w->stands &= ~(1U << k);
                if (gain > WH_R(0.0) ? w->mode[k] < 0 : w->mode[k] > 0) {
                    w->mode[k] = (int8_t)-w->mode[k];
                    /* never 0, because 0 means that the crossing has not turned back */
                    w->slack[k] = WH_R(2.0) * WH_ABS(now[2 * k]) + WH_R(1e-30);
                    w->due[k] = w->slack[k] + (order == 2 ? WH_ABS(gain) / 64 : WH_R(0.0));
                }
            }
        }
    }
    for (unsigned k = of->forced; k < of->contacts; k++) {
        if ((w->stands >> k & 1U) != 0) {
            w->mode[k] = 0;
            w->stood[k] = now[2 * k];
        }
    }
    w->stands = 0;
}

/* Saves the values of the crossings for wh_contact_carry(). */
WH_INLINE void wh_contact_remember(const wh_contact_system *of, const wh_real *signal,
                                   wh_real *before) {
    for (unsigned k = of->forced; k < of->contacts; k++) {
        before[2 * k] = signal[2 * k];
    }
}

/* Projecting a stop may change the values of crossings. If the value of a crossing in work->stands has changed by more
 * than its old magnitude, the crossing gets the sign of the new value, without an event. */
WH_INLINE void wh_contact_carry(const wh_contact_system *of, wh_contact_work *w,
                                const wh_real *before, const wh_real *signal) {
    unsigned sides = 0;
    for (unsigned k = of->forced; k < of->contacts; k++) {
        const wh_real by = WH_ABS(signal[2 * k] - before[2 * k]);
        sides |= by > WH_ABS(before[2 * k]) ? w->stands & 1U << k : 0U;
    }
    wh_contact_set_sides(of, w, sides, signal);
    w->stands &= ~sides;
}

/* Updates the signs of the crossings that have no event in the trial step. */
WH_INLINE void wh_contact_pass(const wh_contact_system *of, const wh_margins *m,
                               wh_contact_work *w) {
    unsigned passed = 0;
    WH_UNROLL
    for (unsigned k = of->forced; k < of->contacts; k++) {
        const wh_real value = m->signal[2 * k];
        const wh_real gone = w->mode[k] > 0 ? value : -value;
        const bool late = w->slack[k] > WH_R(0.0) && !(gone > w->due[k]);
        const bool stands = w->mode[k] == 0 && WH_ABS(value - w->stood[k]) <= WH_ABS(w->stood[k]);
        passed |= m->value[k] >= WH_R(0.0) && !late && !stands ? 1U << k : 0U;
        if (m->value[k] >= WH_R(0.0) && late) {
            w->mode[k] = 0;
            w->stood[k] = value;
        }
    }
    wh_contact_set_sides(of, w, passed, m->signal);
}

/* If any crossing has an undecided sign, saves the values of all crossings in work->stood. */
WH_INLINE void wh_contact_stand(const wh_contact_system *of, wh_contact_work *w,
                                const wh_real *input, wh_contact_state *s) {
    wh_contact_point at;
    wh_real signal[2 * WH_CONTACTS_MAX];
    bool some = false;
    for (unsigned k = of->forced; k < of->contacts; k++) {
        some = some || w->mode[k] == 0;
    }
    if (some) {
        wh_contact_point_of(of, s, &at);
        wh_contact_signals(of, at.phase, at.linear, at.rate, input, signal);
        for (unsigned k = of->forced; k < of->contacts; k++) {
            w->stood[k] = signal[2 * k];
        }
    }
}

#endif

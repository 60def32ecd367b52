/* contact_ledger.h: the contacts' entries in the ledger (ledger.h). Empty without WH_LEDGER. */
#ifndef WH_CONTACT_LEDGER_H
#define WH_CONTACT_LEDGER_H

#include "contact_work.h"

#if WH_LEDGER

/* True if the scene keeps a ledger and is in a step. Outside a step, as in wh_contact_observe(), books is NULL. */
WH_INLINE bool wh_books_open(const wh_contact_system *of, const wh_contact_work *w) {
    return of->ledger != NULL && w->books != NULL;
}

/* Enters the work and the impulse of contact k. `lambda` is a force during the time `share`, or an impulse with
 * `share` = 1. `speed` is the mean of J_k q'. Work on driven inputs belongs to the entries of the inputs. */
static inline void wh_books_enter(const wh_contact_system *of, const wh_contact_work *w, unsigned k,
                                  wh_real share, wh_real lambda, wh_real speed, const wh_real *rate,
                                  wh_real *entry) {
    const wh_real *row = wh_contact_law(of, w, k) + WH_LAW_ROWS;
    const unsigned first = wh_ledger_of_contact(of->ledger, k);
    const wh_real impulse = share * lambda;
    entry[first] += impulse * speed;
    for (unsigned i = 0; i < of->coordinates; i++) {
        if (i + of->driven >= of->coordinates) {
            entry[first] -= impulse * (row[i] * rate[i]);
        } else {
            entry[first + 1U + i] += impulse * row[i];
        }
    }
}

static inline void wh_books_stage(const wh_contact_system *of, const wh_contact_work *w,
                                  const wh_phase *phase, const wh_real *linear, const wh_real *rate,
                                  const wh_real *input) {
    if (!wh_books_open(of, w) || !(w->books->span > WH_R(0.0))) {
        return;
    }
    const wh_real share =
        wh_ledger_stage(of->ledger, of->method, phase, linear, rate, input, w->books);
    for (unsigned k = 0; k < of->forced && wh_contact_any_acts(of, w); k++) {
        if (w->force[k] != WH_R(0.0)) {
            wh_books_enter(of, w, k, share, w->force[k], wh_jacobian_times(of, w, k, rate), rate,
                           w->books->attempt);
        }
    }
}

/* Enters an impulse of contact k that changed its speed from `before` to `after`. Its work is the impulse times the
 * mean of these speeds (Kelvin). */
WH_INLINE void wh_books_impulse(const wh_contact_system *of, const wh_contact_work *w, unsigned k,
                                wh_real impulse, wh_real before, wh_real after,
                                const wh_real *rate) {
    if (wh_books_open(of, w)) {
        wh_books_enter(of, w, k, WH_R(1.0), impulse, WH_R(0.5) * (before + after), rate,
                       w->books->step);
    }
}

/* Adds the energy and the momenta, times `sign`, to the entries of crossing k. `sign` is -1 before the assignments and
 * 1 after the assignments. */
static inline void wh_books_levels(const wh_contact_system *of, const wh_contact_work *w,
                                   const wh_contact_state *s, const wh_real *input, unsigned k,
                                   wh_real sign) {
    if (!wh_books_open(of, w)) {
        return;
    }
    wh_real level[WH_ACCOUNTS_MAX];
    of->ledger->levels(of->ledger->model, s->angle, s->real,
                       s->real + (of->coordinates - of->angles), input, level);
    for (unsigned i = 0; i <= of->coordinates; i++) {
        w->books->step[wh_ledger_of_contact(of->ledger, k) + i] += sign * level[i];
    }
}

/* Call wh_books_look() before a projection, and wh_books_moved() after the projection. wh_books_moved() adds the change
 * of energy and momenta to the entries of contact k, except changes within round-off. */
static inline void wh_books_look(const wh_contact_system *of, wh_contact_work *w,
                                 const wh_contact_state *s, const wh_real *input) {
    if (wh_books_open(of, w)) {
        of->ledger->levels(of->ledger->model, s->angle, s->real,
                           s->real + (of->coordinates - of->angles), input, w->level);
    }
}

static inline void wh_books_moved(const wh_contact_system *of, const wh_contact_work *w,
                                  const wh_contact_state *s, const wh_real *input, unsigned k) {
    const wh_real rounding = WH_DOUBLE ? WH_R(0x1p-49) : WH_R(0x1p-20);
    wh_real level[WH_ACCOUNTS_MAX];
    if (!wh_books_open(of, w)) {
        return;
    }
    of->ledger->levels(of->ledger->model, s->angle, s->real,
                       s->real + (of->coordinates - of->angles), input, level);
    for (unsigned i = 0; i <= of->coordinates; i++) {
        const wh_real change = level[i] - w->level[i];
        if (WH_ABS(change) > rounding * WH_ABS(level[i])) {
            w->books->step[wh_ledger_of_contact(of->ledger, k) + i] += change;
        }
    }
}

WH_INLINE void wh_books_begin(const wh_contact_system *of, wh_contact_work *w,
                              const wh_angle *angle, wh_real span) {
    if (wh_books_open(of, w)) {
        wh_ledger_begin(of->ledger, angle, w->books, span);
    }
}

WH_INLINE void wh_books_end(const wh_contact_system *of, wh_contact_work *w) {
    if (wh_books_open(of, w)) {
        w->books->span = WH_R(0.0);
    }
}

WH_INLINE void wh_books_accept(const wh_contact_system *of, wh_contact_work *w) {
    if (wh_books_open(of, w)) {
        wh_ledger_accept(of->ledger, w->books);
    }
}

WH_INLINE void wh_books_commit(const wh_contact_system *of, const wh_contact_work *w,
                               wh_state *state) {
    if (wh_books_open(of, w)) {
        wh_ledger_commit(of->ledger, w->books, state);
    }
}

#else

#define wh_books_stage(of, w, phase, linear, rate, input) ((void)0)
#define wh_books_impulse(of, w, k, impulse, before, after, rate) ((void)0)
#define wh_books_levels(of, w, s, input, k, sign) ((void)0)
#define wh_books_look(of, w, s, input) ((void)0)
#define wh_books_moved(of, w, s, input, k) ((void)0)
#define wh_books_begin(of, w, angle, span) ((void)0)
#define wh_books_end(of, w) ((void)0)
#define wh_books_accept(of, w) ((void)0)
#define wh_books_commit(of, w, state) ((void)0)

#endif

#endif

/* contact_locate.h: the search for the first event of a trial step. */
#ifndef WH_CONTACT_LOCATE_H
#define WH_CONTACT_LOCATE_H

#include "contact_forces.h"

/* The distance of each contact from its event: positive before the event. */
typedef struct wh_margins {
    wh_real value[WH_CONTACTS_MAX];
    wh_real signal[2 * WH_CONTACTS_MAX];
    wh_real accel[WH_COORDS]; /* accelerations, only if wh_contact_watched() */
    /* sum of all signals and limits: finite only if each of them is */
    wh_real all;
} wh_margins;

/* The path over `h` seconds. Its positions follow the cubic through the positions and rates at both ends. Its rates
 * follow a second cubic, through the rates and accelerations (a0, a1) at both ends. The slope of the first cubic
 * would be less accurate. */
typedef struct wh_contact_path {
    wh_real h;
    wh_contact_point begin;
    wh_real way[WH_COORDS]; /* displacement from begin to end, rad or m */
    wh_real end_rate[WH_COORDS];
    wh_real gain[WH_COORDS]; /* change of the rates from begin to end */
    wh_real a0[WH_COORDS];
    wh_real a1[WH_COORDS];
} wh_contact_path;

static inline void wh_contact_path_of(const wh_contact_system *of, wh_contact_state *from,
                                      wh_contact_state *to, wh_real h, wh_contact_path *path) {
    const wh_real *v0 = wh_contact_rates(of, from);
    const wh_real *v1 = wh_contact_rates(of, to);
    path->h = h;
    wh_contact_point_of(of, from, &path->begin);
    for (unsigned i = 0; i < of->angles; i++) {
#if WH_DOUBLE
        path->way[i] = to->angle[i] - from->angle[i];
#else
        path->way[i] = (wh_real)(int64_t)((uint64_t)to->angle[i] - (uint64_t)from->angle[i]) /
                       WH_PHASE_PER_RAD;
#endif
    }
    for (unsigned i = of->angles; i < of->coordinates; i++) {
        path->way[i] = to->real[i - of->angles] - from->real[i - of->angles];
    }
    for (unsigned i = 0; i < of->coordinates; i++) {
        path->end_rate[i] = v1[i];
        path->gain[i] = v1[i] - v0[i];
    }
}

/* Computes the point of the path at the fraction `s` of its duration. */
WH_INLINE void wh_contact_between(const wh_contact_system *of, const wh_contact_path *path,
                                  wh_real s, wh_contact_point *at) {
    const wh_real rest = WH_R(1.0) - s;
    const wh_real far = s * s * (WH_R(3.0) - WH_R(2.0) * s);
    const wh_real near0 = path->h * s * rest * rest;
    const wh_real near1 = -path->h * s * s * rest;
    for (unsigned i = 0; i < of->coordinates; i++) {
        const wh_real v0 = path->begin.rate[i];
        const wh_real moved = path->way[i] * far + near0 * v0 + near1 * path->end_rate[i];
        at->rate[i] = v0 + path->gain[i] * far + near0 * path->a0[i] + near1 * path->a1[i];
        if (i < of->angles) {
            at->phase[i] = path->begin.phase[i];
            (void)wh_phase_move(at->phase[i], moved * WH_PHASE_PER_RAD, &at->phase[i]);
        } else {
            at->linear[i - of->angles] = path->begin.linear[i - of->angles] + moved;
        }
    }
}

/* Returns `margin`, the distance of contact k's force from its limit, or 0 if only round-off made this negative. */
static inline wh_real wh_contact_beyond(const wh_contact_system *of, const wh_contact_work *w,
                                        unsigned k, wh_real margin) {
    wh_real others = WH_R(0.0);
    if (margin < WH_R(0.0)) {
        for (unsigned l = 0; l < of->forced && of->forced > 1; l++) {
            const wh_real *way = wh_contact_law(of, w, l) + WH_LAW_ROWS + of->coordinates;
            others += l != k ? WH_ABS(wh_jacobian_times(of, w, k, way) * w->force[l]) : WH_R(0.0);
        }
        const bool rounding = -margin * wh_delassus_diagonal(of, w, k) <= WH_CONTACT_QUIET * others;
        return rounding ? WH_R(0.0) : margin;
    }
    return margin;
}

/* True if a stop rests or a friction sticks: their events depend on their forces. */
WH_INLINE bool wh_contact_watched(const wh_contact_system *of, const wh_contact_work *w) {
    WH_UNROLL
    for (unsigned k = 0; k < of->forced; k++) {
        if (wh_contact_is(of, k, WH_UNILATERAL | WH_LIMITED) && wh_contact_constrains(of, w, k)) {
            return true;
        }
    }
    return false;
}

/* Evaluates the margins at a point of the path. If wh_contact_watched(), also updates work->force. */
static inline void wh_contact_margins(const wh_contact_system *of, wh_contact_work *w,
                                      const wh_contact_point *at, const wh_real *input,
                                      wh_margins *m) {
    wh_contact_signals(of, at->phase, at->linear, at->rate, input, m->signal);
    if (wh_contact_watched(of, w)) {
        const wh_contact_model model = {of, w};
        wh_contact_accel(&model, at->phase, at->linear, at->rate, input, m->accel);
    }
    wh_real all = WH_R(0.0);
    WH_UNROLL
    for (unsigned k = 0; k < of->contacts; k++) {
        const wh_real signal = m->signal[2 * k];
        const wh_real speed = m->signal[2 * k + 1];
        const int8_t mode = w->mode[k];
        wh_real margin = WH_R(1.0);
        switch ((wh_contact_kind)of->contact[k].kind) {
        case WH_STOP:
            if (mode == WH_ACTIVE) {
                margin = wh_contact_beyond(of, w, k, w->force[k]);
            } else { /* a stop that was closed when the trial step began may now open */
                const bool leaves = (w->inside >> k & 1U) != 0 && speed > WH_R(0.0);
                margin = signal < WH_R(0.0) && leaves ? -signal : signal;
            }
            all += signal + speed;
            break;
        case WH_HOLD:
            margin = mode == WH_ACTIVE ? signal : -signal;
            all += signal + speed;
            break;
        case WH_FRICTION:
            if (mode == WH_STUCK) {
                all += wh_contact_law(of, w, k)[WH_LAW_FIRST];
                margin = wh_contact_beyond(
                    of, w, k, wh_contact_law(of, w, k)[WH_LAW_FIRST] - WH_ABS(w->force[k]));
            } else {
                margin = (mode > 0 ? signal : -signal) + w->slack[k];
            }
            all += signal;
            break;
        case WH_WHEN: /* a crossing has events only in its direction */
            if (mode != 0 && of->contact[k].direction != mode) {
                margin = (mode > 0 ? signal : -signal) + w->slack[k];
            }
            all += signal;
            break;
        case WH_CONTACT_KIND_COUNT: break;
        }
        m->value[k] = margin;
    }
    m->all = all;
}

/* True if no event has happened and all values are finite. (A margin that is NaN never counts as an event.) */
WH_INLINE bool wh_contact_calm(const wh_contact_system *of, const wh_margins *m) {
    bool calm = wh_finite(m->all);
    WH_UNROLL
    for (unsigned k = 0; k < of->contacts; k++) {
        calm = calm && m->value[k] >= WH_R(0.0);
    }
    return calm;
}

/* Stores in work->undefined a contact whose signal, limit or margin is not finite. */
WH_APART void wh_contact_find_undefined(const wh_contact_system *of, wh_contact_work *w,
                                        const wh_margins *m) {
    for (unsigned k = 0; k < of->contacts; k++) {
        wh_contact_expect(w, k, m->signal[2 * k]);
        wh_contact_expect(w, k, m->signal[2 * k + 1]);
    }
    if (wh_contact_any_acts(of, w)) {
        wh_contact_expect_laws(of, w);
    }
    for (unsigned k = 0; k < of->contacts; k++) {
        wh_contact_expect(w, k, m->value[k]);
    }
}

/* Returns the contacts whose event has happened, as bits. */
WH_INLINE unsigned wh_contact_happened(const wh_contact_system *of, const wh_margins *m) {
    unsigned bits = 0;
    for (unsigned k = 0; k < of->contacts; k++) {
        bits |= m->value[k] < WH_R(0.0) ? 1U << k : 0U;
    }
    return bits;
}

WH_INLINE void wh_contact_slacken(const wh_contact_system *of, const wh_contact_work *w,
                                  unsigned events, wh_margins *m) {
    for (unsigned k = 0; k < of->forced; k++) {
        if (wh_contact_of(of, k, WH_HOLD) && w->slack[k] > WH_R(0.0)) {
            m->value[k] += w->slack[k];
            m->value[k] =
                (events >> k & 1U) == 0 && m->value[k] < WH_R(0.0) ? WH_R(0.0) : m->value[k];
        }
    }
}

/* If there are several contacts, the search is not inlined, to save stack. */
#if WH_CONTACTS_MAX > 1
#define WH_SEARCH WH_APART
#else
#define WH_SEARCH static inline
#endif

/* Locates the first event between `from` and `to`. Returns its time as a fraction of h, late by at most WH_BRACKET.
 * *events gets the contacts with an event at that time. at_end are the margins at `to`. */
WH_SEARCH wh_real wh_contact_locate(const wh_contact_system *of, wh_contact_work *w,
                                    wh_contact_state *from, wh_contact_state *to, wh_real h,
                                    const wh_real *input, const wh_margins *at_end,
                                    unsigned *events) {
    const wh_contact_model model = {of, w};
    wh_contact_path path;
    wh_contact_point at;
    wh_margins probe;
    wh_real before[WH_CONTACTS_MAX] = {WH_R(0.0)}; /* margins at `low` */
    wh_real after[WH_CONTACTS_MAX] = {WH_R(0.0)};  /* margins at `high` */
    wh_real low = WH_R(0.0);
    wh_real high = WH_R(1.0);
    const unsigned at_end_events = wh_contact_happened(of, at_end);
    *events = at_end_events;

    /* A negative margin at the start is an event at the start, except for a sliding friction. */
    wh_contact_path_of(of, from, to, h, &path);
    wh_contact_margins(of, w, &path.begin, input, &probe);
    wh_contact_slacken(of, w, *events, &probe);
    unsigned at_once = 0;
    unsigned sliding = 0;
    unsigned loads = 0; /* bits: contacts whose event depends on their force */
    for (unsigned k = 0; k < of->contacts; k++) {
        const bool load = k < of->forced && wh_contact_is(of, k, WH_UNILATERAL | WH_LIMITED) &&
                          wh_contact_constrains(of, w, k);
        const bool slides =
            k < of->forced && wh_contact_of(of, k, WH_FRICTION) && w->mode[k] != WH_STUCK;
        sliding |= slides ? 1U << k : 0U;
        loads |= load ? 1U << k : 0U;
        before[k] = probe.value[k];
        after[k] = at_end->value[k];
        if ((*events >> k & 1U) != 0 && !slides && before[k] < WH_R(0.0)) {
            at_once |= 1U << k;
        }
        /* if the gap was open or closing at the start and is negative at the end, the stop was hit */
        if (wh_contact_any_of(of, WH_STOP) &&
            (probe.signal[2 * k] > WH_R(0.0) || probe.signal[2 * k + 1] < WH_R(0.0))) {
            w->inside &= ~(1U << k);
        }
    }
    if (at_once != 0) {
        *events = at_once;
        return WH_R(0.0);
    }
    if (wh_contact_watched(of, w)) {
        for (unsigned i = 0; i < of->coordinates; i++) {
            path.a0[i] = probe.accel[i];
            path.a1[i] = at_end->accel[i];
        }
    } else {
        const wh_contact_point *begin = &path.begin;
        wh_contact_accel(&model, begin->phase, begin->linear, begin->rate, input, path.a0);
        wh_contact_point_of(of, to, &at);
        wh_contact_accel(&model, at.phase, at.linear, at.rate, input, path.a1);
    }
    wh_real reach = WH_R(1.0);
    wh_real earlier[2] = {WH_R(4.0), WH_R(4.0)};
    /* Largest width of the interval after the next probe. */
    wh_real most = WH_PROBES_SPARE;
    for (unsigned i = 0; i < WH_PROBES && high - low > WH_BRACKET_FINE; i++) {
        const wh_real width = high - low;
        wh_real root = high;
        for (unsigned k = 0; k < of->contacts; k++) {
            const bool begins =
                (sliding >> k & 1U) == 0 && (low == WH_R(0.0) || (loads >> k & 1U) == 0);
            if ((*events >> k & 1U) != 0 &&
                (before[k] > WH_R(0.0) || (before[k] == WH_R(0.0) && begins))) {
                const wh_real share = before[k] / (before[k] - after[k]);
                root = low + width * share < root ? low + width * share : root;
            }
        }
        /* `over` shifts the guess, so that the event is probably in the interval's shorter part. */
        const wh_real over =
            width * (width < WH_R(0.015625) ? width : WH_R(0.015625)) * reach + WH_BRACKET_FINE / 4;
        wh_real guess = low + WH_R(0.5) * width;
        wh_real if_found = reach;
        wh_real if_not = reach;
        if (width > WH_R(0.5) * earlier[0]) {
        } else if (root - low > high - root) {
            guess = root - over;
            if_found = reach * WH_R(8.0);
            if_not = WH_R(1.0);
        } else {
            guess = root + over;
            if_found = WH_R(1.0);
            if_not = reach * WH_R(8.0);
        }
        guess = guess < high - most ? high - most : guess;
        guess = guess > low + most ? low + most : guess;
        if (!(guess > low && guess < high)) {
            guess = low + WH_R(0.5) * width;
        }
        earlier[0] = earlier[1];
        earlier[1] = width;
        most *= WH_R(0.5);
        wh_contact_between(of, &path, guess, &at);
        wh_contact_margins(of, w, &at, input, &probe);
        wh_contact_slacken(of, w, at_end_events, &probe);
        const unsigned found = wh_contact_happened(of, &probe);
        reach = found != 0 ? if_found : if_not;
        if (found != 0) {
            high = guess;
            *events = found;
        } else {
            low = guess;
        }
        for (unsigned k = 0; k < of->contacts; k++) {
            before[k] = found != 0 ? before[k] : probe.value[k];
            after[k] = found != 0 ? probe.value[k] : after[k];
        }
    }
    return high;
}

#endif

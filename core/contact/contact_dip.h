/* contact_dip.h: stops that a body enters and leaves again within one trial step. */
#ifndef WH_CONTACT_DIP_H
#define WH_CONTACT_DIP_H

#include "contact_locate.h"

/* A trial step from `now` to `next`. */
typedef struct wh_contact_attempt {
    wh_contact_state now;
    wh_contact_state next;
    wh_real span;       /* length of the trial step, s; wh_contact_attempt_dipped() sets it */
    wh_margins margins; /* at `next` */
    /* bits: free stops whose gap grows at `next`, but is so small that it may have been closed during the trial step */
    unsigned leaving;
    unsigned dips; /* bits: stops open at `now` and `next`, perhaps closed in between */
    int fault;     /* if !sound: the component that left its bounds */
    bool made;
    bool sound; /* `next` is within bounds */
} wh_contact_attempt;

/* Intersects the tangents to the gap at both ends of a trial step. Returns the time of their intersection as a fraction
 * of h; *least gets their value there. If the gap is convex in time, as for a body that passes a round obstacle, *least
 * is a lower bound of the gap. gap[2] and rate[2] are the values at the ends, which are h seconds apart. */
WH_INLINE wh_real wh_contact_tangents(const wh_real *gap, const wh_real *rate, wh_real h,
                                      wh_real *least) {
    const wh_real share = (gap[1] - gap[0] - rate[1] * h) / ((rate[0] - rate[1]) * h);
    *least = gap[0] + rate[0] * h * share;
    return share;
}

/* Finds impacts on the stops in a->leaving. If an impact is only possible, sets the stop's bit in a->dips. */
WH_INLINE void wh_contact_attempt_dipped(const wh_contact_system *of, wh_contact_work *w,
                                         wh_real span, const wh_real *input,
                                         wh_contact_attempt *a) {
    wh_contact_point at;
    wh_real before[2 * WH_CONTACTS_MAX];
    a->span = span;
    a->dips = 0;
    if (!wh_contact_any_of(of, WH_STOP) || a->leaving == 0) {
        return;
    }
    wh_contact_point_of(of, &a->now, &at);
    wh_contact_signals(of, at.phase, at.linear, at.rate, input, before);
    for (unsigned k = 0; k < of->forced; k++) {
        const bool closes = before[2 * k] > WH_R(0.0) || before[2 * k + 1] < WH_R(0.0);
        if ((a->leaving >> k & 1U) == 0) {
            continue;
        }
        if (a->margins.signal[2 * k] >= WH_R(0.0)) {
            const wh_real gap[2] = {before[2 * k], a->margins.signal[2 * k]};
            const wh_real rate[2] = {before[2 * k + 1], a->margins.signal[2 * k + 1]};
            wh_real least = WH_R(0.0);
            if (gap[0] > WH_R(0.0) && rate[0] < WH_R(0.0)) {
                (void)wh_contact_tangents(gap, rate, a->span, &least);
            }
            a->dips |= least < WH_R(0.0) ? 1U << k : 0U;
        } else if (closes) {
            w->inside &= ~(1U << k);
            a->margins.value[k] = a->margins.signal[2 * k];
        }
    }
}

/* Searches the gaps of the stops in a->dips for a negative value. Returns the earliest time found, as a fraction of the
 * trial step, or 1 if there is none. */
WH_APART wh_real wh_contact_dip(const wh_contact_system *of, wh_contact_attempt *a,
                                const wh_real *input) {
    const wh_real h = a->span;
    wh_contact_path path;
    wh_contact_point at;
    wh_real signal[2 * WH_CONTACTS_MAX];
    wh_real first = WH_R(1.0);
    wh_contact_path_of(of, &a->now, &a->next, h, &path);
    /* with these accelerations the rates are linear in time */
    for (unsigned i = 0; i < of->coordinates; i++) {
        path.a0[i] = path.gain[i] / h;
        path.a1[i] = path.gain[i] / h;
    }
    wh_contact_signals(of, path.begin.phase, path.begin.linear, path.begin.rate, input, signal);
    for (unsigned k = 0; k < of->forced; k++) {
        wh_real gap[2] = {signal[2 * k], a->margins.signal[2 * k]};
        wh_real rate[2] = {signal[2 * k + 1], a->margins.signal[2 * k + 1]};
        wh_real end[2] = {WH_R(0.0), WH_R(1.0)};
        bool more = (a->dips >> k & 1U) != 0;
        bool back = false;
        for (unsigned i = 0; i < WH_DIP_PROBES && more; i++) {
            wh_real probe[2 * WH_CONTACTS_MAX];
            wh_real least;
            const wh_real width = end[1] - end[0];
            wh_real share = end[0] + width * wh_contact_tangents(gap, rate, h * width, &least);
            if (back) {
                share = WH_R(0.5) * (share + end[0] - gap[0] / (rate[0] * h));
            } else if ((i & 1U) != 0) {
                share = end[0] + width * (rate[0] / (rate[0] - rate[1]));
            }
            more = least < WH_R(0.0) && share > end[0] && share < end[1];
            if (more) {
                wh_contact_between(of, &path, share, &at);
                wh_contact_signals(of, at.phase, at.linear, at.rate, input, probe);
                const unsigned opens = probe[2 * k + 1] > WH_R(0.0);
                const bool inside = !(probe[2 * k] >= WH_R(0.0));
                first = probe[2 * k] < WH_R(0.0) && share < first ? share : first;
                more = !inside || !back;
                back = inside;
                if (!inside) {
                    end[opens] = share;
                    gap[opens] = probe[2 * k];
                    rate[opens] = probe[2 * k + 1];
                }
            }
        }
    }
    return first;
}

#endif

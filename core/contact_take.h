/* contact_take.h: what an event does (see contact.h). */
#ifndef WH_CONTACT_TAKE_H
#define WH_CONTACT_TAKE_H

#include "contact_settle.h"

/* Would a flight that begins with `speed` be too short, as stop k is pressed? work->law and accel[] must
 * belong to the state. */
WH_INLINE bool wh_contact_rests(const wh_hybrid *of, const wh_contact_work *w, unsigned k,
                                wh_real h, bool rest, wh_real speed, const wh_real *accel) {
    const wh_real pressing = -(wh_along(of, w, k, accel) + wh_law(of, w, k)[WH_LAW_BIAS]);
    return pressing > WH_R(0.0) && (rest || speed + speed <= pressing * (h * WH_REST_SHARE));
}

/* A stop is hit: restitution, or rest when the flight that follows would be too short. What is to rest
 * gets one impulse: two, there and back, would let stops go that the one holds. */
static inline wh_real wh_contact_hit(const wh_hybrid *of, wh_contact_work *w, unsigned k, wh_real h,
                                     bool rest, const wh_real *input, wh_contact_state *s) {
    wh_real accel[WH_COORDS];
    wh_real signal[2 * WH_CONTACTS_MAX];
    wh_real *rate = wh_contact_rates(of, s);
    wh_real impulse = WH_R(0.0);
    wh_contact_look(of, w, s, input, accel, signal);
    wh_real speed = wh_along(of, w, k, rate);
    if (speed < WH_R(0.0)) {
        speed *= -wh_law(of, w, k)[WH_LAW_FIRST];
        speed = wh_contact_rests(of, w, k, h, rest, speed, accel) ? WH_R(0.0) : speed;
        impulse = wh_contact_impulse(of, w, k, speed, rate);
        wh_contact_look(of, w, s, input, accel, signal);
    }
    if (wh_contact_rests(of, w, k, h, rest, speed, accel)) {
        if (speed > WH_R(0.0)) {
            impulse += wh_contact_impulse(of, w, k, WH_R(0.0), rate);
        }
        w->mode[k] = WH_ACTIVE;
        wh_contact_close(of, w, signal, s);
    }
    return impulse;
}

/* A crossing's assignments, all evaluated before any is made. */
static inline void wh_contact_assign(const wh_hybrid *of, wh_contact_work *w, unsigned k,
                                     const wh_real *input, wh_contact_state *s) {
    wh_contact_point at;
    wh_real before[2 * WH_CONTACTS_MAX];
    wh_real after[2 * WH_CONTACTS_MAX];
    wh_real value[WH_SETS_MAX];
    const wh_contact *c = &of->contact[k];
    w->mode[k] = (int8_t)-w->mode[k];
    if (c->sets == 0 || of->sets == NULL) {
        return;
    }
    wh_contact_point_of(of, s, &at);
    of->signals(of->model, at.phase, at.linear, at.rate, input, before);
    of->sets(of->model, at.phase, at.linear, at.rate, input, value);
    wh_books_levels(of, w, s, input, k, WH_R(-1.0));
    for (unsigned i = c->first_set; i < (unsigned)c->first_set + c->sets; i++) {
        const unsigned target = of->target[i];
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
    /* where the assignment leaves each crossing, if it moved it */
    wh_contact_point_of(of, s, &at);
    of->signals(of->model, at.phase, at.linear, at.rate, input, after);
    for (unsigned l = of->forced; l < of->contacts; l++) {
        if (after[2 * l] != before[2 * l] && after[2 * l] != WH_R(0.0)) {
            w->mode[l] = after[2 * l] > WH_R(0.0) ? 1 : -1;
        }
    }
}

/* The rate is zero but for what the location left: friction, which would take that away in no time, does,
 * and sticks. What holds or sticks already stays so: else two frictions would shake each other loose. */
WH_INLINE void wh_contact_stick(const wh_hybrid *of, wh_contact_work *w, unsigned k,
                                wh_real *rate) {
    w->mode[k] = WH_STUCK;
    wh_contact_still(of, w, true, rate);
}

/* Take one event of contact k. `rest`: no more bounces in this step. */
static inline wh_real wh_contact_take(const wh_hybrid *of, wh_contact_work *w, unsigned k,
                                      wh_real h, bool rest, const wh_real *input,
                                      wh_contact_state *s) {
    wh_real accel[WH_COORDS];
    wh_real signal[2 * WH_CONTACTS_MAX];
    wh_real *rate = wh_contact_rates(of, s);
    wh_real impulse = WH_R(0.0);
    switch (of->contact[k].kind) {
    case WH_STOP:
        if (w->mode[k] == WH_ACTIVE) {
            w->mode[k] = WH_FREE;
        } else {
            impulse = wh_contact_hit(of, w, k, h, rest, input, s);
        }
        break;
    case WH_HOLD:
        w->mode[k] = w->mode[k] == WH_ACTIVE ? WH_FREE : WH_ACTIVE;
        if (w->mode[k] == WH_ACTIVE) {
            wh_contact_look(of, w, s, input, accel, signal);
            impulse = wh_contact_impulse(of, w, k, WH_R(0.0), rate);
        }
        break;
    case WH_FRICTION:
        wh_contact_look(of, w, s, input, accel, signal);
        if (w->mode[k] == WH_STUCK) {
            w->mode[k] = w->force[k] > WH_R(0.0) ? -1 : 1;
        } else {
            wh_contact_stick(of, w, k, rate);
        }
        break;
    default: wh_contact_assign(of, w, k, input, s); break;
    }
    return impulse;
}

/* Modes at the start of a run: sticks what is at rest, captures what a hold's condition says. */
static inline void wh_contact_begin(const wh_hybrid *of, wh_contact_work *w, wh_real h,
                                    const wh_real *input, wh_contact_state *s) {
    wh_real accel[WH_COORDS];
    wh_real signal[2 * WH_CONTACTS_MAX];
    for (unsigned k = 0; k < of->contacts; k++) {
        w->mode[k] = 0; /* free, stuck, on no side */
    }
    wh_contact_look(of, w, s, input, accel, signal);
    for (unsigned k = 0; k < of->contacts; k++) {
        const wh_real value = signal[2 * k];
        switch (of->contact[k].kind) {
        case WH_STOP:
            if (value <= WH_R(0.0) && signal[2 * k + 1] <= WH_R(0.0)) {
                (void)wh_contact_take(of, w, k, h, false, input, s);
            }
            break;
        case WH_HOLD:
            if (value > WH_R(0.0)) {
                (void)wh_contact_take(of, w, k, h, false, input, s);
            }
            break;
        case WH_FRICTION: break;
        default: w->mode[k] = (int8_t)((value > WH_R(0.0)) - (value < WH_R(0.0))); break;
        }
    }
    wh_contact_settle(of, w, 0, input, s);
}

#endif

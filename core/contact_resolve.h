/* contact_resolve.h: what an event does (see contact.h). */
#ifndef WH_CONTACT_RESOLVE_H
#define WH_CONTACT_RESOLVE_H

#include "contact_settle.h"

/* Would a flight that begins with `speed` be too short, as stop k is pressed? work->law and accel[] must
 * belong to the state. */
WH_INLINE bool wh_contact_rests(const wh_contact_system *of, const wh_contact_work *w, unsigned k,
                                wh_real h, bool rest, wh_real speed, const wh_real *accel) {
    const wh_real pressing =
        -(wh_jacobian_times(of, w, k, accel) + wh_contact_law(of, w, k)[WH_LAW_BIAS]);
    if (pressing == WH_R(0.0)) {
        return speed == WH_R(0.0);
    }
    return pressing > WH_R(0.0) && (rest || speed + speed <= pressing * (h * WH_REST_SHARE));
}

/* Stops that rest, as bits. */
WH_INLINE unsigned wh_contact_resting(const wh_contact_system *of, const wh_contact_work *w) {
    unsigned bits = 0;
    for (unsigned k = 0; k < of->forced; k++) {
        bits |= of->contact[k].kind == WH_STOP && w->mode[k] == WH_ACTIVE ? 1U << k : 0U;
    }
    return bits;
}

/* Of the stops `gone`, that an impact let go, those whose flight would be too short rest on, together with
 * what rests: else a body in a corner would be thrown to and fro without an end. */
static inline void wh_contact_stay(const wh_contact_system *of, wh_contact_work *w, unsigned gone,
                                   wh_real h, bool rest, const wh_real *accel,
                                   const wh_real *signal, const wh_real *input,
                                   wh_contact_state *s) {
    wh_real *rate = wh_contact_rates(of, s);
    bool stays = false;
    for (unsigned k = 0; k < of->forced; k++) {
        if ((gone >> k & 1U) != 0 &&
            wh_contact_rests(of, w, k, h, rest, wh_jacobian_times(of, w, k, rate), accel)) {
            w->mode[k] = WH_ACTIVE;
            stays = true;
        }
    }
    if (stays) {
        wh_contact_project_rates(of, w, 0, true, rate);
        (void)wh_contact_project_places(of, w, &WH_CONTACT_HERE, signal, input, s);
    }
}

/* Free stops, but k, that an impulse made close while they are touched, as near as events are located: they
 * are hit at the same moment. `before` and `after` are the signals beside it. */
WH_INLINE void wh_contact_touched(const wh_contact_system *of, wh_contact_work *w, unsigned k,
                                  wh_real h, const wh_real *before, const wh_real *after) {
    for (unsigned l = 0; l < of->forced && of->forced > 1; l++) {
        const wh_real speed = after[2 * l + 1];
        const bool free = of->contact[l].kind == WH_STOP && w->mode[l] == WH_FREE && l != k;
        if (free && speed < WH_R(0.0) && speed < before[2 * l + 1] + before[2 * l + 1] &&
            after[2 * l] <= -speed * (h * WH_BRACKET)) {
            w->hit_next |= 1U << l;
        }
    }
}

/* Free stops without restitution that are touched and at rest when k's speed is to change so: nothing presses
 * them, but they are in the way of what the impact moves. One after the other, two plastic impacts would go on
 * for ever; with restitution they do not, and are taken so. */
static inline unsigned wh_contact_beside(const wh_contact_system *of, const wh_contact_work *w,
                                         unsigned k, wh_real h, wh_real change,
                                         const wh_real *signal, const wh_real *rate) {
    const wh_real *way = wh_contact_law(of, w, k) + WH_LAW_ROWS + of->coordinates;
    unsigned bits = 0;
    for (unsigned l = 0; l < of->forced && of->forced > 1; l++) {
        const bool free = of->contact[l].kind == WH_STOP && w->mode[l] == WH_FREE && l != k;
        if (free && !(wh_contact_law(of, w, l)[WH_LAW_FIRST] > WH_R(0.0))) {
            const wh_real passed_on =
                WH_ABS(wh_jacobian_times(of, w, l, way) * change) / wh_delassus_diagonal(of, w, k);
            const bool touched = signal[2 * l] <= passed_on * (h * WH_BRACKET);
            const bool rests =
                WH_ABS(wh_jacobian_times(of, w, l, rate)) <= WH_CONTACT_STILL * passed_on;
            bits |= touched && rests && passed_on > WH_R(0.0) ? 1U << l : 0U;
        }
    }
    return bits;
}

/* A stop is hit: restitution, or rest when the flight that follows would be too short. What is to rest
 * gets one impulse: two, there and back, would let stops go that the one holds. */
static inline wh_real wh_contact_hit(const wh_contact_system *of, wh_contact_work *w, unsigned k,
                                     wh_real h, bool rest, const wh_real *input,
                                     wh_contact_state *s) {
    wh_real accel[WH_COORDS];
    wh_real signal[2 * WH_CONTACTS_MAX];
    wh_real *rate = wh_contact_rates(of, s);
    wh_real before[2 * WH_CONTACTS_MAX];
    wh_real impulse = WH_R(0.0);
    const unsigned resting = wh_contact_resting(of, w);
    wh_contact_look(of, w, s, input, accel, signal);
    wh_real speed = wh_jacobian_times(of, w, k, rate);
    const wh_real before_speed = speed;
    unsigned beside = 0;
    if (speed < WH_R(0.0)) {
        const wh_real given = wh_contact_law(of, w, k)[WH_LAW_FIRST];
        wh_contact_expect(w, k, given);
        const wh_real restitution =
            given > WH_R(0.0) ? (given < WH_R(1.0) ? given : WH_R(1.0)) : WH_R(0.0);
        speed *= -restitution;
        speed = wh_contact_rests(of, w, k, h, rest, speed, accel) ? WH_R(0.0) : speed;
        beside = wh_contact_beside(of, w, k, h, speed - before_speed, signal, rate);
        impulse = wh_contact_impulse(of, w, k, beside, speed, rate);
        for (unsigned i = 0; i < 2U * of->forced; i++) {
            before[i] = signal[i];
        }
        wh_contact_look(of, w, s, input, accel, signal);
        wh_contact_touched(of, w, k, h, before, signal);
    }
    if (wh_contact_rests(of, w, k, h, rest, speed, accel)) {
        if (speed > WH_R(0.0)) {
            impulse += wh_contact_impulse(of, w, k, beside, WH_R(0.0), rate);
        }
        wh_contact_place place = WH_CONTACT_HERE;
        if (before_speed == WH_R(0.0) && signal[2 * k] < WH_R(0.0)) {
            place.but =
                wh_contact_stuck(of, w); /* at rest beyond it: friction does not keep it there */
        }
        w->mode[k] = WH_ACTIVE;
        (void)wh_contact_project_places(of, w, &place, signal, input, s);
    }
    const unsigned gone = resting & ~wh_contact_resting(of, w);
    if (gone != 0) {
        wh_contact_stay(of, w, gone, h, rest, accel, signal, input, s);
    }
    return impulse;
}

/* A crossing's assignments, all evaluated before any is made. */
static inline void wh_contact_assign(const wh_contact_system *of, wh_contact_work *w, unsigned k,
                                     const wh_real *input, wh_contact_state *s) {
    wh_contact_point at;
    wh_real before[2 * WH_CONTACTS_MAX];
    wh_real after[2 * WH_CONTACTS_MAX];
    wh_real value[WH_SETS_MAX];
    const wh_contact *c = &of->contact[k];
    bool moves = false;
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
    /* where the assignment leaves each contact, if it moved it */
    wh_contact_point_of(of, s, &at);
    wh_contact_signals(of, at.phase, at.linear, at.rate, input, after);
    w->mover = k;
    for (unsigned l = 0; l < of->forced && moves; l++) {
        w->moved |= wh_contact_slips(of, w, l) ? 1U << l : 0U; /* what it keeps from now on */
    }
    for (unsigned l = 0; l < of->forced; l++) {
        const bool same = after[2 * l] == before[2 * l] && after[2 * l + 1] == before[2 * l + 1];
        w->moved |= same ? 0U : 1U << l;
    }
    for (unsigned l = of->forced; l < of->contacts; l++) {
        if (after[2 * l] != before[2 * l] && after[2 * l] != WH_R(0.0)) {
            w->mode[l] = after[2 * l] > WH_R(0.0) ? 1 : -1;
        }
    }
}

/* Friction breaks loose, or its rate has come to zero; whether that sticks is for settling to decide. Where an
 * impact of the same moment threw it, its new rate says all. */
static inline void wh_contact_turn(const wh_contact_system *of, wh_contact_work *w, unsigned k,
                                   const wh_real *input, wh_contact_state *s) {
    wh_real accel[WH_COORDS];
    wh_real signal[2 * WH_CONTACTS_MAX];
    const unsigned pin = (unsigned)of->contact[k].pin;
    const wh_real v = wh_contact_rates(of, s)[pin];
    if (v != w->came[pin]) {
        return;
    }
    if (w->mode[k] != WH_STUCK) {
        w->mode[k] = WH_STUCK;
        w->turned |= 1U << k;
        return;
    }
    wh_contact_look(of, w, s, input, accel, signal);
    w->mode[k] = w->force[k] > WH_R(0.0) ? -1 : 1;
    const wh_real forward = w->mode[k] > 0 ? v : -v;
    w->slack[k] = forward < WH_R(0.0) ? -(forward + forward) : WH_R(0.0);
}

/* Take one event of contact k. `rest`: no more bounces in this step. */
static inline wh_real wh_contact_take(const wh_contact_system *of, wh_contact_work *w, unsigned k,
                                      wh_real h, bool rest, const wh_real *input,
                                      wh_contact_state *s) {
    wh_real accel[WH_COORDS];
    wh_real before[2 * WH_CONTACTS_MAX];
    wh_real after[2 * WH_CONTACTS_MAX];
    wh_contact_point at;
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
            wh_contact_look(of, w, s, input, accel, before);
            wh_contact_capture(of, w, k);
            impulse = wh_contact_impulse(of, w, k, 0, WH_R(0.0), rate);
            wh_contact_point_of(of, s, &at);
            wh_contact_signals(of, at.phase, at.linear, at.rate, input, after);
            wh_contact_touched(of, w, k, h, before, after);
        }
        break;
    case WH_FRICTION: wh_contact_turn(of, w, k, input, s); break;
    default: wh_contact_assign(of, w, k, input, s); break;
    }
    return impulse;
}

/* Where an input has moved a resting stop since the last step: the body is put back onto it, or falls if
 * what presses it does not close the gap within the step. The energy is the stop's. What an input does to a held
 * expression moves nobody: the hold keeps the new value. */
static inline void wh_contact_follow(const wh_contact_system *of, wh_contact_work *w, wh_real h,
                                     const wh_real *input, wh_contact_state *s) {
    wh_real accel[WH_COORDS];
    wh_real signal[2 * WH_CONTACTS_MAX];
    unsigned moved = WH_CONTACTS_MAX;
    bool held = false;
    bool falls = false;
    for (unsigned k = 0; k < of->forced; k++) {
        const bool rests = of->contact[k].kind == WH_STOP && w->mode[k] == WH_ACTIVE;
        moved = rests && of->contact[k].direction != 0 ? k : moved;
        held = held || (wh_contact_slips(of, w, k) && of->contact[k].direction < 0);
    }
    if (moved == WH_CONTACTS_MAX && !held) {
        return;
    }
    wh_contact_look(of, w, s, input, accel, signal);
    for (unsigned k = 0; k < of->forced; k++) {
        const wh_contact *c = &of->contact[k];
        if (c->kind == WH_STOP && c->direction != 0 && w->mode[k] == WH_ACTIVE) {
            const wh_real closes = WH_R(0.5) * h * h * w->force[k] * wh_delassus_diagonal(of, w, k);
            w->mode[k] = signal[2 * k] > closes ? WH_FREE : WH_ACTIVE;
            falls = falls || w->mode[k] == WH_FREE;
        } else if (c->direction < 0) {
            wh_contact_capture(of, w, k);
        }
    }
    if (moved == WH_CONTACTS_MAX) {
        return;
    }
    const wh_contact_place place = {NULL, WH_R(0.0), 0, moved};
    (void)wh_contact_project_places(of, w, &place, signal, input, s);
    if (falls) {
        wh_contact_settle(of, w, h, 0, input, s);
    }
}

/* Modes at the start of a run: sticks what is at rest, captures what a hold's condition says. */
static inline void wh_contact_begin(const wh_contact_system *of, wh_contact_work *w, wh_real h,
                                    const wh_real *input, wh_contact_state *s) {
    wh_real accel[WH_COORDS];
    wh_real signal[2 * WH_CONTACTS_MAX];
    for (unsigned k = 0; k < of->contacts; k++) {
        w->mode[k] = 0; /* free, stuck, on no side */
    }
    (void)wh_contact_slides(of, w, WH_R(0.0), wh_contact_rates(of, s));
    wh_contact_look(of, w, s, input, accel, signal);
    for (unsigned k = 0; k < of->contacts; k++) {
        wh_contact_expect(w, k, signal[2 * k] + signal[2 * k + 1]);
    }
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
    wh_contact_settle(of, w, h, 0, input, s);
}

#endif

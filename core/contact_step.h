/* contact_step.h: one step of a scene with contacts (see contact.h). */
#ifndef WH_CONTACT_STEP_H
#define WH_CONTACT_STEP_H

#include "contact_events.h"

WH_INLINE void wh_contact_modes(const wh_hybrid *of, const wh_state *state, wh_contact_work *w) {
    for (unsigned k = 0; k < WH_CONTACTS_MAX; k++) {
        w->mode[k] = k < of->contacts ? state->contacts->mode[k] : (int8_t)0;
    }
}

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

/* Put a resting stop's gap to zero. work->law must belong to this position. */
static inline void wh_contact_close(const wh_hybrid *of, const wh_contact_work *w, unsigned k,
                                    wh_real gap, wh_contact_state *s) {
    const wh_real *row = wh_law(of, w, k) + WH_LAW_ROWS;
    const wh_real *way = row + of->coordinates;
    const int pin = of->contact[k].pin;
    if (pin >= 0) { /* the others need not move for it */
        wh_contact_move(of, (unsigned)pin, -gap / row[pin], s);
        return;
    }
    const wh_real amount = -gap / wh_along(of, w, k, way);
    for (unsigned i = 0; i < of->coordinates; i++) {
        wh_contact_move(of, i, way[i] * amount, s);
    }
}

/* What the integrator let slip: rates along what is held, and the gaps of resting stops. A pinned
 * coordinate cannot slip. */
static inline void wh_contact_tidy(const wh_hybrid *of, wh_contact_work *w, const wh_real *input,
                                   wh_contact_state *s) {
    bool slips = false;
    for (unsigned k = 0; k < of->forced; k++) {
        slips = slips || (of->contact[k].pin < 0 && wh_constrains(of, w, k));
    }
    if (!slips) {
        return;
    }
    wh_real accel[WH_COORDS];
    wh_real signal[2 * WH_CONTACTS_MAX];
    wh_real *rate = wh_contact_rates(of, s);
    wh_contact_look(of, w, s, input, accel, signal);
    for (unsigned k = 0; k < of->forced; k++) {
        if (of->contact[k].pin >= 0 || !wh_constrains(of, w, k)) {
            continue;
        }
        const wh_real *way = wh_law(of, w, k) + WH_LAW_ROWS + of->coordinates;
        wh_push(of, w, k, -wh_along(of, w, k, rate) / wh_along(of, w, k, way), rate);
        if (of->contact[k].kind == WH_STOP) {
            wh_contact_close(of, w, k, signal[2 * k], s);
        }
    }
}

/* Bring the modes to agree with the state: which way friction slides, which resting stops would have to
 * pull, which stuck coordinates (but those in `keep`, as bits) break loose. Each round lets at least one
 * go. */
static inline void wh_contact_settle(const wh_hybrid *of, wh_contact_work *w, unsigned keep,
                                     const wh_real *input, wh_contact_state *s) {
    wh_real accel[WH_COORDS];
    wh_real signal[2 * WH_CONTACTS_MAX];
    const wh_real *rate = wh_contact_rates(of, s);
    for (unsigned k = 0; k < of->forced; k++) {
        if (of->contact[k].kind == WH_FRICTION) {
            const wh_real v = rate[of->contact[k].pin];
            if (v != WH_R(0.0)) {
                w->mode[k] = v > WH_R(0.0) ? 1 : -1;
            }
        }
    }
    bool again = true;
    while (again && wh_contact_watched(of, w)) {
        again = false;
        wh_contact_look(of, w, s, input, accel, signal);
        for (unsigned k = 0; k < of->forced; k++) {
            if (of->contact[k].kind == WH_HOLD || !wh_constrains(of, w, k)) {
                continue;
            }
            const wh_real force = w->force[k];
            if (of->contact[k].kind == WH_STOP && force < WH_R(0.0)) {
                w->mode[k] = WH_FREE;
                again = true;
            } else if (of->contact[k].kind == WH_FRICTION && (keep >> k & 1U) == 0 &&
                       WH_ABS(force) > wh_law(of, w, k)[WH_LAW_FIRST]) {
                w->mode[k] = force > WH_R(0.0) ? -1 : 1;
                again = true;
            }
        }
    }
}

/* A stop is hit: restitution, or rest when the flight that follows would be too short. */
static inline wh_real wh_contact_hit(const wh_hybrid *of, wh_contact_work *w, unsigned k, wh_real h,
                                     bool rest, const wh_real *input, wh_contact_state *s) {
    wh_real accel[WH_COORDS];
    wh_real signal[2 * WH_CONTACTS_MAX];
    wh_real *rate = wh_contact_rates(of, s);
    wh_real impulse = WH_R(0.0);
    wh_contact_look(of, w, s, input, accel, signal);
    wh_real speed = wh_along(of, w, k, rate);
    if (speed < WH_R(0.0)) {
        const wh_real restitution = wh_law(of, w, k)[WH_LAW_FIRST];
        impulse = wh_contact_impulse(of, w, k, -restitution * speed, rate);
        speed = -restitution * speed;
        wh_contact_look(of, w, s, input, accel, signal);
    }
    const wh_real pressing = -(wh_along(of, w, k, accel) + wh_law(of, w, k)[WH_LAW_BIAS]);
    if (pressing > WH_R(0.0) && (rest || speed + speed <= pressing * (h * WH_REST_SHARE))) {
        impulse += wh_contact_impulse(of, w, k, WH_R(0.0), rate);
        wh_contact_close(of, w, k, signal[2 * k], s);
        w->mode[k] = WH_ACTIVE;
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
    if (c->sets == 0) {
        return;
    }
    wh_contact_point_of(of, s, &at);
    of->signals(of->model, at.phase, at.linear, at.rate, input, before);
    of->sets(of->model, at.phase, at.linear, at.rate, input, value);
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
    /* where the assignment leaves each crossing, if it moved it */
    wh_contact_point_of(of, s, &at);
    of->signals(of->model, at.phase, at.linear, at.rate, input, after);
    for (unsigned l = of->forced; l < of->contacts; l++) {
        if (after[2 * l] != before[2 * l] && after[2 * l] != WH_R(0.0)) {
            w->mode[l] = after[2 * l] > WH_R(0.0) ? 1 : -1;
        }
    }
}

/* The rate is zero but for what the location left: take that away and stick. */
WH_INLINE void wh_contact_stick(const wh_hybrid *of, wh_contact_work *w, unsigned k,
                                wh_real *rate) {
    const int pin = of->contact[k].pin;
    const wh_real *way = wh_law(of, w, k) + WH_LAW_ROWS + of->coordinates;
    wh_push(of, w, k, -rate[pin] / way[pin], rate);
    rate[pin] = WH_R(0.0);
    w->mode[k] = WH_STUCK;
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

/* Crossings that went against their direction, or left the value they started at, are on the other
 * side without an event. */
WH_INLINE void wh_contact_pass(const wh_hybrid *of, const wh_margins *m, wh_contact_work *w) {
    for (unsigned k = of->forced; k < of->contacts; k++) {
        const wh_real value = m->signal[2 * k];
        if (value != WH_R(0.0) && m->value[k] >= WH_R(0.0)) {
            w->mode[k] = value > WH_R(0.0) ? 1 : -1;
        }
    }
}

/* The accelerations at the state, with the contacts' forces, for records. accel[coordinates]. */
static inline void wh_contact_observe(const wh_hybrid *of, const wh_state *state, wh_real *accel) {
    wh_contact_work work;
    wh_contact_state now;
    wh_real signal[2 * WH_CONTACTS_MAX];
    wh_contact_copy(of, state->angle, state->real, state->carry, &now);
    wh_contact_modes(of, state, &work);
    if (work.mode[0] == WH_UNSET) {
        wh_contact_begin(of, &work, WH_R(0.0), state->input, &now);
    }
    wh_contact_look(of, &work, &now, state->input, accel, signal);
}

/* One step with its events. Returns as wh_step_second(). */
static inline wh_status wh_step_contact(const wh_hybrid *of, wh_real h, wh_state *state) {
    const unsigned reals = 2U * of->coordinates - of->angles;
    wh_contact_work work;
    wh_contact_state now;
    wh_contact_state next;
    wh_event log[WH_EVENT_LOG];
    unsigned logged = 0;
    wh_real left = h;
    unsigned round = 0;
    int fault = -1;

    wh_contact_copy(of, state->angle, state->real, state->carry, &now);
    wh_contact_modes(of, state, &work);
    if (work.mode[0] == WH_UNSET) {
        wh_contact_begin(of, &work, h, state->input, &now);
    }
    while (left > WH_R(0.0)) {
        wh_contact_point at;
        wh_margins margins;
        next = now;
        if (!wh_contact_try(of, &work, left, state->input, &next, &fault)) {
            return wh_refuse(state, (unsigned)fault);
        }
        wh_contact_tidy(of, &work, state->input, &next);
        wh_contact_point_of(of, &next, &at);
        wh_contact_margins(of, &work, &at, state->input, &margins);
        if (round == WH_EVENTS_MAX || wh_contact_happened(of, &margins) == 0) {
            wh_contact_pass(of, &margins, &work);
            now = next;
            break;
        }
        unsigned events;
        const wh_real span =
            left * wh_contact_locate(of, &work, &now, &next, left, state->input, &margins, &events);
        if (span > WH_R(0.0)) {
            if (!wh_contact_try(of, &work, span, state->input, &now, &fault)) {
                return wh_refuse(state, (unsigned)fault);
            }
            wh_contact_tidy(of, &work, state->input, &now);
            left -= span;
        }
        const bool last = ++round == WH_EVENTS_MAX;
        for (unsigned k = 0; k < of->contacts; k++) {
            if ((events >> k & 1U) != 0) {
                const wh_real impulse = wh_contact_take(of, &work, k, h, last, state->input, &now);
                if (logged < WH_EVENT_LOG) {
                    log[logged++] = (wh_event){(uint8_t)k, work.mode[k], h - left, impulse};
                }
            }
        }
        wh_contact_settle(of, &work, last ? events : 0, state->input, &now);
    }

    wh_contacts *memory = state->contacts;
    for (unsigned k = 0; k < of->contacts; k++) {
        memory->mode[k] = work.mode[k];
    }
    memory->events += logged;
    memory->overruns += round == WH_EVENTS_MAX;
    memory->logged = (uint8_t)logged;
    for (unsigned i = 0; i < logged; i++) {
        memory->log[i] = log[i];
    }
    for (unsigned i = 0; i < of->angles; i++) {
        state->angle[i] = now.angle[i];
    }
    for (unsigned i = 0; i < reals; i++) {
        state->real[i] = now.real[i];
    }
    for (unsigned i = 0; i < of->angles + reals && of->compensated; i++) {
        state->carry[i] = now.carry[i];
    }
    return WH_OK;
}

#endif

/* exact.c: see exact.h. */
#include "exact_law.h"

#define STEP_S 1e-3

/* Applies impulses. Afterwards contacts in `set` have the rate target[]. Contacts in `beside`, resting stops and
 * active holds have rate zero. A stop may open instead. Returns the stops that open. */
static unsigned strike(exact *e, unsigned set, unsigned beside, const double *target,
                       double *impulse) {
    exact_problem p = {set | beside | exact_those(e, WH_STOP, WH_ACTIVE) |
                           exact_those(e, WH_HOLD, WH_ACTIVE),
                       {0.0},
                       {0.0},
                       {0.0}};
    double before[HAND_CONTACTS];
    double lambda[HAND_CONTACTS];
    for (unsigned k = 0; k < exact_forced(); k++) {
        p.target[k] = exact_in(set, k) ? target[k] : 0.0;
        p.low[k] = exact_is(k, WH_STOP) ? 0.0 : -EXACT_ENDLESS;
        p.high[k] = EXACT_ENDLESS;
        before[k] = exact_along(k, e->v);
    }
    e->shared = e->shared || exact_repeat(e, p.members);
    const unsigned opens = exact_solve(e, &p, e->v, lambda);
    for (unsigned k = 0; k < exact_forced(); k++) {
        if (exact_in(p.members, k)) {
            /* This stop is neither pushed nor opened, so round-off decides whether it rests. */
            e->vague = e->vague || (!exact_in(set | beside | opens, k) && exact_is(k, WH_STOP) &&
                                    exact_size_of(lambda[k]) <= EXACT_ZERO);
            impulse[k] += lambda[k];
            e->impulse[k] += lambda[k];
            e->energy[k] += lambda[k] * 0.5 * (before[k] + exact_along(k, e->v));
        }
    }
    return opens;
}

/* True if a flight that starts with this speed is so short that the stop rests. */
static bool rests(exact *e, unsigned k, double speed, const double *a) {
    const int pressed = exact_sign(e, -exact_along(k, a));
    return pressed == 0
               ? exact_sign(e, speed) <= 0
               : pressed > 0 && exact_sign(e, 2.0 * speed + exact_along(k, a) * STEP_S / 8.0) <= 0;
}

static bool touched(exact *e, unsigned k) { return exact_sign(e, exact_gap(e, k)) <= 0; }

/* Returns the free stops that touch and close, as bits. */
static unsigned closing(exact *e) {
    unsigned bits = 0;
    for (unsigned k = 0; k < exact_forced(); k++) {
        const bool free = exact_is(k, WH_STOP) && e->mode[k] == WH_FREE;
        bits |= free && touched(e, k) && exact_sign(e, exact_along(k, e->v)) < 0 ? 1U << k : 0U;
    }
    return bits;
}

/* Hits the free stops in `found`, and all others that touch and close. Returns all stops that were hit. */
static unsigned hit(exact *e, unsigned found, double *impulse) {
    double a[2];
    double force[HAND_CONTACTS];
    double speed[HAND_CONTACTS] = {0.0};
    const unsigned resting = exact_those(e, WH_STOP, WH_ACTIVE);
    unsigned closes = 0;
    unsigned beside = 0;
    unsigned rest = 0;
    unsigned leaving = 0;
    unsigned gone = 0;
    exact_accelerate(e, a, force);
    /* a resting stop without a force becomes free */
    for (unsigned k = 0; k < exact_forced(); k++) {
        if (exact_in(resting, k) && hand_now.law[k].first > 0 && exact_sign(e, force[k]) <= 0) {
            e->mode[k] = WH_FREE;
        }
    }
    const unsigned hits = found | closing(e);
    for (unsigned k = 0; k < exact_forced(); k++) {
        const bool free = exact_is(k, WH_STOP) && e->mode[k] == WH_FREE;
        if (exact_in(hits, k)) {
            speed[k] = -(double)hand_now.law[k].first * exact_along(k, e->v);
            speed[k] = rests(e, k, speed[k], a) ? 0.0 : speed[k];
        } else if (free && touched(e, k) && exact_sign(e, exact_along(k, e->v)) == 0) {
            for (unsigned l = 0; l < exact_forced(); l++) {
                const bool moves = exact_in(hits, l) && exact_sign(e, exact_coupled(k, l)) != 0;
                beside |= moves && !(hand_now.law[k].first > 0) ? 1U << k : 0U;
            }
        }
    }
    for (unsigned k = 0; k < exact_forced(); k++) {
        closes |= exact_in(hits, k) && exact_sign(e, exact_along(k, e->v)) < 0 ? 1U << k : 0U;
    }
    if (closes != 0) {
        exact_give(e, strike(e, closes, beside, speed, impulse), WH_FREE);
    }
    exact_accelerate(e, a, force);
    e->next |= closing(e) & ~hits;
    for (unsigned k = 0; k < exact_forced(); k++) {
        const int leaves = exact_sign(e, exact_along(k, e->v));
        if (exact_in(hits, k) && leaves >= 0 && rests(e, k, exact_along(k, e->v), a)) {
            rest |= 1U << k;
            leaving |= leaves > 0 ? 1U << k : 0U;
        }
    }
    exact_give(e, rest, WH_ACTIVE);
    for (unsigned k = 0; k < exact_forced(); k++) {
        const bool open = exact_in(resting, k) && e->mode[k] == WH_FREE && !exact_in(e->next, k);
        gone |= open && rests(e, k, exact_along(k, e->v), a) ? 1U << k : 0U;
    }
    exact_give(e, gone, WH_ACTIVE);
    /* active stops and holds get rate zero together, without limits on their impulses */
    if ((gone | leaving) != 0) {
        exact_problem p = {exact_those(e, WH_STOP, WH_ACTIVE) | exact_those(e, WH_HOLD, WH_ACTIVE),
                           {0.0},
                           {0.0},
                           {0.0}};
        double lambda[HAND_CONTACTS] = {0.0};
        double before[HAND_CONTACTS];
        for (unsigned k = 0; k < exact_forced(); k++) {
            before[k] = exact_along(k, e->v);
        }
        e->vague = e->vague || !exact_reach(&p, p.members, e->v, lambda);
        for (unsigned k = 0; k < exact_forced(); k++) {
            if (exact_in(p.members, k)) {
                exact_push(k, lambda[k], e->v);
                e->impulse[k] += lambda[k];
                e->energy[k] += lambda[k] * 0.5 * before[k];
            }
        }
    }
    if ((rest | gone) != 0) {
        exact_put_back(e, 0, HAND_CONTACTS);
    }
    return hits;
}

/* Moves bodies back from the free stops that they passed, by the smallest move in the mass metric. Returns these stops
 * and the stops that push, as bits. */
static unsigned push_out(exact *e) {
    const double before = exact_stored(e);
    double way[2] = {0.0, 0.0};
    double lambda[HAND_CONTACTS];
    const unsigned stops = exact_those(e, WH_STOP, WH_FREE) | exact_those(e, WH_STOP, WH_ACTIVE);
    exact_problem p = {stops | exact_those(e, WH_HOLD, WH_ACTIVE), {0.0}, {0.0}, {0.0}};
    unsigned touched = 0;
    unsigned first = 0;
    for (unsigned k = exact_forced(); k-- > 0;) {
        p.target[k] = exact_in(stops, k) ? -exact_gap(e, k) : 0.0;
        p.low[k] = exact_in(stops, k) ? 0.0 : -EXACT_ENDLESS;
        p.high[k] = EXACT_ENDLESS;
        if (exact_in(stops, k) && e->mode[k] == WH_FREE && exact_sign(e, exact_gap(e, k)) < 0) {
            touched |= 1U << k;
            first = k;
        }
    }
    if (touched == 0) {
        return 0;
    }
    (void)exact_solve(e, &p, way, lambda);
    for (unsigned i = 0; i < hand_now.n; i++) {
        e->x[i] += way[i];
    }
    for (unsigned k = 0; k < exact_forced(); k++) {
        touched |= exact_in(stops, k) && exact_sign(e, lambda[k]) > 0 ? 1U << k : 0U;
    }
    e->energy[first] += exact_stored(e) - before;
    return touched;
}

void exact_squeeze(exact *e) {
    const double zero[HAND_CONTACTS] = {0.0};
    double impulse[HAND_CONTACTS] = {0.0};
    const unsigned touched = push_out(e);
    unsigned open = 0;
    if (touched == 0) {
        return;
    }
    for (unsigned k = 0; k < exact_forced(); k++) {
        const bool stop = exact_is(k, WH_STOP);
        open |= stop && exact_sign(e, exact_gap(e, k)) > 0 ? 1U << k : 0U;
    }
    exact_give(e, open, WH_FREE);
    exact_give(e, strike(e, touched & ~open, 0, zero, impulse), WH_FREE);
}

/* Sets the value that a crossing assigns. If that disturbs a resting contact, its body flies or is put back. A hold
 * captures its new value. */
static void assign(exact *e, unsigned k, double *impulse) {
    const exact was = *e;
    const double zero[HAND_CONTACTS] = {0.0};
    unsigned stops = 0;
    unsigned passed = 0;
    unsigned kept = 0;
    e->mode[k] = -e->mode[k];
    if (hand_now.places) {
        e->x[0] = (double)hand_now.place;
    } else {
        e->v[0] = -0.5 * e->v[0];
    }
    e->energy[k] += exact_kinetic(e) - exact_kinetic(&was) + exact_stored(e) - exact_stored(&was);
    const int side = exact_sign(e, exact_gap(e, k));
    if (hand_now.places && side != 0) { /* an assigned rate does not change the crossing's value */
        e->mode[k] = side;
    } else {
        e->stands |= 1U << k;
    }
    for (unsigned l = 0; l < exact_forced(); l++) {
        const bool same = exact_sign(e, exact_gap(e, l) - exact_gap(&was, l)) == 0 &&
                          exact_sign(e, exact_along(l, e->v) - exact_along(l, was.v)) == 0;
        stops |= exact_is(l, WH_STOP) && !same ? 1U << l : 0U;
        kept |= exact_is(l, WH_HOLD) && e->mode[l] == WH_ACTIVE && !same ? 1U << l : 0U;
    }
    for (unsigned l = 0; l < exact_forced(); l++) {
        passed |= exact_in(stops, l) && exact_sign(e, exact_gap(e, l)) < 0 ? 1U << l : 0U;
    }
    exact_give(e, stops, WH_FREE);
    if (passed != 0) {
        exact_give(e, passed, WH_ACTIVE);
        exact_put_back(e, 0, k);
        exact_give(e, passed, WH_FREE);
        for (unsigned l = exact_forced(); l < hand_now.system.contacts; l++) {
            const int there = exact_in(e->stands, l) ? exact_sign(e, exact_gap(e, l)) : 0;
            /* Putting bodies back has moved this crossing's value off zero. */
            e->mode[l] = there != 0 ? there : e->mode[l];
            e->stands &= there != 0 ? ~(1U << l) : ~0U;
        }
    }
    if (kept != 0) {
        exact_give(e, strike(e, kept, 0, zero, impulse), WH_FREE);
    }
}

/* If a crossing's value has just been zero, its mode becomes the sign to which the value moves. */
static void leave(exact *e) {
    for (unsigned k = exact_forced(); k < hand_now.system.contacts; k++) {
        const int side = exact_in(e->stands, k) ? exact_sign(e, exact_along(k, e->v)) : e->mode[k];
        e->vague = e->vague || (side == 0 && e->mode[k] != 0);
        e->mode[k] = side != 0 ? side : e->mode[k];
    }
    e->stands = 0;
}

static void note(exact *e, unsigned events, double at_s, const double *impulse) {
    for (unsigned k = 0; k < hand_now.system.contacts; k++) {
        if (exact_in(events, k) && e->logged < EXACT_LOG) {
            e->log[e->logged++] =
                (wh_event){(uint8_t)k, (int8_t)e->mode[k], (wh_real)at_s, (wh_real)impulse[k]};
        }
    }
}

static unsigned happen(exact *e, unsigned events, double *impulse) {
    const double zero[HAND_CONTACTS] = {0.0};
    const unsigned let_go = events & exact_those(e, WH_HOLD, WH_ACTIVE);
    const unsigned captured = events & exact_those(e, WH_HOLD, WH_FREE);
    const double came[2] = {e->v[0], e->v[1]};
    for (unsigned k = 0; k < HAND_CONTACTS; k++) {
        impulse[k] = 0.0;
    }
    const unsigned found = events & exact_those(e, WH_STOP, WH_FREE);
    if (found != 0) {
        events |= hit(e, found, impulse);
    }
    exact_give(e, let_go, WH_FREE);
    if (captured != 0) {
        const unsigned closed = closing(e);
        exact_give(e, captured, WH_ACTIVE);
        exact_give(e, strike(e, captured, 0, zero, impulse), WH_FREE);
        e->next |= closing(e) & ~closed;
    }
    for (unsigned k = exact_forced(); k < hand_now.system.contacts; k++) {
        if (exact_in(events, k)) {
            assign(e, k, impulse);
        }
    }
    for (unsigned k = 0; k < exact_forced(); k++) {
        if (exact_is(k, WH_FRICTION)) {
            const double v = exact_along(k, e->v);
            const bool zeroed = exact_in(events, k) && v == exact_along(k, came);
            const int way = exact_sign(e, v);
            e->vague = e->vague ||
                       (way == 0 && !zeroed && exact_sign(e, exact_along(k, came)) != 0) ||
                       (exact_in(events, k) && (events & (events - 1U)) != 0);
            e->mode[k] = zeroed ? WH_STUCK : way != 0 ? way : e->mode[k];
        }
    }
    exact_give_way(e);
    /* the rate of a fixed coordinate is exactly zero */
    for (unsigned k = 0; k < exact_forced(); k++) {
        const int pin = hand_now.contact[k].pin;
        if (pin >= 0 && exact_in(exact_holding(e), k) && exact_size_of(e->v[pin]) <= EXACT_ZERO) {
            e->v[pin] = 0.0;
        }
    }
    return events;
}

void exact_start(exact *e) {
    double impulse[HAND_CONTACTS];
    unsigned still = 0;
    unsigned moving = 0;
    *e = (exact){.pushed = (double)hand_pushed};
    for (unsigned i = 0; i < hand_now.n; i++) {
        e->x[i] = (double)hand_now.start[i];
        e->v[i] = (double)hand_now.start[hand_now.n + i];
    }
    (void)push_out(e);
    for (unsigned k = 0; k < hand_now.system.contacts; k++) {
        const int speed = exact_sign(e, exact_along(k, e->v));
        const bool on =
            exact_is(k, WH_STOP) ? touched(e, k) : exact_is(k, WH_HOLD) && e->pushed > 0.0;
        e->mode[k] = exact_is(k, WH_FRICTION) ? speed
                     : exact_is(k, WH_WHEN)   ? exact_sign(e, exact_gap(e, k))
                                              : WH_FREE;
        still |= on && speed == 0 ? 1U << k : 0U;
        moving |= on && (exact_is(k, WH_HOLD) ? speed != 0 : speed < 0) ? 1U << k : 0U;
    }
    const unsigned holds = still & exact_those(e, WH_HOLD, WH_FREE);
    exact_give(e, still & ~holds, WH_ACTIVE);
    if (still != 0) { /* contacts at rest are decided first, before any impact */
        (void)happen(e, holds, impulse);
        exact_put_back(e, exact_those(e, WH_FRICTION, WH_STUCK),
                       HAND_CONTACTS); /* sticking frictions fix no position here */
    }
    const unsigned events = happen(e, moving, impulse);
    note(e, events, 0.0, impulse);
}

/* Returns the first time within `left` at which g + r t + a t^2 / 2 falls from positive to negative; `left` if there is
 * none. */
static double falls(exact *e, double g, double r, double a, double left) {
    const double end = g + r * left + 0.5 * a * left * left;
    const int below = exact_sign(e, end);
    const int begins = exact_sign(e, g);
    e->vague = e->vague || (begins == 0 && exact_size_of(r) < EXACT_ZERO &&
                            exact_size_of(a) < EXACT_ZERO && exact_holding(e) != 0);
    e->vague = e->vague || (below == 0 && begins > 0); /* the event is exactly at the step's end */
    if (below >= 0) {
        if (a > 0.0 && r < 0.0 && -r / a < left) { /* a dip, which is over at the step's end */
            e->vague = e->vague || exact_sign(e, g - 0.5 * r * r / a) < 0;
        }
        return left;
    }
    if (begins == 0 && (r < 0.0 || (exact_sign(e, r) == 0 && a < 0.0))) {
        return 0.0;
    }
    if (begins < 0) { /* already beyond the stop: to leave it is no event */
        if (exact_sign(e, r) <= 0) {
            e->vague = e->vague || (exact_sign(e, r) == 0 && exact_sign(e, a) == 0);
            return exact_sign(e, r) < 0 || a < 0.0 ? 0.0 : left;
        }
        if (exact_sign(e, r + a * left) > 0) {
            return left;
        }
        if (exact_sign(e, g - 0.5 * r * r / a) <= 0) {
            return -r / a;
        }
    }
    if (exact_size_of(a) < 1e-9) {
        return -g / r;
    }
    if (begins == 0) { /* the value rises from zero and falls to zero again */
        return -2.0 * r / a;
    }
    const double root = (double)WH_SQRT((wh_real)(r * r - 2.0 * a * g));
    return r < 0.0 ? 2.0 * g / (root - r) : (-r - root) / a;
}

static double waits(exact *e, unsigned k, const double *a, double left) {
    const double r = exact_along(k, e->v);
    switch ((wh_contact_kind)hand_now.contact[k].kind) {
    case WH_STOP:
        return e->mode[k] == WH_ACTIVE ? left
                                       : falls(e, exact_gap(e, k), r, exact_along(k, a), left);
    case WH_HOLD: return (e->mode[k] == WH_ACTIVE) == (e->pushed > 0.0) ? left : 0.0;
    case WH_FRICTION: {
        const double rate = r * e->mode[k];
        return e->mode[k] == WH_STUCK ? left
                                      : falls(e, rate, exact_along(k, a) * e->mode[k], 0.0, left);
    }
    case WH_WHEN: {
        const double side = e->mode[k];
        return e->mode[k] == 0 || hand_now.contact[k].direction == e->mode[k]
                   ? left
                   : falls(e, exact_gap(e, k) * side, r * side, exact_along(k, a) * side, left);
    }
    case WH_CONTACT_KIND_COUNT: break;
    }
    return left;
}

static void move(exact *e, const double *a, const double *force, double span) {
    double way[2] = {0.0, 0.0};
    for (unsigned i = 0; i < hand_now.n; i++) {
        way[i] = span * (e->v[i] + 0.5 * span * a[i]);
        e->x[i] += way[i];
        e->v[i] += span * a[i];
    }
    for (unsigned k = 0; k < exact_forced(); k++) {
        e->energy[k] += force[k] * exact_along(k, way);
        e->impulse[k] += force[k] * span;
    }
}

void exact_step(exact *e) {
    double left = STEP_S;
    unsigned rounds = 0;
    if (hand_state.steps > 1) { /* the first step reports the contacts at the run's start */
        e->logged = 0;
    }
    while ((left > 0.0 || e->next != 0) && !e->vague) {
        unsigned events = e->next;
        e->next = 0;
        if (events == 0) {
            double a[2];
            double force[HAND_CONTACTS];
            double wait[HAND_CONTACTS];
            double span = left;
            exact_accelerate(e, a, force);
            for (unsigned k = 0; k < hand_now.system.contacts; k++) {
                wait[k] = waits(e, k, a, left);
                span = wait[k] < span ? wait[k] : span;
            }
            for (unsigned k = 0; k < hand_now.system.contacts && span < left; k++) {
                events |= exact_sign(e, (wait[k] - span) / STEP_S) == 0 ? 1U << k : 0U;
            }
            move(e, a, force, span);
            left = span < left ? left - span : 0.0;
        }
        if (events != 0) {
            double impulse[HAND_CONTACTS];
            const double at_s = STEP_S - left;
            for (unsigned k = 0; k < exact_forced(); k++) { /* a friction's rate is now zero */
                const int pin = hand_now.contact[k].pin;
                if (exact_in(events, k) && exact_is(k, WH_FRICTION)) {
                    e->v[pin] = 0.0;
                }
            }
            events = happen(e, events, impulse);
            note(e, events, at_s, impulse);
            leave(e);
            e->vague = e->vague || ++rounds >= WH_EVENTS_MAX - 1;
        }
    }
    for (unsigned k = exact_forced(); k < hand_now.system.contacts;
         k++) { /* the sides of the crossings at the step's end */
        const int side = exact_sign(e, exact_gap(e, k));
        e->mode[k] = side != 0 ? side : e->mode[k];
    }
}

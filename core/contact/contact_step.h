/* contact_step.h: one step of a scene with contacts. */
#ifndef WH_CONTACT_STEP_H
#define WH_CONTACT_STEP_H

#include "contact_begin.h"
#include "contact_dip.h"
#include "contact_rank.h"

WH_INLINE void wh_contact_modes(const wh_contact_system *of, const wh_state *state,
                                wh_contact_work *w) {
    WH_UNROLL
    for (unsigned k = 0; k < WH_CONTACTS_MAX; k++) {
        w->mode[k] = k < of->contacts ? state->contacts->mode[k] : (int8_t)0;
    }
}

/* Initializes the members of the working memory that every trial step needs. */
WH_INLINE void wh_contact_work_begin(const wh_contact_system *of, const wh_state *state,
                                     wh_contact_work *w) {
    wh_contact_modes(of, state, w);
    WH_UNROLL
    for (unsigned k = 0; k < WH_CONTACTS_MAX; k++) {
        if (k < of->forced ? wh_contact_of(of, k, WH_FRICTION) : k < of->contacts) {
            w->slack[k] = WH_R(0.0);
        }
    }
    for (unsigned k = 0; k < of->held; k++) {
        w->held[k] = state->held[k];
    }
    if (of->forced > 1) { /* a single contact needs no pivoting */
        w->capped = false;
    }
    w->undefined = -1;
#if WH_LEDGER
    w->books = NULL;
#endif
}

/* Initializes the members of the working memory that only events need. */
WH_INLINE void wh_contact_work_open(const wh_contact_system *of, wh_contact_work *w) {
    if (wh_contact_any_of(of, WH_FRICTION)) {
        w->turned = 0;
    }
    if (of->forced > 1) {
        w->hit_next = 0;
    }
    if (of->contacts > of->forced) { /* only crossings assign */
        w->moved = 0;
        w->mover = 0;
        w->stands = 0;
        w->located = false;
    }
    w->fault = -1;
}

/* Computes accel[coordinates] at the state, including contact forces, for records. */
static inline void wh_contact_observe(const wh_contact_system *of, const wh_state *state,
                                      wh_real *accel) {
    wh_contact_work work;
    wh_contact_state now;
    wh_real signal[2 * WH_CONTACTS_MAX];
    wh_contact_work_begin(of, state, &work);
    wh_contact_work_open(of, &work);
    wh_contact_copy(of, state->angle, state->real, state->carry, &now);
    if (work.mode[0] == WH_UNSET) {
        wh_real impulse[WH_CONTACTS_MAX];
        unsigned hit;
        (void)wh_contact_begin(of, &work, WH_R(0.0), state->input, &now, &hit, impulse);
    }
    wh_contact_look(of, &work, &now, state->input, accel, signal);
}

/* Steps `s` by h in fixed modes. Returns false if component *fault left its bounds; `s` is then unchanged. */
static inline bool wh_contact_try(const wh_contact_system *of, wh_contact_work *w, wh_real h,
                                  wh_real *input, wh_contact_state *s, int *fault) {
    of = WH_CONTACTS_HERE(of);
    const wh_contact_model model = {of, w};
    wh_state view = {0, s->angle, s->real, s->carry, input, NULL, NULL, NULL, -1};
    wh_books_begin(of, w, s->angle, h);
    const wh_two_part span = {h, WH_R(0.0)};
    const wh_status status = wh_step_second(&model, wh_contact_accel, of->method, of->compensated,
                                            of->angles, of->coordinates, span, &view);
    wh_books_end(of, w);
    *fault = view.fault;
    return status == WH_OK;
}

/* The interpreter defines this macro to record the pieces of a step between two events. */
#ifndef WH_PIECE_SEEN
#define WH_PIECE_SEEN(of, w, span, from, to) ((void)0)
#endif

/* Advances a->next by `left` seconds, as a trial. If holds can slip, a->now must be the state before. */
WH_INLINE void wh_contact_attempt_make(const wh_contact_system *of, wh_contact_work *w,
                                       wh_real left, wh_real *input, wh_contact_attempt *a) {
    wh_contact_point at;
    a->leaving = 0;
    a->sound = wh_contact_try(of, w, left, input, &a->next, &a->fault);
    if (!a->sound) {
        return;
    }
    wh_contact_stabilise(of, w, left, input, &a->now, &a->next);
    if (wh_contact_any_of(of, WH_STOP)) {
        w->inside = ~0U;
    }
    wh_contact_point_of(of, &a->next, &at);
    wh_contact_margins(of, w, &at, input, &a->margins);
    WH_UNROLL
    for (unsigned k = 0; k < of->forced; k++) {
        const bool free = wh_contact_of(of, k, WH_STOP) && w->mode[k] == WH_FREE;
        const wh_real speed = a->margins.signal[2 * k + 1];
        if (free && speed > WH_R(0.0) && a->margins.signal[2 * k] < left * speed) {
            a->leaving |= 1U << k;
        }
    }
}

/* Sets work->slack of each active hold. If the condition was zero within round-off when the trial step began, the slack
 * is this round-off, otherwise 0. The hold stays active until its condition is below -slack. */
WH_APART void wh_contact_attempt_frozen(const wh_contact_system *of, wh_contact_work *w,
                                        const wh_real *input, wh_contact_attempt *a) {
    wh_contact_point at;
    wh_real signal[2 * WH_CONTACTS_MAX];
    wh_contact_point_of(of, &a->now, &at);
    wh_contact_signals(of, at.phase, at.linear, at.rate, input, signal);
    for (unsigned k = 0; k < of->forced; k++) {
        if (wh_contact_of(of, k, WH_HOLD)) {
            const bool held = w->mode[k] == WH_ACTIVE;
            const wh_real limit = wh_contact_at_limit(of, w, k, input, &a->now, signal[2 * k]);
            w->slack[k] = held ? WH_ABS(limit) : WH_R(0.0);
            a->margins.value[k] += w->slack[k];
        }
    }
}

WH_INLINE bool wh_contact_attempt_calm(const wh_contact_system *of, const wh_contact_work *w,
                                       const wh_contact_attempt *a) {
    return wh_contact_calm(of, &a->margins) && (of->held == 0 || w->undefined < 0);
}

/* After a failed trial step of length h: extrapolates `from` to find a friction or hold that becomes undefined. */
WH_APART void wh_contact_blame(const wh_contact_system *of, wh_contact_work *w, wh_real h,
                               const wh_real *input, wh_contact_state *from) {
    wh_contact_point at;
    for (unsigned part = 0; part <= 2; part++) {
        wh_contact_point_ahead(of, from, WH_R(0.5) * (wh_real)part * h, NULL, &at);
        of->forces(of->model, at.phase, at.linear, at.rate, input, w->law);
        wh_contact_expect_laws(of, w);
    }
}

WH_INLINE wh_status wh_contact_refuse(const wh_contact_work *w, int fault, wh_state *state) {
    state->fault = w->undefined >= 0 ? w->undefined : fault;
    return w->undefined >= 0 ? WH_E_UNDEFINED : WH_E_DIVERGED;
}

typedef struct wh_contact_log {
    wh_event event[WH_EVENT_LOG];
    unsigned count;
} wh_contact_log;

WH_INLINE void wh_contact_note(const wh_contact_system *of, const wh_contact_work *w,
                               unsigned events, wh_real at_s, const wh_real *impulse,
                               wh_contact_log *log) {
    for (unsigned k = 0; k < of->contacts; k++) {
        if ((events >> k & 1U) != 0 && log->count < WH_EVENT_LOG) {
            log->event[log->count++] = (wh_event){(uint8_t)k, w->mode[k], at_s, impulse[k]};
        }
    }
}

/* Resolves and logs one moment, at_s after the step's start. */
WH_INLINE void wh_contact_happen(const wh_contact_system *of, wh_contact_work *w,
                                 const wh_contact_moment *m, wh_real at_s, const wh_real *input,
                                 wh_contact_state *now, wh_contact_log *log) {
    wh_real impulse[WH_CONTACTS_MAX];
    const unsigned events = wh_contact_resolve(of, w, m, input, now, impulse);
    wh_contact_note(of, w, events, at_s, impulse, log);
    if (of->contacts > of->forced && w->stands != 0) {
        wh_contact_turn_back(of, w, m->h, input, now);
    }
}

/* Sets the modes at the start of a run and logs the impacts there. Returns as wh_contact_begin() does. */
static inline unsigned wh_contact_start(const wh_contact_system *of, wh_contact_work *w, wh_real h,
                                        const wh_real *input, wh_contact_state *now,
                                        wh_contact_log *log) {
    wh_real impulse[WH_CONTACTS_MAX] = {WH_R(0.0)};
    unsigned hit;
    const unsigned rounds = wh_contact_begin(of, w, h, input, now, &hit, impulse);
    wh_contact_note(of, w, hit, WH_R(0.0), impulse, log);
    return rounds;
}

/* Returns, as bits, the stops in work->hit_next that are still free, and clears work->hit_next. */
WH_INLINE unsigned wh_contact_next(const wh_contact_system *of, wh_contact_work *w) {
    unsigned bits = 0;
    if (of->forced <= 1 || w->hit_next == 0) {
        return 0;
    }
    for (unsigned k = 0; k < of->forced; k++) {
        bits |= w->mode[k] == WH_FREE ? w->hit_next & 1U << k : 0U;
    }
    w->hit_next = 0;
    return bits;
}

WH_INLINE void wh_contact_commit(const wh_contact_system *of, const wh_contact_work *w,
                                 const wh_contact_state *now, wh_state *state) {
    const unsigned reals = 2U * of->coordinates - of->angles;
    for (unsigned k = 0; k < of->held; k++) {
        state->held[k] = w->held[k];
    }
    WH_UNROLL
    for (unsigned i = 0; i < of->angles; i++) {
        state->angle[i] = now->angle[i];
    }
    WH_UNROLL
    for (unsigned i = 0; i < reals; i++) {
        state->real[i] = now->real[i];
    }
    for (unsigned i = 0; i < of->angles + reals && of->compensated; i++) {
        state->carry[i] = now->carry[i];
    }
}

/* Copies the modes of the contacts from number `first` on. */
WH_INLINE void wh_contact_commit_modes(const wh_contact_system *of, const wh_contact_work *w,
                                       unsigned first, wh_state *state) {
    WH_UNROLL
    for (unsigned k = first; k < of->contacts; k++) {
        state->contacts->mode[k] = w->mode[k];
    }
}

WH_INLINE void wh_contact_commit_events(const wh_contact_log *log, bool overran,
                                        wh_contacts *memory) {
    memory->events += log->count;
    memory->overruns += overran;
    memory->logged = (uint8_t)log->count;
    for (unsigned i = 0; i < log->count; i++) {
        memory->log[i] = log->event[i]; // cppcheck-suppress uninitvar ; `count` of them are filled
    }
}

/* Accepts a trial step of length `span`. Returns the hold that lost rank in it, or of->contacts. */
WH_INLINE unsigned wh_contact_accept(const wh_contact_system *of, wh_contact_work *w, wh_real span,
                                     wh_contact_state *from, wh_contact_state *to,
                                     const wh_real *input) {
    wh_books_accept(of, w);
    wh_contact_keep(of, w, from, to);
    return wh_contact_flat(of, w, span, from, to, input);
}

/* The progress of one step, which consists of trial steps. */
typedef struct wh_contact_progress {
    wh_contact_attempt *attempt;
    const wh_contact_state *end; /* state at the end of the step, when done */
    wh_real *input;
    wh_contact_log *log;
    wh_real h;
    wh_real left;    /* time from attempt->now to the step's end, s */
    wh_real reach;   /* length of the next trial step, s */
    unsigned round;  /* number of moments so far, at most WH_EVENTS_MAX */
    unsigned events; /* events at attempt->now, as bits */
    unsigned flat;   /* the hold that lost rank; of->contacts: none */
    bool calm;       /* the step ended without an event, and all values that it used were finite */
    bool diverged;
    bool overran; /* there were too many events */
    bool done;
} wh_contact_progress;

static inline void wh_contact_progress_begin(const wh_contact_system *of, wh_contact_work *w,
                                             const wh_state *state, wh_contact_progress *p) {
    wh_contact_state *now = &p->attempt->now;
    p->end = now;
    p->log->count = 0;
    p->left = p->h;
    p->reach = p->h;
    p->round = 0;
    p->flat = of->contacts;
    p->calm = false;
    p->diverged = false;
    p->overran = false;
    p->done = false;
    wh_contact_work_open(of, w);
    wh_contact_copy(of, state->angle, state->real, state->carry, now);
    if (p->attempt->made) {
        return;
    }
    if (w->mode[0] == WH_UNSET) {
        p->round = wh_contact_start(of, w, p->h, p->input, now, p->log);
        p->done = w->undefined >= 0;
    } else {
        wh_contact_follow(of, w, p->h, p->input, now);
    }
    if (!p->done) {
        wh_contact_stand(of, w, p->input, now);
    }
}

/* Ends the step after a trial step of length `span` left its bounds. Looks for a contact that became undefined. */
static inline void wh_contact_progress_diverged(const wh_contact_system *of, wh_contact_work *w,
                                                wh_real span, wh_contact_state *from,
                                                wh_contact_progress *p) {
    wh_contact_blame(of, w, span, p->input, from);
    p->diverged = true;
    p->done = true;
}

/* Accepts the trial step. */
static inline void wh_contact_progress_pass(const wh_contact_system *of, wh_contact_work *w,
                                            wh_contact_progress *p) {
    wh_contact_attempt *a = p->attempt;
    if (!p->calm) {
        wh_contact_find_undefined(of, w, &a->margins);
    }
    wh_contact_pass(of, &a->margins, w);
    p->flat = wh_contact_accept(of, w, p->reach, &a->now, &a->next, p->input);
    if (p->calm) {
        WH_PIECE_SEEN(of, w, p->reach, &a->now, &a->next);
    }
    if (p->calm && p->reach < p->left && p->flat == of->contacts) {
        wh_contact_copy(of, a->next.angle, a->next.real, a->next.carry, &a->now);
        p->left -= p->reach;
        p->reach = p->left;
        return;
    }
    if (p->round == WH_EVENTS_MAX) {
        p->overran = p->overran || !p->calm;
        wh_contact_overrun(of, w, p->h, p->input, &a->next);
        p->calm = false; /* wh_contact_progress_end() then refuses undefined values */
    }
    p->end = &a->next;
    p->done = true;
}

/* Replaces the trial step by one that ends at its first events. */
static inline void wh_contact_progress_cut(const wh_contact_system *of, wh_contact_work *w,
                                           wh_contact_progress *p) {
    wh_contact_attempt *a = p->attempt;
    unsigned events;
    const wh_real span = p->reach * wh_contact_locate(of, w, &a->now, &a->next, p->reach, p->input,
                                                      &a->margins, &events);
    p->events = events;
    w->undefined = -1; /* values past the event do not count */
    if (span > WH_R(0.0)) {
        wh_contact_copy(of, a->now.angle, a->now.real, a->now.carry, &a->next);
        if (!wh_contact_try(of, w, span, p->input, &a->now, &a->fault)) {
            wh_contact_progress_diverged(of, w, span, &a->next, p);
            return;
        }
        wh_contact_stabilise(of, w, span, p->input, &a->next, &a->now);
        p->flat = wh_contact_accept(of, w, span, &a->next, &a->now, p->input);
        WH_PIECE_SEEN(of, w, span, &a->next, &a->now);
        p->left -= span;
        w->located = true;
    }
    p->reach = p->left;
}

/* Makes a trial step of length p->reach, and accepts or shortens it. */
static inline void wh_contact_progress_try(const wh_contact_system *of, wh_contact_work *w,
                                           wh_contact_progress *p) {
    wh_contact_attempt *a = p->attempt;
    if (!a->made) {
        wh_contact_copy(of, a->now.angle, a->now.real, a->now.carry, &a->next);
        wh_contact_attempt_make(of, w, p->reach, p->input, a);
    }
    a->made = false;
    if (!a->sound) {
        p->flat = wh_contact_flat(of, w, WH_R(4.0) * p->reach, &a->now, NULL, p->input);
        if (p->flat == of->contacts) {
            wh_contact_progress_diverged(of, w, p->reach, &a->now, p);
        }
        return;
    }
    wh_contact_attempt_dipped(of, w, p->reach, p->input, a);
    if (a->dips != 0 && p->round + 2U < WH_EVENTS_MAX) {
        const wh_real share = wh_contact_dip(of, a, p->input);
        if (share < WH_R(1.0)) {
            p->reach *= share;
            p->round++;
            return;
        }
    }
    if (wh_contact_any_of(of, WH_HOLD) && !wh_contact_calm(of, &a->margins)) {
        wh_contact_attempt_frozen(of, w, p->input, a);
    }
    p->calm = wh_contact_attempt_calm(of, w, a);
    if (p->calm || p->round == WH_EVENTS_MAX || wh_contact_happened(of, &a->margins) == 0) {
        wh_contact_progress_pass(of, w, p);
    } else {
        wh_contact_progress_cut(of, w, p);
    }
}

/* Resolves the events at attempt->now. A stop that comes to rest in round WH_EVENTS_MAX counts as an overrun. */
static inline void wh_contact_progress_happen(const wh_contact_system *of, wh_contact_work *w,
                                              wh_contact_progress *p) {
    const bool last = ++p->round == WH_EVENTS_MAX;
    const wh_contact_moment moment = {p->events, 0, p->h, last};
    const unsigned rested = last ? wh_contact_which(of, w, WH_STOP, true) : 0U;
    wh_contact_happen(of, w, &moment, p->h - p->left, p->input, &p->attempt->now, p->log);
    if (last) {
        p->overran = (wh_contact_which(of, w, WH_STOP, true) & ~rested) != 0;
    }
    p->done = w->undefined >= 0 || w->fault >= 0;
}

/* Commits the step, or refuses it. Returns as wh_step_contact() does. */
static inline wh_status wh_contact_progress_end(const wh_contact_system *of, wh_contact_work *w,
                                                wh_contact_progress *p, wh_state *state) {
    if (p->flat < of->contacts) {
        state->fault = (int)p->flat;
        return WH_E_SINGULAR;
    }
    if (p->diverged || (!p->calm && (w->fault >= 0 || w->undefined >= 0))) {
        return wh_contact_refuse(w, p->diverged ? p->attempt->fault : w->fault, state);
    }
    wh_books_commit(of, w, state);
    wh_contact_commit(of, w, p->end, state);
    wh_contact_commit_modes(of, w, 0, state);
    p->overran = wh_contact_next(of, w) != 0 || p->overran || (of->forced > 1 && w->capped);
    wh_contact_commit_events(p->log, p->overran, state->contacts);
    return WH_OK;
}

/* Does a step with events. If a->made, `a` has its first trial step already. Returns as wh_step_contact() does. */
WH_APART wh_status wh_contact_eventful(const wh_contact_system *of, wh_contact_work *w, wh_real h,
                                       wh_contact_attempt *a, wh_state *state) {
    wh_contact_log log;
    wh_contact_progress p;
    p.log = &log;
    p.attempt = a;
    p.input = state->input;
    p.h = h;
    wh_contact_progress_begin(of, w, state, &p);
    while (!p.done) {
        p.events = p.round < WH_EVENTS_MAX ? wh_contact_next(of, w) : 0;
        if (p.events == 0 && p.left > WH_R(0.0)) {
            wh_contact_progress_try(of, w, &p);
        }
        p.done = p.done || p.flat < of->contacts;
        if (!p.done && p.events != 0) {
            wh_contact_progress_happen(of, w, &p);
        }
        const bool more = of->forced > 1 && w->hit_next != 0 && p.round < WH_EVENTS_MAX;
        p.done = p.done || !(p.left > WH_R(0.0) || more);
    }
    return wh_contact_progress_end(of, w, &p, state);
}

/* Does one step with its events. Returns WH_E_UNDEFINED or WH_E_SINGULAR with the contact in state->fault. The other
 * results are those of wh_step_second(). */
static inline wh_status wh_step_contact(const wh_contact_system *of, wh_real h, wh_state *state) {
    wh_contact_work work;
    wh_contact_attempt a;
    bool made = false;
    wh_contact_work_begin(of, state, &work);
#if WH_LEDGER
    wh_ledger_work books;
    if (of->ledger != NULL) {
        work.books = &books;
        wh_ledger_open(of->ledger, state, &books);
    }
#endif
    if (work.mode[0] != WH_UNSET && !wh_contact_follows(of, &work)) {
        wh_contact_copy(of, state->angle, state->real, state->carry, &a.next);
        wh_contact_stand(of, &work, state->input, &a.next);
        if (of->held > 0) {
            wh_contact_copy(of, state->angle, state->real, state->carry, &a.now);
        }
        wh_contact_attempt_make(of, &work, h, state->input, &a);
        const bool capped = of->forced > 1 && work.capped;
        if (a.sound && a.leaving == 0 && !capped &&
            wh_contact_attempt_calm(of, &work, &a)) { /* most steps end here */
            wh_contact_pass(of, &a.margins, &work);
            const unsigned flat = wh_contact_accept(of, &work, h, &a.now, &a.next, state->input);
            if (flat < of->contacts) {
                state->fault = (int)flat;
                return WH_E_SINGULAR;
            }
            wh_books_commit(of, &work, state);
            wh_contact_commit(of, &work, &a.next, state);
            wh_contact_commit_modes(of, &work, of->forced, state);
            state->contacts->logged = 0;
            return WH_OK;
        }
        made = true;
    }
    a.made = made;
    return wh_contact_eventful(of, &work, h, &a, state);
}

#endif

/* contact_project.h: projection of positions and rates onto the constraints of resting stops and holds. */
#ifndef WH_CONTACT_PROJECT_H
#define WH_CONTACT_PROJECT_H

#include "contact_forces.h"

WH_INLINE void wh_contact_move(const wh_contact_system *of, unsigned i, wh_real by,
                               wh_contact_state *s) {
    if (i < of->angles) {
        wh_real none = WH_R(0.0);
        const wh_real steps = by * WH_PHASE_PER_RAD;
        if (wh_believable(steps, WH_PHASE_STEP_MAX)) {
            wh_angle_move(&s->angle[i], steps, false, &none);
        }
    } else {
        s->real[i - of->angles] += by;
    }
}

/* Adds the product a b to *sum, and its round-off to *rest, because the round-off would add up over the steps. */
WH_INLINE void wh_contact_add_product(wh_real a, wh_real b, wh_real *sum, wh_real *rest) {
    *rest += wh_product_rest(a, b);
    *sum += a * b;
}

/* Returns the displacement of a straight hold k, rad or m: its constant J_k times the change of the coordinates. */
static inline wh_real wh_contact_moved(const wh_contact_system *of, const wh_contact_work *w,
                                       unsigned k, const wh_contact_state *from,
                                       const wh_contact_state *to) {
    const wh_real *row = wh_contact_law(of, w, k) + WH_LAW_ROWS;
    wh_real turns = WH_R(0.0); /* contribution of the angles, in phase units */
    wh_real ways = WH_R(0.0);
    wh_real rests[2] = {WH_R(0.0), WH_R(0.0)};
    for (unsigned i = 0; i < of->angles; i++) {
#if WH_DOUBLE
        wh_contact_add_product(row[i], to->angle[i] - from->angle[i], &turns, &rests[0]);
#else
        const uint64_t turned = (uint64_t)to->angle[i] - (uint64_t)from->angle[i];
        /* the change is less than half a turn; the next lines split it into two numbers that are exact in float */
        const int32_t way = (int32_t)(uint32_t)turned;
        wh_contact_add_product(row[i], (wh_real)(way >> 8) * WH_R(256.0), &turns, &rests[0]);
        rests[0] += row[i] * (wh_real)(way & 255);
#endif
    }
    for (unsigned i = of->angles; i < of->coordinates; i++) {
        const unsigned l = i - of->angles;
        wh_contact_add_product(row[i], to->real[l] - from->real[l], &ways, &rests[1]);
    }
    return (turns + rests[0]) / WH_PHASE_PER_RAD + (ways + rests[1]);
}

/* True if contact k is an active hold that can slip. A hold with a pin cannot. */
WH_INLINE bool wh_contact_slips(const wh_contact_system *of, const wh_contact_work *w, unsigned k) {
    return of->held > 0 && wh_contact_of(of, k, WH_HOLD) && !wh_contact_pinned(of, k) &&
           w->mode[k] == WH_ACTIVE;
}

/* Returns the displacement of contact k from its constraint, at state `s`. `from` is the start of the trial step that
 * ends at `s`, or NULL. */
WH_INLINE wh_real wh_contact_drift(const wh_contact_system *of, const wh_contact_work *w,
                                   unsigned k, const wh_real *signal, const wh_contact_state *from,
                                   const wh_contact_state *s) {
    if (wh_contact_of(of, k, WH_STOP)) {
        return signal[2 * k];
    }
    if (!wh_contact_slips(of, w, k)) {
        return WH_R(0.0);
    }
    const wh_real held = w->held[of->contact[k].first_set];
    if (of->contact[k].direction <= 0) {
        return wh_contact_law(of, w, k)[WH_LAW_FIRST] - held;
    }
    return from != NULL ? held + wh_contact_moved(of, w, k, from, s) : WH_R(0.0);
}

/* Stores the value that hold k keeps. work->law must be computed at the present position. */
WH_INLINE void wh_contact_capture(const wh_contact_system *of, wh_contact_work *w, unsigned k) {
    if (wh_contact_slips(of, w, k)) {
        w->held[of->contact[k].first_set] =
            of->contact[k].direction <= 0 ? wh_contact_law(of, w, k)[WH_LAW_FIRST] : WH_R(0.0);
    }
}

/* Returns, as bits, stuck frictions beyond their limit, which are about to slide. work->force must be up to date. */
WH_INLINE unsigned wh_contact_breaking(const wh_contact_system *of, const wh_contact_work *w) {
    unsigned bits = 0;
    for (unsigned k = 0; k < of->forced; k++) {
        const bool stuck = wh_contact_of(of, k, WH_FRICTION) && w->mode[k] == WH_STUCK;
        bits |= stuck && wh_contact_exceeds(of, w, k, w->force[k]) ? 1U << k : 0U;
    }
    return bits;
}

/* Lists in member[] the contacts that keep J_k q' at zero, except for those in `but` (bits). Returns their number. */
WH_INLINE unsigned wh_contact_members(const wh_contact_system *of, const wh_contact_work *w,
                                      unsigned but, uint8_t *member) {
    unsigned count = 0;
    for (unsigned k = 0; k < of->forced; k++) {
        if ((but >> k & 1U) == 0 && wh_contact_constrains(of, w, k)) {
            member[count++] = (uint8_t)k;
        }
    }
    return count;
}

/* The options of a projection of resting stops and holds. */
typedef struct wh_contact_place {
    const wh_contact_state *from; /* start of the trial step, or NULL */
    wh_real h;                    /* length of the trial step, s */
    unsigned but;                 /* bits: contacts to leave out */
    /* The contact whose entry in the ledger gets the change of energy; WH_CONTACTS_MAX: the first displaced contact. */
    unsigned mover;
} wh_contact_place;

#define WH_CONTACT_HERE ((wh_contact_place){NULL, WH_R(0.0), 0, WH_CONTACTS_MAX})

/* Projects positions onto the constraints. Returns true if the displacement was so large that a second projection is
 * needed. On entry, work->law and signal[] must belong to `s`. */
static inline bool wh_contact_project_places(const wh_contact_system *of, wh_contact_work *w,
                                             const wh_contact_place *spot, const wh_real *signal,
                                             const wh_real *input, wh_contact_state *s) {
    uint8_t member[WH_CONTACTS_MAX] = {0};
    wh_real off[WH_CONTACTS_MAX] = {WH_R(0.0)};
    wh_real wanted[WH_CONTACTS_MAX];
    wh_real lambda[WH_CONTACTS_MAX];
    wh_real way[WH_COORDS] = {0};
    wh_real moved[WH_COORDS] = {WH_R(0.0)}; /* moves of the pinned coordinates */
    const unsigned count = wh_contact_members(of, w, spot->but, member);
    unsigned mover = spot->mover;
    bool together = false;
    bool coarse = false;
    for (unsigned i = 0; i < count; i++) {
        const unsigned k = member[i];
        off[i] = wh_contact_drift(of, w, k, signal, spot->from, s);
        if (!wh_finite(off[i])) {
            wh_contact_expect(w, k, off[i]);
            off[i] = WH_R(0.0);
        }
        mover = mover == WH_CONTACTS_MAX && off[i] != WH_R(0.0) ? k : mover;
    }
    if (mover == WH_CONTACTS_MAX) {
        return false;
    }
    (void)input; /* only the ledger reads `input` */
    wh_books_look(of, w, s, input);
    for (unsigned i = 0; i < count; i++) {
        const int pin = wh_contact_pin(of, member[i]);
        if (off[i] != WH_R(0.0) && pin >= 0) {
            const wh_real entry = wh_contact_law(of, w, member[i])[WH_LAW_ROWS + pin];
            const wh_real rest = off[i] + entry * moved[pin];
            if (moved[pin] == WH_R(0.0) || rest < WH_R(0.0)) {
                moved[pin] -= rest / entry;
                wh_contact_move(of, (unsigned)pin, -rest / entry, s);
            }
        }
    }
    for (unsigned i = 0; i < count; i++) {
        const bool pinned = wh_contact_pinned(of, member[i]);
        wanted[i] = pinned ? WH_R(0.0) : -(off[i] + wh_jacobian_times(of, w, member[i], moved));
        together = together || wanted[i] != WH_R(0.0);
    }
    if (together) {
        (void)wh_delassus_solve(of, w, member, count, NULL, wanted, lambda);
        for (unsigned i = 0; i < count; i++) {
            wh_contact_apply(of, w, member[i], lambda[i], way);
        }
        for (unsigned i = 0; i < count; i++) {
            const int pin = wh_contact_pin(of, member[i]);
            const wh_real *row = wh_contact_law(of, w, member[i]) + WH_LAW_ROWS;
            const wh_real *rate = wh_contact_rates(of, s);
            wh_real travel = WH_R(0.0);
            for (unsigned c = 0; c < of->coordinates; c++) {
                travel += WH_ABS(row[c] * rate[c]);
            }
            coarse = coarse || WH_ABS(wanted[i]) > WH_SLIP_COARSE * spot->h * travel;
            if (pin >= 0) {
                way[pin] = WH_R(0.0);
            }
        }
        for (unsigned i = 0; i < of->coordinates; i++) {
            wh_contact_move(of, i, way[i], s);
        }
    }
    wh_books_moved(of, w, s, input, mover);
    return coarse;
}

/* Makes the rates along the active contacts zero, except contacts in `but` (bits). w->law must be up to date. */
static inline void wh_contact_project_rates(const wh_contact_system *of, const wh_contact_work *w,
                                            unsigned but, bool booked, wh_real *rate) {
    uint8_t member[WH_CONTACTS_MAX] = {0};
    wh_real wanted[WH_CONTACTS_MAX] = {WH_R(0.0)};
    wh_real lambda[WH_CONTACTS_MAX];
    const unsigned count = wh_contact_members(of, w, but, member);
    for (unsigned i = 0; i < count; i++) {
        wanted[i] = -wh_jacobian_times(of, w, member[i], rate);
    }
    (void)wh_delassus_solve(of, w, member, count, NULL, wanted, lambda);
    for (unsigned i = 0; i < count; i++) {
        wh_contact_apply(of, w, member[i], lambda[i], rate);
    }
    for (unsigned i = 0; i < count; i++) {
        const int pin = wh_contact_pin(of, member[i]);
        if (pin >= 0) {
            rate[pin] = WH_R(0.0);
        }
        if (booked) {
            wh_books_impulse(of, w, member[i], lambda[i], -wanted[i],
                             wh_jacobian_times(of, w, member[i], rate), rate);
        }
    }
}

WH_INLINE unsigned wh_contact_stuck(const wh_contact_system *of, const wh_contact_work *w) {
    unsigned bits = 0;
    for (unsigned k = 0; k < of->forced; k++) {
        bits |= wh_contact_of(of, k, WH_FRICTION) && w->mode[k] == WH_STUCK ? 1U << k : 0U;
    }
    return bits;
}

/* Returns the scale of the round-off of contact k's expression. Each angle counts as 1 rad. */
static inline wh_real wh_contact_extent(const wh_contact_system *of, const wh_contact_work *w,
                                        unsigned k, const wh_contact_state *s) {
    const wh_real *row = wh_contact_law(of, w, k) + WH_LAW_ROWS;
    wh_real size = WH_R(0.0);
    for (unsigned i = 0; i < of->coordinates; i++) {
        size += WH_ABS(row[i] * (i < of->angles ? WH_R(1.0) : s->real[i - of->angles]));
    }
    return size;
}

/* A body is beyond a stop if the gap is below minus this fraction of wh_contact_extent(). It has left the stop if the
 * gap is above this fraction. */
#define WH_CONTACT_FAR (WH_DOUBLE ? WH_R(1e-9) : WH_R(1e-5))
WH_INLINE bool wh_contact_far(const wh_contact_system *of, const wh_contact_work *w, unsigned k,
                              const wh_real *signal, const wh_contact_state *s) {
    return signal[2 * k] < -WH_CONTACT_FAR * wh_contact_extent(of, w, k, s);
}
WH_INLINE bool wh_contact_open(const wh_contact_system *of, const wh_contact_work *w, unsigned k,
                               const wh_real *signal, const wh_contact_state *s) {
    return signal[2 * k] > WH_CONTACT_FAR * wh_contact_extent(of, w, k, s);
}

static inline void wh_contact_put_back(const wh_contact_system *of, wh_contact_work *w, wh_real h,
                                       const wh_real *input, const wh_contact_state *from,
                                       wh_contact_state *s) {
    wh_real accel[WH_COORDS];
    wh_real signal[2 * WH_CONTACTS_MAX];
    wh_contact_place spot = {from, h, 0, WH_CONTACTS_MAX};
    wh_contact_look(of, w, s, input, accel, signal);
    spot.but = wh_contact_breaking(of, w);
    for (unsigned k = 0; k < of->forced; k++) {
        const bool rests = wh_contact_of(of, k, WH_STOP) && w->mode[k] == WH_ACTIVE;
        spot.but |= rests && wh_contact_far(of, w, k, signal, s) ? wh_contact_stuck(of, w) : 0U;
    }
    for (unsigned pass = 0; pass < 2 && wh_contact_project_places(of, w, &spot, signal, input, s);
         pass++) {
        wh_contact_look(of, w, s, input, accel, signal);
    }
    wh_contact_project_rates(of, w, spot.but, false, wh_contact_rates(of, s));
}

/* Removes the integrator's slip in a step of length h from `from` to `s`. A pinned coordinate cannot slip. */
WH_INLINE void wh_contact_stabilise(const wh_contact_system *of, wh_contact_work *w, wh_real h,
                                    const wh_real *input, const wh_contact_state *from,
                                    wh_contact_state *s) {
    bool slips = false;
    WH_UNROLL
    for (unsigned k = 0; k < of->forced; k++) {
        slips = slips || (!wh_contact_pinned(of, k) && wh_contact_constrains(of, w, k));
    }
    if (slips) {
        wh_contact_put_back(of, w, h, input, from, s);
    }
}

/* Accepts a trial step from `from` to `to`: stores the slip of straight holds for a later projection. */
WH_INLINE void wh_contact_keep(const wh_contact_system *of, wh_contact_work *w,
                               const wh_contact_state *from, const wh_contact_state *to) {
    if (of->held == 0) {
        return;
    }
    for (unsigned k = 0; k < of->forced; k++) {
        if (wh_contact_slips(of, w, k) && of->contact[k].direction > 0) {
            w->held[of->contact[k].first_set] += wh_contact_moved(of, w, k, from, to);
        }
    }
}

#endif

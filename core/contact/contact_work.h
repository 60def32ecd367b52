/* contact_work.h: the working memory of a step with contacts. */
#ifndef WH_CONTACT_WORK_H
#define WH_CONTACT_WORK_H

#include "../contact.h"

/* Keeps rarely called functions out of line. */
#if defined(__GNUC__)
#define WH_APART static __attribute__((noinline, cold, unused))
#else
#define WH_APART static inline
#endif

/* Arguments of WH_MARK(), a macro that programs define to count the instructions of a step's parts
 * (boards/programs/mark.h). */
#define WH_MARK_ACCEL 1   /* the accelerations are evaluated next */
#define WH_MARK_SIGNALS 2 /* the signals are evaluated next */
#ifndef WH_MARK
#define WH_MARK(kind)
#endif

/* A step in progress: scratch memory, and the contacts' modes in the present trial step. */
typedef struct wh_contact_work {
    int8_t mode[WH_CONTACTS_MAX];
    wh_real force[WH_CONTACTS_MAX]; /* lambda, from the last evaluation of the accelerations */
    /* accelerations that the forces must add along the contacts, in the order of wh_contact_members() */
    wh_real wanted[WH_CONTACTS_MAX];
    wh_real rough[WH_CONTACTS_MAX]; /* round-off scale of the acceleration along each contact */
    wh_real law[WH_CONTACTS_MAX * (WH_LAW_ROWS + 2 * WH_COORDS)];
    /* Bits: stops that were closed when the trial step began, and may now open. */
    unsigned inside;
    unsigned hit_next; /* bits: touching stops that the next impact hits */
    /* bits: frictions whose rate has just come to zero: they may stick or slide on */
    unsigned turned;
    /* A signal that passes zero by at most this much gives no event. */
    wh_real slack[WH_CONTACTS_MAX];
    /* After wh_contact_turn_back(), a crossing's value has no certain sign up to this magnitude. */
    wh_real due[WH_CONTACTS_MAX];
    /* An undecided sign is decided if the value differs from stood[] by more than |stood[]|. */
    wh_real stood[WH_CONTACTS_MAX];
    wh_real came[WH_COORDS];       /* rates before the impulses of the present events */
    wh_real held[WH_CONTACTS_MAX]; /* values of the holds, indexed by wh_contact.first_set */
    unsigned moved;  /* bits: contacts that a crossing's assignments may have changed */
    unsigned mover;  /* the crossing whose assignments set `moved` */
    unsigned stands; /* bits: crossings at zero; wh_contact_turn_back() decides their signs */
    /* Crossings with an event are at zero, within the error of location. */
    bool located;
    bool capped;   /* the pivoting reached its limit of rounds */
    int fault;     /* component that was assigned a value beyond its range, or -1 */
    int undefined; /* contact with a non-finite expression, or -1 */
#if WH_LEDGER
    wh_ledger_work *books; /* NULL: no ledger */
    wh_real level[WH_ACCOUNTS_MAX];
#endif
} wh_contact_work;

typedef struct wh_contact_model {
    const wh_contact_system *of;
    wh_contact_work *work;
} wh_contact_model;

/* `gcc -Os` warns of unbounded loops unless `of` is the scene's constant. */
#if defined(WH_CONTACTS_OF) && defined(__OPTIMIZE_SIZE__)
#define WH_CONTACTS_HERE(of) WH_CONTACTS_OF(of)
#else
#define WH_CONTACTS_HERE(of) (of)
#endif

/* The scene's contacts; a generated scene defines WH_CONTACTS_OF as a constant. */
#ifndef WH_CONTACTS_OF
#define WH_CONTACTS_OF(model) ((model)->of)
#endif

/* The state of a trial step, with its own memory. */
typedef struct wh_contact_state {
    wh_angle angle[WH_COORDS];
    wh_real real[2 * WH_COORDS];
    wh_real carry[2 * WH_COORDS];
} wh_contact_state;

WH_INLINE void wh_contact_signals(const wh_contact_system *of, const wh_phase *phase,
                                  const wh_real *linear, const wh_real *rate, const wh_real *input,
                                  wh_real *signal) {
    WH_MARK(WH_MARK_SIGNALS);
    of->signals(of->model, phase, linear, rate, input, signal);
}

/* A point on the path of a trial step. */
typedef struct wh_contact_point {
    wh_phase phase[WH_COORDS];
    wh_real linear[WH_COORDS];
    wh_real rate[WH_COORDS];
} wh_contact_point;

WH_INLINE void wh_contact_copy(const wh_contact_system *of, const wh_angle *angle,
                               const wh_real *real, const wh_real *carry, wh_contact_state *to) {
    const unsigned reals = 2U * of->coordinates - of->angles;
    WH_UNROLL
    for (unsigned i = 0; i < of->angles; i++) {
        to->angle[i] = angle[i];
    }
    WH_UNROLL
    for (unsigned i = 0; i < reals; i++) {
        to->real[i] = real[i];
    }
    for (unsigned i = 0; i < of->angles + reals && of->compensated; i++) {
        to->carry[i] = carry[i];
    }
}

WH_INLINE wh_real *wh_contact_rates(const wh_contact_system *of, wh_contact_state *s) {
    return s->real + (of->coordinates - of->angles);
}

WH_INLINE void wh_contact_point_of(const wh_contact_system *of, wh_contact_state *s,
                                   wh_contact_point *at) {
    of = WH_CONTACTS_HERE(of);
    const wh_real *rate = wh_contact_rates(of, s);
    WH_UNROLL
    for (unsigned i = 0; i < of->angles; i++) {
        at->phase[i] = wh_phase_of(s->angle[i]);
    }
    WH_UNROLL
    for (unsigned i = of->angles; i < of->coordinates; i++) {
        at->linear[i - of->angles] = s->real[i - of->angles];
    }
    WH_UNROLL
    for (unsigned i = 0; i < of->coordinates; i++) {
        at->rate[i] = rate[i];
    }
}

/* Extrapolates the positions of `s` by the time `span`. at->rate gets the present rates. accel may be NULL. */
static inline void wh_contact_point_ahead(const wh_contact_system *of, wh_contact_state *s,
                                          wh_real span, const wh_real *accel,
                                          wh_contact_point *at) {
    wh_contact_point_of(of, s, at);
    for (unsigned i = 0; i < of->coordinates; i++) {
        const wh_real gain = accel != NULL ? WH_R(0.5) * span * accel[i] : WH_R(0.0);
        const wh_real way = span * (at->rate[i] + gain);
        if (i < of->angles) {
            (void)wh_phase_move(at->phase[i], way * WH_PHASE_PER_RAD, &at->phase[i]);
        } else {
            at->linear[i - of->angles] += way;
        }
    }
}

/* True if any of the contacts that have a force is of this kind. */
WH_INLINE bool wh_contact_any_of(const wh_contact_system *of, wh_contact_kind kind) {
    return (of->kinds & WH_KIND_BIT(kind)) != 0;
}

/* True if contact k, which has a force, is of this kind. The result is a constant if all contacts are of one kind. */
WH_INLINE bool wh_contact_of(const wh_contact_system *of, unsigned k, wh_contact_kind kind) {
    return wh_contact_any_of(of, kind) &&
           (of->kinds == WH_KIND_BIT(kind) || of->contact[k].kind == kind);
}

/* True if contact k, which has a force, is of a kind with one of the traits in `trait`. */
WH_INLINE bool wh_contact_is(const wh_contact_system *of, unsigned k, unsigned trait) {
#define WH_KIND_IS(name, is) || (((is)&trait) != 0 && wh_contact_of(of, k, name))
    return false WH_CONTACT_KINDS(WH_KIND_IS);
#undef WH_KIND_IS
}

/* Returns the coordinate to which contact k, which has a force, is pinned, or -1. */
WH_INLINE int wh_contact_pin(const wh_contact_system *of, unsigned k) {
    return of->pinned > 0 ? of->contact[k].pin : -1;
}

WH_INLINE bool wh_contact_pinned(const wh_contact_system *of, unsigned k) {
    return of->pinned > 0 && (of->pinned == of->forced || of->contact[k].pin >= 0);
}

WH_INLINE const wh_real *wh_contact_law(const wh_contact_system *of, const wh_contact_work *w,
                                        unsigned k) {
    return w->law + k * (WH_LAW_ROWS + 2U * of->coordinates);
}

WH_INLINE wh_real wh_jacobian_times(const wh_contact_system *of, const wh_contact_work *w,
                                    unsigned k, const wh_real *x) {
    const wh_real *row = wh_contact_law(of, w, k) + WH_LAW_ROWS;
    if (wh_contact_pinned(of, k)) {
        const int pin = wh_contact_pin(of, k);
        return row[pin] * x[pin];
    }
    wh_real sum = WH_R(0.0);
    for (unsigned i = 0; i < of->coordinates; i++) {
        sum += row[i] * x[i];
    }
    return sum;
}

/* x += M^-1 J_k^T lambda. */
WH_INLINE void wh_contact_apply(const wh_contact_system *of, const wh_contact_work *w, unsigned k,
                                wh_real lambda, wh_real *x) {
    const wh_real *way = wh_contact_law(of, w, k) + WH_LAW_ROWS + of->coordinates;
    for (unsigned i = 0; i < of->coordinates; i++) {
        x[i] += way[i] * lambda;
    }
}

/* Returns J_k M^-1 J_l^T, an entry of the Delassus matrix: the acceleration along contact k that a unit force of
 * contact l causes. */
WH_INLINE wh_real wh_delassus(const wh_contact_system *of, const wh_contact_work *w, unsigned k,
                              unsigned l) {
    return wh_jacobian_times(of, w, k, wh_contact_law(of, w, l) + WH_LAW_ROWS + of->coordinates);
}

/* Round-off of a sum, as a fraction of the sum of its terms' magnitudes. */
#define WH_CONTACT_ROUNDING (WH_DOUBLE ? WH_R(1e-11) : WH_R(1e-5))

WH_INLINE wh_real wh_delassus_diagonal(const wh_contact_system *of, const wh_contact_work *w,
                                       unsigned k) {
    return wh_delassus(of, w, k, k);
}

/* Solves sum_l (J_k M^-1 J_l^T) lambda_l = wanted_k for the contacts in member[count]. The matrix is positive
 * semidefinite, so the elimination needs no pivoting. Redundant contacts get lambda = 0, and so do contacts i with
 * at[i] != 0 if `at` is not NULL. Returns the redundant contacts, as bits of their indices in member[]. */
static inline unsigned wh_delassus_eliminate(const wh_contact_system *of, const wh_contact_work *w,
                                             const uint8_t *member, unsigned count,
                                             const int8_t *at, const wh_real *wanted,
                                             wh_real *lambda) {
    wh_real matrix[WH_CONTACTS_MAX][WH_CONTACTS_MAX] = {{WH_R(0.0)}};
    bool idle[WH_CONTACTS_MAX] = {false};
    unsigned repeats = 0;
    for (unsigned r = 0; r < count; r++) {
        lambda[r] = wanted[r];
        for (unsigned c = 0; c < count; c++) {
            matrix[r][c] = wh_delassus(of, w, member[r], member[c]);
        }
    }
    for (unsigned p = 0; p < count; p++) {
        const bool fixed = at != NULL && at[p] != 0;
        const bool none =
            !(matrix[p][p] > WH_CONTACT_ROUNDING * wh_delassus_diagonal(of, w, member[p]));
        idle[p] = fixed || none;
        repeats |= none && !fixed ? 1U << p : 0U;
        for (unsigned r = p + 1; r < count && !idle[p]; r++) {
            const wh_real factor = matrix[r][p] / matrix[p][p];
            for (unsigned c = p; c < count; c++) {
                matrix[r][c] -= factor * matrix[p][c];
            }
            lambda[r] -= factor * lambda[p];
        }
    }
    for (unsigned p = count; p-- > 0;) {
        wh_real sum = lambda[p];
        for (unsigned c = p + 1; c < count; c++) {
            sum -= matrix[p][c] * lambda[c];
        }
        lambda[p] = idle[p] ? lambda[p] - lambda[p] : sum / matrix[p][p];
    }
    return repeats;
}

/* As wh_delassus_eliminate(), but faster if no contact or one contact is active, as in most steps. */
WH_INLINE unsigned wh_delassus_solve(const wh_contact_system *of, const wh_contact_work *w,
                                     const uint8_t *member, unsigned count, const int8_t *at,
                                     const wh_real *wanted, wh_real *lambda) {
    if (count == 0) {
        lambda[0] = WH_R(0.0);
        return 0;
    }
    if (of->forced == 1 || count == 1) {
        const wh_real yield = wh_delassus_diagonal(of, w, member[0]);
        lambda[0] = yield > WH_R(0.0) ? wanted[0] / yield : wanted[0] - wanted[0];
        return yield > WH_R(0.0) ? 0U : 1U;
    }
    return wh_delassus_eliminate(of, w, member, count, at, wanted, lambda);
}

WH_INLINE bool wh_finite(wh_real value) { return value - value == WH_R(0.0); }

/* Reports contact k as undefined if its `value` is not finite. */
WH_INLINE void wh_contact_expect(wh_contact_work *w, unsigned k, wh_real value) {
    if (!wh_finite(value) && w->undefined < 0) {
        w->undefined = (int)k;
    }
}

/* True if contact k keeps J_k q' at zero. */
WH_INLINE bool wh_contact_constrains(const wh_contact_system *of, const wh_contact_work *w,
                                     unsigned k) {
    return w->mode[k] == (wh_contact_is(of, k, WH_LIMITED) ? WH_STUCK : WH_ACTIVE);
}

/* Checks that the limits of sticking frictions, the forces of sliding frictions and the values of holds are finite. (A
 * stop's restitution matters only at an impact.) */
WH_APART void wh_contact_expect_laws(const wh_contact_system *of, wh_contact_work *w) {
    for (unsigned k = 0; k < of->forced; k++) {
        const bool friction = wh_contact_of(of, k, WH_FRICTION);
        const bool slides = friction && w->mode[k] != WH_STUCK;
        if (friction || (wh_contact_of(of, k, WH_HOLD) && w->mode[k] == WH_ACTIVE)) {
            wh_contact_expect(w, k,
                              wh_contact_law(of, w, k)[slides ? WH_LAW_SECOND : WH_LAW_FIRST]);
        }
    }
}

WH_INLINE bool wh_contact_any_acts(const wh_contact_system *of, const wh_contact_work *w) {
    WH_UNROLL
    for (unsigned k = 0; k < of->forced; k++) {
        if (wh_contact_is(of, k, WH_LIMITED) || w->mode[k] == WH_ACTIVE) {
            return true;
        }
    }
    return false;
}

#endif

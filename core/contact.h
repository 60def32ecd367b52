/* contact.h: stops, holds, dry friction and located crossings: what happens inside a step.
 *
 * Between events a mechanism with contacts is smooth:
 *
 *     M(q) q'' = f(q, q', u) + sum_k J_k(q)^T lambda_k,        J_k = d(expression k)/dq
 *
 * where lambda_k is the force of contact k: zero for a stop out of touch, -sign(v) mu N for sliding
 * friction, and otherwise the force that keeps J_k q' at zero (a resting stop, a held expression, a
 * stuck coordinate), found from J M^-1 J^T lambda = -(J q'' + J' q'). Events change which of these
 * holds. A step looks for them at its end, locates the first with a bounded number of probes on cubics
 * through the step's ends, steps again to just past it, changes the modes (an impact by an
 * impulse through the mass matrix, Newton's restitution), and goes on with what is left of the step,
 * for at most WH_EVENTS_MAX moments. At the last one stops rest, the rest of the step is done, and where that made a
 * difference the state counts an overrun: the cost of a step is bounded, and no step is skipped. (Brogliato, Nonsmooth
 * Mechanics, chapters 1 and 7; Pfeiffer & Glocker, Multibody Dynamics with Unilateral Contacts.)
 *
 * Contacts are numbered stops first, then holds, frictions and crossings, each in order of
 * declaration; what happens at one instant happens to all of a kind together (contact_resolve.h). Friction's normal
 * force is finite, so an impact gives it no impulse. A bounce whose flight would be shorter than WH_REST_SHARE of a
 * step is not made: the stop rests.
 *
 * What a scene must offer is in `wh_contact_system`; what changes while running is in `wh_contacts` (scene.h).
 * contact_work.h has what a step works on, contact_lcp.h how contacts share a load, contact_forces.h the forces and
 * impulses, contact_ledger.h what they enter into the books, contact_locate.h the search for events,
 * contact_dip.h stops that are entered and left within a step, contact_impact.h, contact_crossing.h and
 * contact_resolve.h what they change, contact_begin.h what holds when a run begins, contact_project.h where they belong, contact_rank.h whether the holds still determine the motion,
 * contact_step.h the step. Scenes without contacts include none of these files. All are C only.
 */
#ifndef WH_CONTACT_H
#define WH_CONTACT_H

#ifdef __cplusplus
#error \
    "core/contact.h is C only, as generated .c files are: C++ includes core/scene.h and generated headers"
#endif

#include "step.h"
#include "step/ledger_step.h"

/* 1: the scene keeps books (ledger.h). A generated scene says. */
#ifndef WH_LEDGER
#define WH_LEDGER 0
#endif

/* Most contacts of a scene. A generated scene defines its own. */
#ifndef WH_CONTACTS_MAX
#define WH_CONTACTS_MAX WH_CONTACTS_LIMIT
#endif

/* Most values that a scene's crossings assign. A generated scene defines its own. */
#ifndef WH_SETS_MAX
#define WH_SETS_MAX (2 * WH_COORDS)
#endif

/* Most probes to locate an event, to WH_BRACKET of the interval at worst: halving alone needs all but some
 * of them, by which WH_PROBES_SPARE is above 1. The usual event takes six to ten probes and is located as
 * finely as rounding lets it, to WH_BRACKET_FINE. */
#if WH_DOUBLE
#define WH_PROBES 24
#define WH_BRACKET WH_R(0x1p-20)
#define WH_BRACKET_FINE WH_R(0x1p-50)
#else
#define WH_PROBES 14
#define WH_BRACKET WH_R(0x1p-10)
#define WH_BRACKET_FINE WH_R(0x1p-21)
#endif
#define WH_PROBES_SPARE WH_R(8.0)

/* Probes for a stop that a step passes through. */
#define WH_DIP_PROBES 6U

/* What a curved hold or stop has slipped in a step is put back twice where it is more than this share of the
 * way: what once leaves is of second order in it. */
#define WH_SLIP_COARSE (WH_DOUBLE ? WH_R(1e-6) : WH_R(1e-3))

/* Looks at what a step with too many events has let pass. */
#define WH_SQUEEZE_LOOKS 3U

/* Looks at a body that stands beyond a stop when a step begins, as after a correction: a round of the step's, so no more than its
 * probes. A curved gap takes several. */
#define WH_PUSH_LOOKS 12U

/* A flight shorter than this share of a step is none. */
#define WH_REST_SHARE WH_R(0.125)

/* What a kind of contact is. */
enum {
    WH_FORCED = 1,     /* it has a force, and a row of the Jacobian */
    WH_UNILATERAL = 2, /* which pushes and does not pull */
    WH_LIMITED = 4     /* which has a limit, slides at it, and is too small to give an impulse */
};

/* The kinds, in the order in which contacts are numbered: name, what it is. What each does at its events differs.
 * Of the core the compiler names only the switch of contact_locate.h to whoever adds one; some sixty lines of
 * contact_*.h ask whether a contact is of one kind, and take a new one for none of them: CONTRIBUTING.md says how to
 * find them. The language's row is in host/lang/kinds.h. */
#define WH_CONTACT_KINDS(X) \
    X(WH_STOP, WH_FORCED | WH_UNILATERAL) \
    X(WH_HOLD, WH_FORCED) \
    X(WH_FRICTION, WH_FORCED | WH_LIMITED) \
    X(WH_WHEN, 0)

#define WH_KIND_NAME(name, is) name,
typedef enum wh_contact_kind {
    WH_CONTACT_KINDS(WH_KIND_NAME) WH_CONTACT_KIND_COUNT
} wh_contact_kind;

#undef WH_KIND_NAME
#define WH_KIND_BIT(kind) (1U << (kind))

typedef struct wh_contact {
    uint8_t kind; /* wh_contact_kind */
    int8_t
        direction; /* crossing: +1 rising, -1 falling, 0 both; stop: 1 if an input moves it between steps, 2 if one
                        * with a rate does; hold: 1 if it is straight, its J_k constant, -1 if it follows
                        * an input with a rate; else 0 */
    int16_t pin; /* the one coordinate that J_k has an entry for, if that is constant: its rate
                        * is held at zero exactly; else -1 */
    uint8_t
        first_set; /* crossing: its assignments; hold without a pin: its place in wh_state's held[] */
    uint8_t sets;
} wh_contact;

/* Entries per contact in what `forces` computes, before the two rows of n. */
enum {
    WH_LAW_FIRST, /* stop: restitution; friction: mu_static * max(N, 0); curved hold: what it holds */
    WH_LAW_SECOND, /* friction: mu_kinetic * max(N, 0) */
    WH_LAW_BIAS,   /* J_k' q' */
    WH_LAW_ROWS    /* J_k[n], then (M^-1 J_k^T)[n] */
};

/* Most evaluations of the accelerations in one step, each with at most one of `forces`: in each of WH_EVENTS_MAX
 * rounds a try to the step's end and one to the event (`stages` each), at the end of both up to three looks that put
 * back what slipped, one more at the step's end, the search with one more at its begin (where no force matters, those
 * at both ends and none on the way), two looks at an impact and one at a capture, three after assignments, and one more
 * than there are contacts that may give way; then the last try, three looks at what passed, what settles the modes
 * behind it, and what finds or follows them when the step begins. */
#define WH_CONTACT_EVALUATIONS(stages, stops, forced) \
    (WH_EVENTS_MAX * (2 * (stages) + WH_PROBES + 12 + WH_CONTACT_LOOKS(stops, forced)) + \
     (stages) + 10 + 2 * WH_CONTACT_LOOKS(stops, forced))
#define WH_CONTACT_LOOKS(stops, forced) (2 * ((stops) > 0) + ((forced) > (stops)) + (forced))

/* Most evaluations of `signals` in one step: one with each of those above but the stages' and the search's two
 * ends, a second one where a step's end is compared with its begin and where a hold captures, two when a
 * crossing is taken, and two where such go then; and one where such stand when the step begins. */
#define WH_CONTACT_SIGNALS(forced, crossings) \
    (WH_EVENTS_MAX * (WH_PROBES + 15 + 3 * (forced) + 2 * (crossings)) + 12 + 6 * (forced))

/* A scene's contacts, constant. The functions are lists of operations like the accelerations. */
typedef struct wh_contact_system {
    const void *model;    /* first argument of the functions */
    wh_accel_fn *accel;   /* without contact forces */
    wh_accel_fn *signals; /* result[2 * contacts]: stop: gap, its rate; hold: condition (> 0: true),
                            * rate of the held expression; friction: rate, 0; crossing: value, 0 */
    wh_accel_fn *forces;  /* result[forced * (WH_LAW_ROWS + 2 n)] */
    wh_accel_fn *sets;    /* result[all sets]: the values that crossings assign, SI; or NULL */
    const wh_contact *contact;    /* [contacts] */
    const uint8_t *target;        /* [all sets]: component, angles first, then reals */
    const wh_ledger_form *ledger; /* or NULL */
    uint8_t contacts;
    uint8_t forced;       /* contacts that have a force: all but crossings */
    uint8_t kinds;        /* of those: WH_KIND_BIT() of each kind that there is */
    uint8_t pinned;       /* of those: how many have a pin */
    uint8_t held;         /* holds without a pin */
    uint16_t evaluations; /* WH_CONTACT_EVALUATIONS: declared, and held to by the tests */
    wh_method method;
    bool compensated;
    uint8_t angles;
    uint8_t coordinates;
    uint8_t driven; /* of those, the last: inputs with a rate (driven.h), which nothing pushes */
} wh_contact_system;

#endif

/* contact.h: stops, holds, dry friction and located crossings, with their events inside a step.
 *
 * Between events the motion is smooth: M(q) q'' = f(q, q', u) + sum_k J_k(q)^T lambda_k. J_k is the gradient of contact
 * k's expression by q, and lambda_k is the contact's force. It is zero for an open stop, and -sign(v) mu N for sliding
 * friction. A resting stop, a held expression or a stuck coordinate has the force that keeps J_k q' zero:
 *
 *      J M^-1 J^T lambda = -(J a + J' q'),        with the accelerations a without contact forces.
 *
 * A step checks for events at its end. It locates the first event by a bounded number of probes on cubics through the
 * step's two ends. Then it steps again, to just past the event, and changes the modes. An impact is an impulse through
 * the mass matrix with Newton's restitution. A step handles events at up to WH_EVENTS_MAX moments. At the last one,
 * stops come to rest instead of bouncing, and later events are not located. If this may have changed the motion, the
 * state counts an overrun. So the cost of a step is bounded, and no step is skipped. (Brogliato, Nonsmooth Mechanics,
 * chapters 1 and 7; Pfeiffer & Glocker, Multibody Dynamics with Unilateral Contacts.)
 *
 * Contacts are numbered stops first, then holds, frictions and crossings, each kind in order of declaration. Events of
 * one moment are resolved together, kind by kind (contact_resolve.h). Friction's normal force is finite, so friction
 * gives no impulse in an impact.
 *
 * A scene provides a `wh_contact_system`; the variables of a run are in `wh_contacts` (state.h). C only. */
#ifndef WH_CONTACT_H
#define WH_CONTACT_H

#include "step.h"
#include "step/ledger_step.h"

/* 1 if the scene keeps a ledger (ledger.h). A generated scene defines it. */
#ifndef WH_LEDGER
#define WH_LEDGER 0
#endif

/* Maximum numbers of contacts and of assignments by crossings. A generated scene defines its own maximum numbers. */
#ifndef WH_CONTACTS_MAX
#define WH_CONTACTS_MAX WH_CONTACTS_LIMIT
#endif

#ifndef WH_SETS_MAX
#define WH_SETS_MAX (2 * WH_COORDS)
#endif

/* The search for an event takes at most WH_PROBES probes. After n probes, the interval is at most WH_PROBES_SPARE /
 * 2^(n - 1) of its first length, so the last probe leaves at most the fraction WH_BRACKET. Usually, six to ten probes
 * reach the fraction WH_BRACKET_FINE, which is the limit set by round-off. */
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

/* Maximum number of probes for a stop that a body enters and leaves within one trial step. */
#define WH_DIP_PROBES 6U

/* Stops and holds are projected again if the first projection changes any contact's expression by more than this
 * fraction of the expression's change in the step. On a curved contact, one projection has an error of second order. */
#define WH_SLIP_COARSE (WH_DOUBLE ? WH_R(1e-6) : WH_R(1e-3))

/* Maximum number of projections onto the stops and holds after a step with too many events. */
#define WH_SQUEEZE_LOOKS 3U

/* Maximum number of projections of a body that is beyond a stop when a step begins. A curved gap needs several. */
#define WH_PUSH_LOOKS 12U

/* A body that hits a stop comes to rest if the next flight would be shorter than this fraction of a step. */
#define WH_REST_SHARE WH_R(0.125)

enum {
    WH_FORCED = 1,     /* has a force, and a row of the Jacobian */
    WH_UNILATERAL = 2, /* pushes and does not pull */
    WH_LIMITED = 4     /* slides if its force reaches a limit; an impact gives it no impulse */
};

/* X(kind, traits), in the order in which contacts are numbered. A new kind also needs a row in host/lang/words.h. The
 * compiler finds only some of the other lines to change; CONTRIBUTING.md says how to find all of them. */
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
    /* Crossing: +1 rising, -1 falling, 0 both. Friction: 0.
     * Stop: 2 if an input with a rate moves it, 1 if only other inputs move it, 0 if no input moves it.
     * Hold: -1 if an input with a rate moves its expression; otherwise 1 if J_k is constant, 0 if not. */
    int8_t direction;
    /* If the expression has one coordinate and J_k is constant (J_k' is 0): that coordinate's index. Otherwise -1. */
    int16_t pin;
    uint8_t first_set; /* crossing: its first index in target[]; hold: its index in held[] */
    uint8_t sets;
} wh_contact;

/* Layout of the numbers that `forces` gives for contact k: first these, then J_k[n], then (M^-1 J_k^T)[n]. */
enum {
    /* stop: restitution; friction: mu_static * max(N, 0); curved hold: the held expression */
    WH_LAW_FIRST,
    WH_LAW_SECOND, /* friction: mu_kinetic * max(N, 0) */
    WH_LAW_BIAS,   /* J_k' q' */
    WH_LAW_ROWS    /* index of J_k[0] */
};

/* Maximum number of evaluations of the accelerations in one step. Each evaluation of the accelerations evaluates
 * `forces` at most once. A step has up to WH_EVENTS_MAX rounds. A round has two trial steps with `stages` evaluations
 * each, a search with WH_PROBES probes, and the events. */
#define WH_CONTACT_EVALUATIONS(stages, stops, forced) \
    (WH_EVENTS_MAX * (2 * (stages) + WH_PROBES + 12 + WH_CONTACT_LOOKS(stops, forced)) + \
     (stages) + 10 + 2 * WH_CONTACT_LOOKS(stops, forced))
#define WH_CONTACT_LOOKS(stops, forced) (2 * ((stops) > 0) + ((forced) > (stops)) + (forced))

/* Maximum number of evaluations of `signals` in one step. */
#define WH_CONTACT_SIGNALS(forced, crossings) \
    (WH_EVENTS_MAX * (WH_PROBES + 15 + 3 * (forced) + 2 * (crossings)) + 12 + 6 * (forced))

/* A scene's contacts. The functions are operation lists, like the accelerations. */
typedef struct wh_contact_system {
    const void *model;  /* first argument of the functions */
    wh_accel_fn *accel; /* accelerations without contact forces */
    /* result[2 * contacts], two numbers for each contact. Stop: gap, rate of the gap. Hold: condition (true if > 0),
     * rate of the held expression. Friction: rate, 0. Crossing: value, 0. */
    wh_accel_fn *signals;
    wh_accel_fn *forces; /* result[forced * (WH_LAW_ROWS + 2 n)] */
    wh_accel_fn *sets;   /* result[all sets]: the values that crossings assign, SI units; or NULL */
    const wh_contact *contact;    /* [contacts] */
    const uint8_t *target;        /* [all sets]: assigned components; angles first, then reals */
    const wh_ledger_form *ledger; /* NULL: no ledger */
    uint8_t contacts;
    uint8_t forced;       /* number of contacts with a force: all except crossings */
    uint8_t kinds;        /* WH_KIND_BIT() of each kind with a force */
    uint8_t pinned;       /* number of contacts with wh_contact.pin >= 0 */
    uint8_t held;         /* number of holds without a pin */
    uint16_t evaluations; /* the value of WH_CONTACT_EVALUATIONS */
    wh_method method;
    bool compensated;
    uint8_t angles;
    uint8_t coordinates;
    uint8_t driven; /* number of inputs with a rate; they set the last coordinates (driven.h) */
} wh_contact_system;

#endif

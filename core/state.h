/* state.h: the variables of a run of a scene (scene.h). */
#ifndef WH_STATE_H
#define WH_STATE_H

#include "angle.h"

WH_C_BEGIN

/* The layout of a scene's state.
 *
 * Second order (Lagrangian mechanisms, q'' = f(q, q', u)): angles come first among the coordinates. angle[i] is
 * coordinate i for i < angles; real[] has the positions of the other coordinates, then the rates of all coordinates in
 * the same order. reals = 2*coordinates - angles.
 *
 * First order (systems stated directly): angle[] and real[] are the components of x' = f(x, u). */
typedef enum wh_form { WH_SECOND_ORDER, WH_FIRST_ORDER } wh_form;

/* One step handles events at up to WH_EVENTS_MAX moments. It logs and counts only its first WH_EVENT_LOG events. */
#define WH_EVENTS_MAX 8
#define WH_EVENT_LOG 16

/* Maximum number of contacts of any scene. */
#define WH_CONTACTS_LIMIT 16

/* Modes of a contact. A sliding friction's mode is the sign of its rate, a crossing's the sign of its value. */
enum {
    WH_FREE = 0,   /* stop that is not touched, or released hold */
    WH_ACTIVE = 1, /* stop on which a body rests, or closed hold */
    WH_STUCK = 0,  /* sticking friction */
    WH_UNSET = 127 /* after the start and after a correction, until the next step */
};

typedef struct wh_event {
    uint8_t contact;
    int8_t mode;     /* the contact's mode after the event */
    wh_real at_s;    /* time since the step began */
    wh_real impulse; /* impulse of a stop or a hold, else 0 */
} wh_event;

typedef struct wh_contacts {
    uint64_t events; /* number of logged events since the start */
    /* Number of steps whose motion may be wrong, because a step can handle only WH_EVENTS_MAX moments with events, or
     * because the search for the contact forces reached its limit. */
    uint64_t overruns;
    uint32_t logged; /* number of events of the last step, in log[] */
    wh_event log[WH_EVENT_LOG];
    int8_t mode[WH_CONTACTS_LIMIT]; /* [scene->contacts] */
} wh_contacts;

/* The variables of a run. All pointers point into the memory given to wh_scene_start(). */
typedef struct wh_state {
    uint64_t steps;  /* number of steps done: the time is computed from it */
    wh_angle *angle; /* [scene->angles] */
    wh_real *real;   /* [scene->reals] SI units */
    wh_real *carry;  /* [scene->angles + scene->reals] low parts; NULL: sums are not compensated */
    wh_real *input;  /* [scene->inputs] SI units; the caller may set them between steps */
    wh_contacts *contacts; /* NULL without contacts */
    wh_real *held;         /* [scene->held] SI units: value (curved hold) or slip (straight hold) */
    wh_real *ledger;       /* totals, their carries, other reals (ledger.h); NULL: no ledger */
    /* After WH_E_DIVERGED: index of the component, angles first, then reals. After WH_E_UNDEFINED or WH_E_SINGULAR:
     * index of the contact (contact.h). After WH_E_ARITHMETIC: the failed check, a wh_probed (arithmetic.h). */
    int fault;
} wh_state;

typedef struct wh_ledger_form wh_ledger_form;

/* Computes the accelerations of a second-order system: accel[coordinates]. */
typedef void wh_accel_fn(const void *model, const wh_phase *phase, const wh_real *linear,
                         const wh_real *rate, const wh_real *input, wh_real *accel);

WH_C_END

#endif

/* scene.h: a scene is one mechanism, compiled with only the effects it names, ready to step.
 *
 * A generated file (build/gen/NAME.c) defines one constant `wh_scene`; it lives in flash. What
 * changes while running lives in a `wh_state` and in memory that the caller owns, whose size the generated
 * header (build/gen/NAME.h) tells beside the places of coordinates, inputs and outputs:
 *
 *     static uint64_t memory[thomson_a_MEMORY_WORDS];
 *     wh_state state;
 *     wh_scene_start(&thomson_a, &state, memory, sizeof memory);
 *     while (wh_scene_step(&thomson_a, &state) == WH_OK) { ... }
 *
 * Verbs follow eFMI's Startup / DoStep. Nothing here allocates, recurses or calls a library. This file,
 * the generated header, and what they include are C11 and C++11; generated .c files and the core's own are C.
 */
#ifndef WH_SCENE_H
#define WH_SCENE_H

#include <stddef.h>

#include "angle.h"
#include "method.h"
#include "real.h"

#ifdef __cplusplus
extern "C" {
#endif

/* How a scene's state is arranged.
 *
 * Second order (Lagrangian mechanisms, q'' = f(q, q', u)): coordinates are ordered with the
 * angles first. angle[i] is coordinate i for i < angles; real[] holds the positions of the other
 * coordinates, then the rates of all coordinates in the same order. reals = 2*coordinates - angles.
 *
 * First order (systems given outright): angle[] and real[] are the components of x' = f(x, u). */
typedef enum wh_form { WH_SECOND_ORDER, WH_FIRST_ORDER } wh_form;

/* Has this method (method.h) steps for such systems? */
WH_INLINE bool wh_method_takes(wh_method method, wh_form form) {
#define WH_METHOD_TAKES(id, word, title, order, takes, ...) | ((unsigned)(takes) >> 1 & 1U) << (id)
    const unsigned first_order = 0U WH_METHOD_ROWS(WH_METHOD_TAKES);
#undef WH_METHOD_TAKES
    return (unsigned)method < WH_METHODS &&
           (form == WH_SECOND_ORDER || (first_order >> method & 1U) != 0);
}

/* Most moments with events in one step, and most events that are logged. */
#define WH_EVENTS_MAX 8
#define WH_EVENT_LOG 16

/* Most contacts of any scene. */
#define WH_CONTACTS_LIMIT 16

/* Modes of a contact. Friction that slides has the sign of its rate, a crossing the side it is on. */
enum {
    WH_FREE = 0,   /* stop out of touch; hold let go */
    WH_ACTIVE = 1, /* stop resting; hold held */
    WH_STUCK = 0,  /* friction */
    WH_UNSET = 127 /* before the first step */
};

/* An event of a scene with contacts (contact.h). */
typedef struct wh_event {
    uint8_t contact;
    int8_t mode;     /* the contact's mode after it */
    wh_real at_s;    /* since the step began */
    wh_real impulse; /* of a stop or a hold, else 0 */
} wh_event;

/* What of the contacts changes while running. */
typedef struct wh_contacts {
    uint64_t events;   /* since the start */
    uint64_t overruns; /* steps that had WH_EVENTS_MAX moments with events */
    uint32_t logged;   /* events of the last step, in log[] */
    wh_event log[WH_EVENT_LOG];
    int8_t mode[WH_CONTACTS_LIMIT]; /* [scene->contacts] are in use */
} wh_contacts;

/* The changing part of a run. All pointers point into the memory given to wh_scene_start(). */
typedef struct wh_state {
    uint64_t steps;  /* steps done; time follows from them and is never a running sum */
    wh_angle *angle; /* [scene->angles] */
    wh_real *real;   /* [scene->reals] SI units */
    wh_real *carry;  /* [scene->angles + scene->reals] low parts when compensated, else NULL */
    wh_real *input;  /* [scene->inputs] SI units; the caller may change them between steps */
    wh_contacts *contacts; /* NULL without contacts */
    wh_real *held;   /* [scene->held] what holds keep: curved ones what it is, straight ones by how
                      * much it has slipped; SI units */
    wh_real *ledger; /* the books' totals, their carries, the levels at the start; or NULL */
    /* after WH_E_DIVERGED or WH_E_TURN: the component at fault, angles first, then reals; after WH_E_UNDEFINED or
     * WH_E_SINGULAR: the contact, in the order of contact.h; after WH_E_ARITHMETIC: what is wrong, a
     * wh_probed (arithmetic.h) */
    int fault;
} wh_state;

/* numerator / denominator, both below 2^63. */
typedef struct wh_fraction {
    uint64_t numerator;
    uint64_t denominator;
} wh_fraction;

/* A time, seconds: whole_s + fraction_s. */
typedef struct wh_time {
    uint64_t whole_s;
    wh_real fraction_s; /* 0 <= fraction_s < 1 */
} wh_time;

/* Accelerations of a second-order system. accel[coordinates]. */
typedef void wh_accel_fn(const void *model, const wh_phase *phase, const wh_real *linear,
                         const wh_real *rate, const wh_real *input, wh_real *accel);

typedef struct wh_ledger_form wh_ledger_form; /* ledger.h */

typedef struct wh_scene wh_scene;
struct wh_scene {
    const char *name;
    wh_form form;
    wh_method method;
    uint8_t angles;   /* components kept as a turn angle */
    uint8_t reals;    /* components kept as a real */
    uint8_t inputs;   /* may change while running */
    uint8_t outputs;  /* computed by observe(), never in the step */
    uint8_t contacts; /* stops, holds, frictions and crossings, <= WH_CONTACTS_LIMIT */
    uint8_t held;     /* holds that could slip: of more than one coordinate, or curved */
    bool compensated; /* sums carry their rounding error along */
    wh_real step_s;   /* fixed step, seconds, > 0 */
    wh_fraction step; /* the same exactly, for wh_scene_time(); {0, 0}: not known */
    uint64_t steps;   /* steps to the scene's end, at most 2^63 */
    const wh_angle *start_angle;
    const wh_real *start_real;
    const wh_real *start_input;
    const wh_ledger_form *ledger; /* NULL: no books are kept */
    const void *model;            /* the interpreter's operation list; NULL in generated code */
    uint64_t model_hash;          /* of the operation list: which physics this is */
    /* One step. On divergence returns WH_E_DIVERGED, where a contact's gap, condition, value, friction or
     * restitution is no finite number WH_E_UNDEFINED; sets state->fault and leaves the rest as it was. Does not count the step: wh_scene_step() does. */
    wh_status (*advance)(const wh_scene *scene, wh_state *state);
    /* The outputs at the present state: output[scene->outputs], SI units. May be NULL. */
    void (*observe)(const wh_scene *scene, const wh_state *state, wh_real *output);
    /* Shows how the file of advance() was compiled: wh_arithmetic() of arithmetic.h, or NULL. */
    void (*arithmetic)(wh_real *result);
};

/* Bytes of caller memory that wh_scene_start() takes for so many angles, so many reals in all (those of the
 * state, a low part for each component when compensated, inputs, what is held, the ledger's) and contacts. A
 * constant where they are; generated headers have it with the scene's own. */
#define WH_MEMORY_BYTES(angles, all_reals, contacts) \
    ((contacts) > 0 ? (WH_NUMBER_BYTES(angles, all_reals) + 7U) / 8U * 8U + sizeof(wh_contacts) \
                    : WH_NUMBER_BYTES(angles, all_reals))
#define WH_NUMBER_BYTES(angles, all_reals) \
    ((size_t)(angles) * sizeof(wh_angle) + (size_t)(all_reals) * sizeof(wh_real))

/* By hand, enough for either: eight-byte words of caller memory for a state of so many angles, reals and inputs. */
#define WH_STATE_WORDS(angles, reals, inputs) \
    ((size_t)(angles) + (2U * (size_t)(reals) + (size_t)(angles) + (size_t)(inputs)))

/* What a scene with so many contacts needs on top. */
#define WH_CONTACT_WORDS(contacts) ((contacts) > 0 ? (sizeof(wh_contacts) + 7U) / 8U : 0U)

/* And one with so many holds that could slip. */
#define WH_HELD_WORDS(held) ((size_t)(held))

/* And one with a ledger of so many entries and accounts. */
#define WH_LEDGER_WORDS(entries, accounts) (2U * (size_t)(entries) + (size_t)(accounts))

#define wh_scene_start WH_NAME(wh_scene_start)
#define wh_scene_step WH_NAME(wh_scene_step)
#define wh_scene_time WH_NAME(wh_scene_time)
#define wh_scene_time_s WH_NAME(wh_scene_time_s)
#define wh_scene_hash WH_NAME(wh_scene_hash)
#define wh_scene_rates WH_NAME(wh_scene_rates)
#define wh_status_text WH_NAME(wh_status_text)

/* Put `state` at the scene's start. `memory`, of `bytes` bytes and aligned as a uint64_t in a struct is, must
 * outlive the run. Returns WH_OK; or, with state and memory untouched, WH_E_MEMORY when it is too little or NULL, and
 * WH_E_ARGUMENT when it is not aligned, when scene or state is NULL, and for a scene that no generator writes: a
 * method that its form does not have, too many contacts; or WH_E_ARITHMETIC where compiler flags or the machine's
 * modes make other bits than those of every other machine: state->fault then says how. */
wh_status wh_scene_start(const wh_scene *scene, wh_state *state, void *memory, size_t bytes);

/* Do one step. Returns WH_OK; or WH_E_DIVERGED or WH_E_UNDEFINED, with the last good state kept and
 * state->fault set (a further call fails the same way, it does not go on from garbage). */
wh_status wh_scene_step(const wh_scene *scene, wh_state *state);

/* Time of the state: state->steps * scene->step, exact but for one rounding of the fraction to the nearest
 * real. Good for all times below 2^64 s: float holds a microsecond of a run of years. Where the scene does
 * not say its step as a fraction: wh_scene_time_s(), split. */
wh_time wh_scene_time(const wh_scene *scene, const wh_state *state);

/* The same as one real: steps * step_s, off by at most 1.5 U of itself and by what step_s is off (U = 2^-24
 * in float: a millisecond at 4.7 h). What the outputs of generated scenes compute with. */
wh_real wh_scene_time_s(const wh_scene *scene, const wh_state *state);

/* Hash of step count, angles, reals, what holds keep and the contacts' modes: equal runs on any two machines give equal hashes. */
uint64_t wh_scene_hash(const wh_scene *scene, const wh_state *state);

/* Where the rates of a second-order scene begin in state->real. */
const wh_real *wh_scene_rates(const wh_scene *scene, const wh_state *state);

/* A status in words, for consoles. */
const char *wh_status_text(wh_status status);

#ifdef __cplusplus
}
#endif

#endif

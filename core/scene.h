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

#include "method.h"
#include "state.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Has this method (method.h) steps for such systems? */
WH_INLINE bool wh_method_takes(wh_method method, wh_form form) {
#define WH_METHOD_TAKES(id, word, title, order, takes, ...) | ((unsigned)(takes) >> 1 & 1U) << (id)
    const unsigned first_order = 0U WH_METHOD_ROWS(WH_METHOD_TAKES);
#undef WH_METHOD_TAKES
    return (unsigned)method < WH_METHODS &&
           (form == WH_SECOND_ORDER || (first_order >> method & 1U) != 0);
}

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
    /* One step, counted in state->steps. On divergence returns WH_E_DIVERGED, where a contact's gap, condition, value,
     * friction or restitution is no finite number WH_E_UNDEFINED; sets state->fault and leaves the rest as it was. */
    wh_status (*advance)(const wh_scene *scene, wh_state *state);
    /* So many steps, one or more, counted in state->steps: as wh_scene_steps(). NULL: advance() in a loop. Generated code
     * that is compiled with -DWH_AHEAD=1 has it. */
    wh_status (*ahead)(const wh_scene *scene, wh_state *state, uint32_t steps);
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
    (WH_SIZE(angles) * sizeof(wh_angle) + WH_SIZE(all_reals) * sizeof(wh_real))

/* By hand, enough for either: eight-byte words of caller memory for a state of so many angles, reals and inputs. */
#define WH_STATE_WORDS(angles, reals, inputs) \
    (WH_SIZE(angles) + (2U * WH_SIZE(reals) + WH_SIZE(angles) + WH_SIZE(inputs)))

/* What a scene with so many contacts needs on top. */
#define WH_CONTACT_WORDS(contacts) ((contacts) > 0 ? (sizeof(wh_contacts) + 7U) / 8U : 0U)

/* And one with so many holds that could slip. */
#define WH_HELD_WORDS(held) (WH_SIZE(held))

/* And one with a ledger of so many entries and accounts. */
#define WH_LEDGER_WORDS(entries, accounts) (2U * WH_SIZE(entries) + WH_SIZE(accounts))

#define wh_scene_start WH_NAME(wh_scene_start)
#define wh_scene_step WH_NAME(wh_scene_step)
#define wh_scene_steps WH_NAME(wh_scene_steps)
#define wh_scene_set_real WH_NAME(wh_scene_set_real)
#define wh_scene_set_angle WH_NAME(wh_scene_set_angle)
#define wh_scene_move_angle WH_NAME(wh_scene_move_angle)
#define wh_scene_time WH_NAME(wh_scene_time)
#define wh_scene_time_s WH_NAME(wh_scene_time_s)
#define wh_scene_hash WH_NAME(wh_scene_hash)
#define wh_scene_rates WH_NAME(wh_scene_rates)
#define wh_status_text WH_NAME(wh_status_text)

/* Put `state` at the scene's start. `memory`, of `bytes` bytes and aligned as a uint64_t in a struct is, must
 * outlive the run. Returns WH_OK; or, with memory untouched and the state not started, WH_E_MEMORY when it is too little or
 * NULL, and WH_E_ARGUMENT when it is not aligned, when scene or state is NULL, and for a scene that no generator writes: a
 * method that its form does not have, too many contacts; or WH_E_ARITHMETIC where compiler flags or the machine's
 * modes make other bits than those of every other machine: state->fault then says how. */
wh_status wh_scene_start(const wh_scene *scene, wh_state *state, void *memory, size_t bytes);

/* Do one step; `scene` and `state` are no null pointers. Returns WH_OK; or WH_E_DIVERGED, WH_E_UNDEFINED or WH_E_SINGULAR,
 * with the last good state kept and state->fault set (while inputs stay the same a further call fails the same way; it does not go on from garbage); or WH_E_ARGUMENT for a state that was
 * not started: zeroed, or refused by wh_scene_start(). */
wh_status wh_scene_step(const wh_scene *scene, wh_state *state);

/* Do so many steps, or none, for simulating ahead. The bits are those of as many calls of wh_scene_step(); it takes fewer
 * instructions where the scene's file is compiled with -DWH_AHEAD=1, for as much flash again. Returns as wh_scene_step();
 * state->steps tells how many were done. */
wh_status wh_scene_steps(const wh_scene *scene, wh_state *state, uint32_t steps);

/* Correct the state from a measurement, between two steps; SI units. `real` and `angle` are the generated header's
 * indices: SCENE_REAL_x, SCENE_RATE_x and SCENE_ANGLE_theta. The next step then goes on as a run does that starts from the
 * corrected state: it puts what stands beyond a stop back onto it, finds every contact's mode again, and lets each hold
 * keep the value that it finds. What was rounded off the component is forgotten. With a ledger, the change of each account
 * is kept apart (wh_ledger_corrected()). An angle keeps its turns. wh_scene_move_angle() adds to it, and so keeps all its
 * digits after many turns. Returns WH_OK; or, with the state as it was, WH_E_ARGUMENT for an index that the scene does not
 * have, a value that is no finite number or beyond all bounds, and a state that was not started. */
wh_status wh_scene_set_real(const wh_scene *scene, wh_state *state, unsigned real, wh_real value);
wh_status wh_scene_set_angle(const wh_scene *scene, wh_state *state, unsigned angle, wh_real rad);
wh_status wh_scene_move_angle(const wh_scene *scene, wh_state *state, unsigned angle,
                              wh_real by_rad);

/* Time of the state: state->steps * scene->step, exact but for one rounding of the fraction to the nearest
 * real. Good for all times below 2^64 s: float holds a microsecond of a run of years. Where the scene does
 * not say its step as a fraction: wh_scene_time_s(), split. */
wh_time wh_scene_time(const wh_scene *scene, const wh_state *state);

/* The same as one real: steps * step_s, off by at most 1.5 U of itself and by what step_s is off (U = 2^-24
 * in float: a millisecond at 4.7 h). What the outputs of generated scenes compute with. */
wh_real wh_scene_time_s(const wh_scene *scene, const wh_state *state);

/* Hash of step count, angles, reals, what holds keep and the contacts' modes: equal runs on any two machines give equal hashes.
 * 0 for a state that was not started. */
uint64_t wh_scene_hash(const wh_scene *scene, const wh_state *state);

/* Where the rates of a second-order scene begin in state->real. NULL for a state that was not started. */
const wh_real *wh_scene_rates(const wh_scene *scene, const wh_state *state);

/* A status in words, for consoles. */
const char *wh_status_text(wh_status status);

#ifdef __cplusplus
}
#endif

#endif

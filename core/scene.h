/* scene.h: a scene: one mechanism with the effects that it names, compiled and ready to step.
 *
 * A generated file (build/gen/NAME.c) defines one constant `wh_scene`, in flash. A run's variables are in a `wh_state`
 * and in memory that the caller owns. The generated header (build/gen/NAME.h) gives the memory's size and the indices
 * of coordinates, inputs and outputs:
 *
 *     static uint64_t memory[thomson_a_MEMORY_WORDS];
 *     wh_state state;
 *     wh_scene_start(&thomson_a, &state, memory, sizeof memory);
 *     while (wh_scene_step(&thomson_a, &state) == WH_OK) { ... }
 *
 * Nothing here allocates, recurses or calls a library. This file, the generated header and their includes are C11 and
 * C++11; generated .c files and the core's .c files are C only. */
#ifndef WH_SCENE_H
#define WH_SCENE_H

#include <stddef.h>

#include "method.h"
#include "state.h"

WH_C_BEGIN

WH_INLINE bool wh_method_takes(wh_method method, wh_form form) {
#define WH_METHOD_TAKES(id, word, title, order, takes, ...) | ((unsigned)(takes) >> 1 & 1U) << (id)
    const unsigned first_order = 0U WH_METHOD_ROWS(WH_METHOD_TAKES);
#undef WH_METHOD_TAKES
    return (unsigned)method < WH_METHODS &&
           (form == WH_SECOND_ORDER || (first_order >> method & 1U) != 0);
}

typedef struct wh_fraction { /* both are below 2^63 */
    uint64_t numerator;
    uint64_t denominator;
} wh_fraction;

typedef struct wh_time {
    uint64_t whole_s;
    wh_real fraction_s; /* 0 <= fraction_s < 1 */
} wh_time;

typedef struct wh_scene wh_scene;
struct wh_scene {
    const char *name;
    wh_form form;
    wh_method method;
    uint8_t angles;   /* number of components stored as a turn angle */
    uint8_t reals;    /* number of components stored as a real */
    uint8_t inputs;   /* number of values that may change between steps */
    uint8_t outputs;  /* number of outputs, computed by observe() */
    uint8_t contacts; /* number of stops, holds, frictions and crossings, <= WH_CONTACTS_LIMIT */
    uint8_t held;     /* number of holds whose expression is curved or has several coordinates */
    uint8_t driven;   /* number of inputs with a rate; each sets one of the last coordinates */
    bool compensated; /* sums are compensated for round-off */
    wh_real step_s;   /* fixed step, seconds, > 0 */
    wh_fraction step; /* step_s as an exact fraction, for wh_scene_time(); {0, 0}: not known */
    uint64_t steps;   /* number of steps from the start to the scene's end, at most 2^63 */
    const wh_angle *start_angle;
    const wh_real *start_real;
    const wh_real *start_input;
    const wh_ledger_form *ledger; /* NULL: the scene has no ledger */
    const void *model;            /* the interpreter's operation list; NULL in generated code */
    uint64_t model_hash;          /* hash of the operation list: identifies the physics */
    /* Does one step and increments state->steps. Returns as wh_scene_step() does. */
    wh_status (*advance)(const wh_scene *scene, wh_state *state);
    /* Does `steps` >= 1 steps: see wh_scene_steps(). NULL unless generated code is compiled with -DWH_MULTI_STEP=1. */
    wh_status (*multi_step)(const wh_scene *scene, wh_state *state, uint32_t steps);
    /* Computes the outputs at the present state: output[scene->outputs], SI units. May be NULL. */
    void (*observe)(const wh_scene *scene, const wh_state *state, wh_real *output);
    /* wh_arithmetic() (arithmetic.h), compiled in the same file as advance(). May be NULL. */
    void (*arithmetic)(wh_real *result);
};

/* Bytes of caller memory for wh_scene_start(). The generated header calls this macro. all_reals is the number of reals,
 * inputs, held values and the ledger's reals. If the scene is compensated, add the numbers of angles and reals. */
#define WH_MEMORY_BYTES(angles, all_reals, contacts) \
    ((contacts) > 0 ? (WH_NUMBER_BYTES(angles, all_reals) + 7U) / 8U * 8U + sizeof(wh_contacts) \
                    : WH_NUMBER_BYTES(angles, all_reals))
#define WH_NUMBER_BYTES(angles, all_reals) \
    (WH_SIZE(angles) * sizeof(wh_angle) + WH_SIZE(all_reals) * sizeof(wh_real))

/* For arrays sized by hand. The sum of these four macros is a number of eight-byte words that is enough for float and
 * double, and for compensated sums. WH_LEDGER_WORDS takes members of wh_ledger_form; omit it without a ledger. */
#define WH_STATE_WORDS(angles, reals, inputs) \
    (WH_SIZE(angles) + (2U * WH_SIZE(reals) + WH_SIZE(angles) + WH_SIZE(inputs)))

#define WH_CONTACT_WORDS(contacts) ((contacts) > 0 ? (sizeof(wh_contacts) + 7U) / 8U : 0U)

#define WH_HELD_WORDS(held) (WH_SIZE(held))

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

/* Put `state` at the scene's start. `memory` has `bytes` bytes, is aligned as a uint64_t in a struct, and must outlive
 * the run. Returns WH_OK; or an error, with the memory untouched and the state not started:
 * - WH_E_MEMORY: the memory is too small or NULL.
 * - WH_E_ARGUMENT: the memory is not aligned, scene or state is NULL, wh_method_takes() is false for the scene, or the
 * scene has too many contacts.
 * - WH_E_ARITHMETIC: compiler flags or the machine's modes change results. state->fault is the failed check. */
wh_status wh_scene_start(const wh_scene *scene, wh_state *state, void *memory, size_t bytes);

/* Do one step; `scene` and `state` must not be NULL. Returns WH_OK or an error:
 * - WH_E_ARGUMENT: state->real is NULL, as in a zeroed state or after an error of wh_scene_start().
 * - WH_E_DIVERGED, WH_E_UNDEFINED, WH_E_SINGULAR: the last good state is kept, and state->fault is set. A repeated call
 * with the same inputs fails with the same error. */
wh_status wh_scene_step(const wh_scene *scene, wh_state *state);

/* Do `steps` >= 0 steps, with the same bits as `steps` calls of wh_scene_step(). Returns as wh_scene_step() does.
 * state->steps counts the steps done. -DWH_MULTI_STEP=1 for the scene's file saves instructions, but the step's code
 * then takes twice the flash. */
wh_status wh_scene_steps(const wh_scene *scene, wh_state *state, uint32_t steps);

/* Correct one component of the state from a measurement, between two steps; SI units. The generated header has the
 * indices for `real` and `angle`: SCENE_REAL_x, SCENE_RATE_x and SCENE_ANGLE_theta. wh_scene_move_angle() adds by_rad
 * to the angle. In float, after many turns, it is more accurate than wh_scene_set_angle().
 *
 * The next step begins like the first step of a run: it moves a coordinate beyond a stop back onto the stop, and finds
 * every contact's mode again. Each closed hold then keeps the value that its expression has. A ledger stores the
 * change of each account separately (wh_ledger_corrected()).
 *
 * Returns WH_OK; or WH_E_ARGUMENT, with the state unchanged. The errors are: the state was not started, the index is
 * unknown, an input with a rate sets the component, or the value is not finite or out of bounds. */
wh_status wh_scene_set_real(const wh_scene *scene, wh_state *state, unsigned real, wh_real value);
wh_status wh_scene_set_angle(const wh_scene *scene, wh_state *state, unsigned angle, wh_real rad);
wh_status wh_scene_move_angle(const wh_scene *scene, wh_state *state, unsigned angle,
                              wh_real by_rad);

/* Time of the state: state->steps * scene->step, below 2^64 s. whole_s is exact. fraction_s is rounded to the nearest
 * real. If scene->step.denominator is 0, the result is wh_scene_time_s(), split into whole_s and fraction_s. */
wh_time wh_scene_time(const wh_scene *scene, const wh_state *state);

/* Time of the state as one real: steps * step_s. Two roundings, and the error of step_s, give a relative error of at
 * most 3 * 2^-24 in float: 2 ms in 3 h. The outputs of generated scenes use this time. */
wh_real wh_scene_time_s(const wh_scene *scene, const wh_state *state);

/* Returns a hash of steps, angles, reals, holds' values and contact modes, equal on all machines; 0 if not started. */
uint64_t wh_scene_hash(const wh_scene *scene, const wh_state *state);

/* Returns the address of a second-order scene's rates in state->real, or NULL if the state was not started. */
const wh_real *wh_scene_rates(const wh_scene *scene, const wh_state *state);

const char *wh_status_text(wh_status status);

WH_C_END

#endif

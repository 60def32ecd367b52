/* fixed_scene.h: a scene that steps in fixed point (fixed.h), for processors without floating-point arithmetic.
 *
 * A file made by `whirl derive SCENE --as c --number fixed --name gear --header gear.h` defines one constant `gear`, a
 * `wh_fixed_scene`; its steps have no floating-point operation. The variables of a run are in a `wh_fixed_state` and in
 * memory that the caller owns:
 *
 *     static uint64_t memory[gear_MEMORY_WORDS];
 *     wh_fixed_state state;
 *     if (wh_fixed_start(&gear, &state, memory, sizeof memory) != WH_OK) { return 1; }
 *     if (wh_fixed_set_input(&gear, &state, gear_INPUT_M, 1.5f) != WH_OK) { return 1; }
 *     while (state.steps < gear.steps && state.saturated == 0) { wh_fixed_step(&gear, &state); }
 *     const wh_real theta_rad = wh_fixed_angle(&gear, &state, gear_ANGLE_theta);
 *     const wh_real rate_rad_s = wh_fixed_real(&gear, &state, gear_RATE_theta);
 *
 * Each input and each component except turn angles has a range. A value beyond its range is set to the nearer end and
 * increments state.saturated: from then on the motion is wrong. Inside the ranges nothing overflows; the generator
 * proves it. A step rounds each increment to a multiple of about 2^-30 of the range. Increments below half of that are
 * lost without being counted (`whirl run --number fixed` prints the loss). */
#ifndef WH_FIXED_SCENE_H
#define WH_FIXED_SCENE_H

#include <stddef.h>

#include "fixed.h"

WH_C_BEGIN

/* A value v is stored as the integer v 2^bits, limited to low..high. */
typedef struct wh_fixed_format {
    int16_t bits;
    int32_t low;
    int32_t high;
} wh_fixed_format;

/* The variables of a run. The pointers point into the memory given to wh_fixed_start(). */
typedef struct wh_fixed_state {
    uint64_t steps;
    uint32_t saturated; /* number of values that were limited to their range since the start */
    int64_t *angle;     /* [scene->angles], 2^32 per turn, whole turns included */
    int32_t *real;      /* [scene->reals], in the order of wh_state.real (state.h) */
    int32_t *input;     /* [scene->inputs] */
} wh_fixed_state;

typedef struct wh_fixed_scene wh_fixed_scene;
struct wh_fixed_scene {
    const char *name;
    uint8_t angles;
    uint8_t reals;
    uint8_t inputs;
    uint64_t steps;                /* number of steps from the start to the scene's end */
    const wh_fixed_format *format; /* [reals + inputs]: the reals' formats, then the inputs' */
    const int64_t *start_angle;
    const int32_t *start_real;
    const int32_t *start_input;
    const void *model; /* the interpreter's operation list; NULL in generated code */
    uint64_t model_hash;
    /* Does one step and increments state->steps. Returns WH_OK. */
    wh_status (*advance)(const wh_fixed_scene *scene, wh_fixed_state *state);
};

/* Bytes of caller memory for `angles` angles, and for `numbers` reals and inputs together. */
#define WH_FIXED_BYTES(angles, numbers) (WH_SIZE(angles) * 8U + WH_SIZE(numbers) * 4U)

#define wh_fixed_start WH_NAME(wh_fixed_start)
#define wh_fixed_step WH_NAME(wh_fixed_step)
#define wh_fixed_hash WH_NAME(wh_fixed_hash)
#define wh_fixed_of WH_NAME(wh_fixed_of)
#define wh_fixed_to WH_NAME(wh_fixed_to)
#define wh_fixed_real WH_NAME(wh_fixed_real)
#define wh_fixed_angle WH_NAME(wh_fixed_angle)
#define wh_fixed_set_real WH_NAME(wh_fixed_set_real)
#define wh_fixed_set_input WH_NAME(wh_fixed_set_input)
#define wh_fixed_set_raw_input WH_NAME(wh_fixed_set_raw_input)

/* Put `state` at the scene's start. Returns WH_OK; WH_E_ARGUMENT if a pointer is NULL or the memory is not aligned as a
 * uint64_t; or WH_E_MEMORY if it is too small. */
wh_status wh_fixed_start(const wh_fixed_scene *scene, wh_fixed_state *state, void *memory,
                         size_t bytes);

/* Do one step, also beyond the scene's end. Returns WH_OK; or WH_E_ARGUMENT for a state that was not started. */
wh_status wh_fixed_step(const wh_fixed_scene *scene, wh_fixed_state *state);

/* Returns a hash of steps, saturations, angles and reals, equal on all machines; 0 for a state that was not started. */
uint64_t wh_fixed_hash(const wh_fixed_scene *scene, const wh_fixed_state *state);

/* Convert in floating point; no step calls these functions. wh_fixed_of() rounds value 2^bits to the nearest integer,
 * ties away from zero, and limits the integer to low..high. NaN gives `low`. *saturated increases for NaN, and if value
 * 2^bits is beyond low..high by more than 1 (float: 1 plus round-off). */
int32_t wh_fixed_of(const wh_fixed_format *format, wh_real value, uint32_t *saturated);
wh_real wh_fixed_to(const wh_fixed_format *format, int32_t number);

/* Read or write real i in SI units, or read angle i in unwrapped radians. For a state that was not started, reading
 * returns 0 and writing does nothing. NaN is not written. */
wh_real wh_fixed_real(const wh_fixed_scene *scene, const wh_fixed_state *state, unsigned i);
wh_real wh_fixed_angle(const wh_fixed_scene *scene, const wh_fixed_state *state, unsigned i);
void wh_fixed_set_real(const wh_fixed_scene *scene, wh_fixed_state *state, unsigned i,
                       wh_real value);

/* Set input i: wh_fixed_set_input() to a value in SI units, wh_fixed_set_raw_input() to an integer in the input's
 * format. A value beyond the range sets the nearer end, counts as saturated, and returns WH_E_ARGUMENT. NaN, or an
 * index i without an input, returns WH_E_ARGUMENT and changes nothing. */
wh_status wh_fixed_set_input(const wh_fixed_scene *scene, wh_fixed_state *state, unsigned i,
                             wh_real value);
wh_status wh_fixed_set_raw_input(const wh_fixed_scene *scene, wh_fixed_state *state, unsigned i,
                                 int32_t number);

WH_C_END

#endif

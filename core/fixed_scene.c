/* fixed_scene.c: start, step and hash of runs in fixed point, and conversions from and to reals. */
#include "fixed_scene.h"

#include "hash.h"

wh_status wh_fixed_start(const wh_fixed_scene *scene, wh_fixed_state *state, void *memory,
                         size_t bytes) {
    struct behind_a_byte {
        char byte;
        int64_t angle;
    };
    if (state != NULL) {
        state->real = NULL; /* not started yet */
    }
    if (scene == NULL || state == NULL ||
        (uintptr_t)memory % offsetof(struct behind_a_byte, angle) != 0) {
        return WH_E_ARGUMENT;
    }
    const size_t numbers = (size_t)scene->reals + scene->inputs;
    if (memory == NULL || bytes < WH_FIXED_BYTES(scene->angles, numbers)) {
        return WH_E_MEMORY;
    }
    state->steps = 0;
    state->saturated = 0;
    state->angle = memory;
    state->real = (int32_t *)(void *)(state->angle + scene->angles);
    state->input = state->real + scene->reals;
    for (unsigned i = 0; i < scene->angles; i++) {
        state->angle[i] = scene->start_angle[i];
    }
    for (unsigned i = 0; i < scene->reals; i++) {
        state->real[i] = scene->start_real[i];
    }
    for (unsigned i = 0; i < scene->inputs; i++) {
        state->input[i] = scene->start_input[i];
    }
    return WH_OK;
}

wh_status wh_fixed_step(const wh_fixed_scene *scene, wh_fixed_state *state) {
    if (state->real == NULL) {
        return WH_E_ARGUMENT;
    }
    return scene->advance(scene, state);
}

uint64_t wh_fixed_hash(const wh_fixed_scene *scene, const wh_fixed_state *state) {
    uint64_t hash = wh_hash_u64(WH_HASH_START, state->steps);
    if (state->real == NULL) {
        return 0;
    }
    hash = wh_hash_u64(hash, state->saturated);
    for (unsigned i = 0; i < scene->angles; i++) {
        hash = wh_hash_u64(hash, (uint64_t)state->angle[i]);
    }
    for (unsigned i = 0; i < scene->reals; i++) {
        hash = wh_hash_u64(hash, (uint32_t)state->real[i]);
    }
    return hash;
}

/* Returns value * 2^bits. */
static wh_real scaled(wh_real value, int bits) {
    const wh_real by = bits < 0 ? WH_R(0.5) : WH_R(2.0);
    for (int left = bits < 0 ? -bits : bits; left > 0; left--) {
        value *= by;
    }
    return value;
}

int32_t wh_fixed_of(const wh_fixed_format *format, wh_real value, uint32_t *saturated) {
    const wh_real number = scaled(value, format->bits);
    const wh_real high = (wh_real)format->high; /* if wh_real is float, this rounds by up to 64 */
    const wh_real low = (wh_real)format->low;
    const wh_real place = WH_DOUBLE ? WH_R(0.0) : WH_R(0x1p-23); /* relative round-off of `high` */
    if (!(number > low)) {
        *saturated += number >= low - (WH_R(1.0) + place * WH_ABS(low)) ? 0U : 1U;
        return format->low;
    }
    if (number >= high) {
        *saturated += number <= high + (WH_R(1.0) + place * WH_ABS(high)) ? 0U : 1U;
        return format->high;
    }
    /* a float of 2^23 or more is an integer, which adding 0.5 could change */
    const wh_real half = WH_DOUBLE || WH_ABS(number) < WH_R(0x1p23) ? WH_R(0.5) : WH_R(0.0);
    const int32_t near = (int32_t)(number < WH_R(0.0) ? number - half : number + half);
    return wh_fixed_limit(near, format->low, format->high, saturated);
}

wh_real wh_fixed_to(const wh_fixed_format *format, int32_t number) {
    return scaled((wh_real)number, -format->bits);
}

wh_real wh_fixed_real(const wh_fixed_scene *scene, const wh_fixed_state *state, unsigned i) {
    return state->real == NULL ? WH_R(0.0) : wh_fixed_to(&scene->format[i], state->real[i]);
}

wh_real wh_fixed_angle(const wh_fixed_scene *scene, const wh_fixed_state *state, unsigned i) {
    (void)scene;
    const int64_t angle = state->real == NULL ? 0 : state->angle[i];
    const wh_real turns = (wh_real)(int32_t)(angle >> 32);
    const wh_real part = (wh_real)(uint32_t)angle * WH_R(0x1p-32);
    return (turns + part) * WH_R(6.283185307179586477);
}

void wh_fixed_set_real(const wh_fixed_scene *scene, wh_fixed_state *state, unsigned i,
                       wh_real value) {
    if (state->real != NULL && value == value) { /* not NaN */
        state->real[i] = wh_fixed_of(&scene->format[i], value, &state->saturated);
    }
}

wh_status wh_fixed_set_input(const wh_fixed_scene *scene, wh_fixed_state *state, unsigned i,
                             wh_real value) {
    const uint32_t before = state->saturated;
    if (state->real == NULL || i >= scene->inputs || !(value == value)) { /* NaN */
        return WH_E_ARGUMENT;
    }
    state->input[i] = wh_fixed_of(&scene->format[scene->reals + i], value, &state->saturated);
    return state->saturated == before ? WH_OK : WH_E_ARGUMENT;
}

wh_status wh_fixed_set_raw_input(const wh_fixed_scene *scene, wh_fixed_state *state, unsigned i,
                                 int32_t number) {
    const uint32_t before = state->saturated;
    if (state->real == NULL || i >= scene->inputs) {
        return WH_E_ARGUMENT;
    }
    const wh_fixed_format *f = &scene->format[scene->reals + i];
    state->input[i] = wh_fixed_limit(number, f->low, f->high, &state->saturated);
    return state->saturated == before ? WH_OK : WH_E_ARGUMENT;
}

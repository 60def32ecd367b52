/* worst.c: the largest number of instructions of a step over random states, for each scene with contacts.
 *
 * Each scene makes WORST_STEPS steps for each of WORST_SEEDS seeds. Every RUN steps, the state and the inputs become
 * random. The counter reports one number for each scene and seed (count_plugin.c, every=WORST_STEPS). The program
 * prints lines "count", as bench.c does, and for each scene two limits of contact.h:
 *
 *     declared NAME WH_CONTACT_EVALUATIONS WH_CONTACT_SIGNALS */
#include "boards/programs/counted.h"
#include "core/scene.h"

#ifndef WORST_STEPS
#define WORST_STEPS 1000000U
#endif
#ifndef WORST_SEEDS
#define WORST_SEEDS 1U
#endif
#define RUN 32U

static uint32_t seed;

/* Returns a random number of 32 bits (Marsaglia, Xorshift RNGs, 2003). */
static uint32_t next(void) {
    seed ^= seed << 13;
    seed ^= seed >> 17;
    seed ^= seed << 5;
    return seed;
}

/* Returns a random number between -size and size. */
static wh_real within(wh_real size) {
    return size * ((wh_real)(int32_t)next() / WH_R(2147483648.0));
}

static void throw_state(const wh_scene *scene, wh_state *state) {
    const unsigned rates = (scene->reals + scene->angles) / 2U;
    const unsigned linears = scene->reals - rates;
    for (unsigned i = 0; i < scene->angles; i++) {
        state->angle[i] = wh_angle_from_rad(within(WH_R(6.3)));
    }
    for (unsigned i = 0; i < rates; i++) {
        wh_real *rate = &state->real[linears + i];
        *rate = *rate * within(WH_R(2.0)) + within(WH_R(0.05));
        if (!(WH_ABS(*rate) < WH_R(1e3))) {
            *rate = within(WH_R(1.0));
        }
        if (i >= scene->angles) {
            state->real[i - scene->angles] += *rate * within(WH_R(8.0) * scene->step_s);
        }
    }
    for (unsigned i = 0; i < scene->inputs; i++) {
        state->input[i] = scene->start_input[i] * within(WH_R(4.0));
    }
    for (unsigned i = 0; i < scene->contacts; i++) {
        state->contacts->mode[i] = WH_UNSET;
    }
}

static bool run(const wh_scene *scene, uint32_t first_seed, unsigned group) {
    wh_state state;
    seed = first_seed * 2654435761U; /* near seeds give unlike sequences */
    for (unsigned i = 0; i < WORST_STEPS; i++) {
        if (i % 8192U == 0 && wh_scene_start(scene, &state, memory, sizeof memory) != WH_OK) {
            return false;
        }
        if (i % RUN == 0) {
            throw_state(scene, &state);
        }
        wh_count_begin();
        const wh_status status = wh_scene_step(scene, &state);
        wh_count_end();
        if (status != WH_OK) { /* the random state was impossible */
            (void)wh_scene_start(scene, &state, memory, sizeof memory);
        }
    }
    say_counted(scene->name, wh_methods[scene->method].word,
                scene->compensated ? "-compensated" : "", group, group);
    return true;
}

int main(void) {
    board_start();
    for (unsigned i = 0; i < WORST_STEPS; i++) {
        wh_count_begin();
        wh_count_end();
    }
    unsigned group = 1;
    bool all = true;
    for (unsigned i = 0; i < wh_scene_count; i++) {
        if (wh_scenes[i]->contacts == 0) {
            continue;
        }
        line_of("declared", wh_scenes[i]->name);
        line_number(wh_scene_bounds[i].evaluations);
        line_number(wh_scene_bounds[i].signals);
        line_end();
        for (uint32_t s = 1; s <= WORST_SEEDS; s++) {
            all = run(wh_scenes[i], s, group++) && all;
        }
    }
    return all ? 0 : 1;
}

/* step_cycles.h: least, median and largest number of cycles of a scene's steps, if the processor counts cycles. */
#ifndef PROGRAMS_STEP_CYCLES_H
#define PROGRAMS_STEP_CYCLES_H

#include "boards/board.h"
#include "core/scene.h"

/* Largest number of stored steps, for the median; 1 on an AVR, which counts no cycles. */
#ifdef __AVR__
#define STEP_CYCLES_KEPT 1U
#else
#define STEP_CYCLES_KEPT 255U
#endif

typedef struct step_cycles {
    uint32_t nothing; /* cycles of an empty measurement */
    uint32_t least;
    uint32_t most;
    unsigned kept;
    uint32_t sorted[STEP_CYCLES_KEPT];
} step_cycles;

static inline void step_cycles_start(step_cycles *c) {
    const uint32_t before = board_cycles();
    *c = (step_cycles){.nothing = board_cycles() - before, .least = UINT32_MAX};
}

/* Does one step and counts its cycles. If `keep`, stores the count for the median. */
static inline wh_status step_counted(step_cycles *c, const wh_scene *scene, wh_state *state,
                                     bool keep) {
    const uint32_t before = board_cycles();
    const wh_status status = wh_scene_step(scene, state);
    const uint32_t taken = board_cycles() - before - c->nothing;
    c->least = taken < c->least ? taken : c->least;
    c->most = taken > c->most ? taken : c->most;
    if (keep && c->kept < STEP_CYCLES_KEPT) {
        unsigned place = c->kept++;
        for (; place > 0 && c->sorted[place - 1U] > taken; place--) {
            c->sorted[place] = c->sorted[place - 1U];
        }
        c->sorted[place] = taken;
    }
    return status;
}

/* Returns the median of the stored counts. At least one must be stored. */
static inline uint32_t step_cycles_median(const step_cycles *c) {
    return c->sorted[(c->kept - 1U) / 2U];
}

#endif

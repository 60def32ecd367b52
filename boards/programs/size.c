/* size.c: the smallest firmware around one scene, whose size is told: it steps, and computes the outputs.
 *
 * Built once a scene with PRICE_SCENE its name, PRICE_WORDS the eight-byte words of its state and
 * PRICE_OUTPUTS how many outputs it has, at least 1. It is linked, never run. */
#include "boards/board.h"
#include "core/scene.h"

#ifndef PRICE_SCENE
#define PRICE_SCENE rig_fixed
#define PRICE_WORDS 16
#define PRICE_OUTPUTS 4
#endif

extern const wh_scene PRICE_SCENE;

static uint64_t memory[PRICE_WORDS];
static wh_real output[PRICE_OUTPUTS];

int main(void) {
    wh_state state;
    board_start();
    wh_status status = wh_scene_start(&PRICE_SCENE, &state, memory, sizeof memory);
    while (status == WH_OK && state.steps < PRICE_SCENE.steps) {
        status = wh_scene_step(&PRICE_SCENE, &state);
        if (PRICE_SCENE.observe != NULL) {
            PRICE_SCENE.observe(&PRICE_SCENE, &state, output);
        }
    }
    return status == WH_OK && output[0] < WH_R(1e30) ? 0 : 1;
}

/* size.c: the smallest firmware that steps one scene and computes its outputs. The build measures its size and
 * never runs it. PRICE_SCENE is the scene's name (FIXED_SCENE if it is in fixed point). The compiler's option -include
 * gives the scene's header. */
#include "boards/board.h"
#include "core/fixed_scene.h"
#include "core/scene.h"

#define JOIN(scene, kind) scene##kind
#define OF(scene, kind) JOIN(scene, kind)

#ifdef FIXED_SCENE
static uint64_t memory[OF(FIXED_SCENE, _MEMORY_WORDS)];

int main(void) {
    wh_fixed_state state;
    board_start();
    wh_status status = wh_fixed_start(&FIXED_SCENE, &state, memory, sizeof memory);
    while (status == WH_OK && state.steps < FIXED_SCENE.steps) {
        status = wh_fixed_step(&FIXED_SCENE, &state);
    }
    return status == WH_OK && state.saturated == 0 ? 0 : 1;
}
#else
#ifndef PRICE_SCENE
#include "build/gen/rig_fixed.h"
#define PRICE_SCENE rig_fixed
#endif
#define COUNT(kind) OF(PRICE_SCENE, kind)

static uint64_t memory[WH_STATE_WORDS(COUNT(_ANGLES), COUNT(_REALS), COUNT(_INPUTS)) +
                       WH_CONTACT_WORDS(COUNT(_CONTACTS)) +
                       WH_LEDGER_WORDS(COUNT(_ENTRIES), 2U * COUNT(_ACCOUNTS))];
static wh_real output[COUNT(_OUTPUTS) > 0 ? COUNT(_OUTPUTS) : 1];

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
#endif

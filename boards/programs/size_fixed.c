/* size_fixed.c: the smallest firmware around one scene in fixed point, to measure its size (size.c does this for
 * reals). It is built once for each scene, with FIXED_SCENE as the scene's name, and with the scene's header included
 * first. The program is linked, never run. */
#include "boards/board.h"
#include "core/fixed_scene.h"

#ifndef FIXED_SCENE
int main(void) { return 1; } /* the program was built without a scene */
#else
#define JOIN(scene, kind) scene##kind
#define OF(scene, kind) JOIN(scene, kind)

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
#endif

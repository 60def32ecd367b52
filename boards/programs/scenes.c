/* scenes.c: runs every generated scene to its end and prints the hash of its last state:
 *
 *     scene NAME steps N hash 0x0123456789abcdef ok
 *
 * The PC and every board must print the same lines. A diverged scene's line has the hash of the last good state, and
 * the error instead of ok. Without scenes the program fails. SCENES_FIXED=1: the scenes are in fixed point.
 * SCENE_STEPS_MOST limits the number of steps of each scene, for slow machines. */
#include "boards/board.h"
#include "boards/programs/table.h"
#include "core/text.h"

#ifndef SCENE_STEPS_MOST
#define SCENE_STEPS_MOST UINT64_MAX
#endif

#if SCENES_FIXED
typedef wh_fixed_scene a_scene;
typedef wh_fixed_state a_state;
#define all_scenes wh_fixed_scenes
#define scene_start wh_fixed_start
#define scene_step wh_fixed_step
#define scene_hash wh_fixed_hash
#else
typedef wh_scene a_scene;
typedef wh_state a_state;
#define all_scenes wh_scenes
#define scene_start wh_scene_start
#define scene_step wh_scene_step
#define scene_hash wh_scene_hash
#endif

static uint64_t memory[WH_SCENE_WORDS];

static void run_to_the_end(const a_scene *scene) {
    char line[200];
    wh_text text;
    a_state state;
    wh_text_start(&text, line, sizeof line);
    wh_text_add(&text, "scene ");
    wh_text_add(&text, scene->name);

    const uint64_t steps =
        scene->steps < SCENE_STEPS_MOST ? scene->steps : (uint64_t)SCENE_STEPS_MOST;
    wh_status status = scene_start(scene, &state, memory, sizeof memory);
    if (status == WH_OK) {
        while (state.steps < steps && status == WH_OK) {
            status = scene_step(scene, &state);
        }
        wh_text_add(&text, " steps ");
        wh_text_add_unsigned(&text, state.steps);
        wh_text_add(&text, " hash 0x");
        wh_text_add_hex(&text, scene_hash(scene, &state), 16);
    }
    wh_text_add_char(&text, ' ');
    wh_text_add(&text, wh_status_text(status));
    wh_text_add_char(&text, '\n');
    hal_console_write(text.bytes, text.length);
}

int main(void) {
    board_start();
    for (unsigned i = 0; i < wh_scene_count; i++) {
        run_to_the_end(all_scenes[i]);
    }
    board_exit(wh_scene_count > 0 ? 0 : 1);
}

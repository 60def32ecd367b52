/* to_the_end.h: runs scenes to their end and prints the hash of each scene's last state on a line (scenes.c).
 * SCENES_FIXED=1: the scenes are in fixed point (fixed_scenes.c). SCENE_STEPS_MOST, if defined, ends every scene after
 * this number of steps, for slow machines. */
#ifndef BOARDS_PROGRAMS_TO_THE_END_H
#define BOARDS_PROGRAMS_TO_THE_END_H

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

static inline void run_to_the_end(const a_scene *scene) {
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

/* Runs all scenes. Returns the program's exit status. */
static inline int run_all_to_the_end(void) {
    board_start();
    for (unsigned i = 0; i < wh_scene_count; i++) {
        run_to_the_end(all_scenes[i]);
    }
    return wh_scene_count > 0 ? 0 : 1;
}

#endif

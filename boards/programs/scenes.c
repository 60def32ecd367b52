/* scenes.c: runs every generated scene to its end and prints the hash of its last state:
 *
 *     scene NAME steps N hash 0x0123456789abcdef ok
 *
 * The same lines must come out on the PC and on every board. A scene that diverges says so in the
 * last words, with the hash of its last good state; the others still run. Fails if none is there.
 *
 * SCENE_STEPS_MOST ends every scene after so many steps, for what is slow. */
#include "boards/board.h"
#include "boards/programs/table.h"
#include "core/scene.h"
#include "core/text.h"

#ifndef SCENE_STEPS_MOST
#define SCENE_STEPS_MOST UINT64_MAX
#endif

static uint64_t memory[WH_SCENE_WORDS];

static void run(const wh_scene *scene) {
    char line[200];
    wh_text text;
    wh_state state;
    wh_text_start(&text, line, sizeof line);
    wh_text_add(&text, "scene ");
    wh_text_add(&text, scene->name);

    const uint64_t steps =
        scene->steps < SCENE_STEPS_MOST ? scene->steps : (uint64_t)SCENE_STEPS_MOST;
    wh_status status = wh_scene_start(scene, &state, memory, sizeof memory);
    if (status == WH_OK) {
        while (state.steps < steps && status == WH_OK) {
            status = wh_scene_step(scene, &state);
        }
        wh_text_add(&text, " steps ");
        wh_text_add_unsigned(&text, state.steps);
        wh_text_add(&text, " hash 0x");
        wh_text_add_hex(&text, wh_scene_hash(scene, &state), 16);
    }
    wh_text_add_char(&text, ' ');
    wh_text_add(&text, wh_status_text(status));
    wh_text_add_char(&text, '\n');
    hal_console_write(text.bytes, text.length);
}

int main(void) {
    board_start();
    for (unsigned i = 0; i < wh_scene_count; i++) {
        run(wh_scenes[i]);
    }
    board_exit(wh_scene_count > 0 ? 0 : 1);
}

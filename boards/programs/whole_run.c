/* whole_run.c: counts every step of a scene's run, because a few steps do not show the cost of steps with events.
 * Prints
 *
 *     run NAME STEPS       all steps were made
 *     stack NAME BYTES     deepest stack of the program during the run's steps
 *     failed NAME STATUS   a step failed
 *
 * The counter reports the largest number of instructions of a step in each interval of RUN_EVERY steps (count_plugin.c,
 * every=). Interval 0 is empty. */
#include "boards/programs/counted.h"
#include "core/scene.h"

#ifndef RUN_EVERY
#define RUN_EVERY 100U
#endif

static void say_number(const char *word, const char *name, uint64_t number) {
    line_of(word, name);
    line_number((int64_t)number);
    line_end();
}

static bool run(const wh_scene *scene) {
    wh_state state;
    wh_status status = wh_scene_start(scene, &state, memory, sizeof memory);
    board_stack_paint();
    while (status == WH_OK && state.steps < scene->steps) {
        wh_count_begin();
        status = wh_scene_step(scene, &state);
        wh_count_end();
    }
    if (status != WH_OK) {
        line_of("failed", scene->name);
        line_word(wh_status_text(status));
        line_end();
        return false;
    }
    say_number("stack", scene->name, board_stack_used_bytes());
    say_number("run", scene->name, state.steps);
    return true;
}

int main(void) {
    board_start();
    for (unsigned i = 0; i < RUN_EVERY; i++) {
        wh_count_begin();
        wh_count_end();
    }
    return wh_scene_count == 1U && run(wh_scenes[0]) ? 0 : 1;
}

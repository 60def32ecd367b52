/* fixed.c: counts single steps of one scene in fixed point, and prints the hash of the last state:
 *
 *     fixed NAME FIRST LAST hash 0x... saturated N     intervals FIRST to LAST have one step each
 *     stack NAME BYTES                                 deepest stack of the program during those steps
 *     count NAME rk4 fixed FIRST LAST                  the intervals again, in the format of bench.c
 *
 * Interval 0 is empty. FIXED_SCENE is the scene's name; the scene's header is included first. */
#include "boards/board.h"
#include "core/fixed_scene.h"
#include "core/text.h"

#ifndef FIXED_SCENE
int main(void) { return 1; } /* built without a scene */
#else
#ifndef COUNTED_STEPS
#define COUNTED_STEPS 100U
#endif
#define WARM_STEPS 20U

#define JOIN(scene, kind) scene##kind
#define OF(scene, kind) JOIN(scene, kind)

static uint64_t memory[OF(FIXED_SCENE, _MEMORY_WORDS)];

void wh_count_begin(void);
void wh_count_end(void);

/* Empty: the plugin counts the instructions between the calls. The operands differ, so that GCC keeps two functions. */
__attribute__((noinline)) void wh_count_begin(void) { __asm__ volatile("" : : "i"(1) : "memory"); }
__attribute__((noinline)) void wh_count_end(void) { __asm__ volatile("" : : "i"(2) : "memory"); }

int main(void) {
    char bytes[240];
    wh_text text;
    wh_fixed_state state;
    board_start();
    if (wh_fixed_start(&FIXED_SCENE, &state, memory, sizeof memory) != WH_OK) {
        return 1;
    }
    wh_count_begin();
    wh_count_end();
    for (unsigned i = 0; i < WARM_STEPS; i++) {
        (void)wh_fixed_step(&FIXED_SCENE, &state);
    }
    board_stack_paint();
    for (unsigned i = 0; i < COUNTED_STEPS; i++) {
        wh_count_begin();
        (void)wh_fixed_step(&FIXED_SCENE, &state);
        wh_count_end();
    }
    const unsigned stack = board_stack_used_bytes();
    wh_text_start(&text, bytes, sizeof bytes);
    wh_text_add(&text, "fixed ");
    wh_text_add(&text, FIXED_SCENE.name);
    wh_text_add(&text, " 1 ");
    wh_text_add_unsigned(&text, COUNTED_STEPS);
    wh_text_add(&text, " hash 0x");
    wh_text_add_hex(&text, wh_fixed_hash(&FIXED_SCENE, &state), 16);
    wh_text_add(&text, " saturated ");
    wh_text_add_unsigned(&text, state.saturated);
    wh_text_add(&text, "\nstack ");
    wh_text_add(&text, FIXED_SCENE.name);
    wh_text_add_char(&text, ' ');
    wh_text_add_unsigned(&text, stack);
    wh_text_add(&text, "\ncount ");
    wh_text_add(&text, FIXED_SCENE.name);
    wh_text_add(&text, " rk4 fixed 1 ");
    wh_text_add_unsigned(&text, COUNTED_STEPS);
    wh_text_add_char(&text, '\n');
    hal_console_write(text.bytes, text.length);
    return 0;
}
#endif

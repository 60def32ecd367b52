/* guard.h: common parts of the programs that touch the strip of memory below a board's stack (guard.sh). An access
 * to the strip must not return. */
#ifndef TESTS_BOARDS_GUARD_H
#define TESTS_BOARDS_GUARD_H

#include "boards/board.h"
#include "boards/shared/metal.h"
#include "core/text.h"

static inline void say(const char *words) {
    char bytes[96];
    wh_text line;
    wh_text_start(&line, bytes, sizeof bytes);
    wh_text_add(&line, words);
    wh_text_add_char(&line, '\n');
    hal_console_write(line.bytes, line.length);
}

/* The word above the strip belongs to the stack, so a store there must work. Else the test would pass on a board on
 * which every store faults. */
static inline void store_above_strip(void) {
    board_start();
    volatile uint32_t *const last = board_stack_limit;
    *last = 0x12345678U;
    say(*last == 0x12345678U ? "the stack's last word holds"
                             : "the stack's last word does not hold");
}

static inline void store_into_strip(unsigned word) {
    volatile uint32_t *const strip = board_stack_guard;
    strip[word] = 1U;
    say("went on after a store into the strip");
}

#endif

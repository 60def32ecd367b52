/* guard_top.c: a store into the strip's highest word, next to the stack. */
#include "tests/boards/guard.h"

int main(void) {
    store_above_strip();
    store_into_strip((unsigned)board_words(board_stack_guard, board_stack_limit) - 1U);
    return 0;
}

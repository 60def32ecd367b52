/* guard_top.c: stores into the highest word of the strip, next to the stack. */
#include "tests/boards/guard.h"

int main(void) {
    store_above_strip();
    store_into_strip((unsigned)board_words(board_stack_guard, board_stack_limit) - 1U);
    return 0;
}

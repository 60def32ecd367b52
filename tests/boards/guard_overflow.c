/* guard_overflow.c: a stack frame that ends inside the strip, written from its top downwards, as calls do. */
#include "tests/boards/guard.h"

__attribute__((noinline)) static void fill(unsigned bytes) {
    volatile unsigned char frame[bytes];
    for (unsigned i = bytes; i-- > 0;) {
        frame[i] = 1;
    }
    say(frame[0] == 1 ? "went on after the stack was full" : "the stack does not hold");
}

int main(void) {
    store_above_strip();
    fill(board_stack_size_bytes() + 64U);
    return 0;
}

/* stack.c: the used part of the stack (board.h). A pattern fills the free stack, and use overwrites the pattern. */
#include "boards/shared/metal.h"

#include "boards/board.h"

#define PAINT 0x57A7C0DEU

static const uint32_t *stack_pointer(void) {
    const uint32_t *now;
#if defined(__riscv)
    __asm__ volatile("mv %0, sp" : "=r"(now));
#else
    __asm__ volatile("mov %0, sp" : "=r"(now));
#endif
    return now;
}

void board_stack_paint(void) {
    volatile uint32_t *stack = board_stack_limit;
    const uint32_t unused = board_words(board_stack_limit, stack_pointer());
    for (uint32_t i = 0; i < unused; i++) {
        stack[i] = PAINT;
    }
}

unsigned board_stack_used_bytes(void) {
    const volatile uint32_t *stack = board_stack_limit;
    const uint32_t all = board_words(board_stack_limit, board_stack_top);
    uint32_t unused = 0;
    while (unused < all && stack[unused] == PAINT) {
        unused++;
    }
    return (unsigned)((all - unused) * sizeof *stack);
}

unsigned board_stack_size_bytes(void) {
    return (unsigned)(board_words(board_stack_limit, board_stack_top) * sizeof(uint32_t));
}

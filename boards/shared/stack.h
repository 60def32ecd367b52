/* stack.h: the stack of a bare-metal board. Its family's linker script lays it out: a strip that is nobody's, the stack,
 * and behind it another for whoever reports a fault. */
#ifndef BOARDS_SHARED_STACK_H
#define BOARDS_SHARED_STACK_H

#include <stdint.h>

extern uint32_t board_stack_guard[]; /* 256 bytes below the stack, nobody's */
extern uint32_t board_stack_limit[]; /* lowest word of the stack */
extern uint32_t board_stack_top[];   /* one past its highest word */
extern uint32_t board_fault_stack_top[];

/* Words from `low` up to `high`: two symbols of the linker script, which to C are two objects. */
static inline uint32_t board_words(const uint32_t *low, const uint32_t *high) {
    return (uint32_t)(((uintptr_t)high - (uintptr_t)low) / sizeof *low);
}

#endif

/* stack.c: use of the stack on an AVR. The stack may grow down to the variables; the chip has no guard. */
#include "stack.h"

#include <avr/io.h>

#include "boards/board.h"

extern uint8_t _end[]; /* end of the variables, from the linker */
#define PAINT 0xA5U
#define LOWEST 4U

void board_stack_paint(void) {
    for (volatile uint8_t *at = _end; (uintptr_t)at < SP - 2U; at++) {
        *at = PAINT;
    }
}

unsigned board_stack_used_bytes(void) {
    const volatile uint8_t *at = _end;
    while ((uintptr_t)at < RAMEND && *at == PAINT) {
        at++;
    }
    return (unsigned)(RAMEND + 1U - (uintptr_t)at);
}

unsigned board_stack_size_bytes(void) { return (unsigned)(RAMEND + 1U - (uintptr_t)_end); }

bool avr_stack_is_whole(void) {
    const volatile uint8_t *at = _end;
    for (uint8_t i = 0; i < LOWEST; i++) {
        if (at[i] != PAINT) {
            return false;
        }
    }
    return true;
}

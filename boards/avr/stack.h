/* stack.h: a check of the stack, for which an AVR has no hardware. */
#ifndef BOARDS_AVR_STACK_H
#define BOARDS_AVR_STACK_H

#include <stdbool.h>

/* True if the bytes between stack and variables still have their paint. */
bool avr_stack_is_whole(void);

#endif

/* stack.h: a check of the stack, which AVR hardware does not have. */
#ifndef BOARDS_AVR_STACK_H
#define BOARDS_AVR_STACK_H

#include <stdbool.h>

/* True if the lowest bytes of the stack, the last before the variables, still have their paint. */
bool avr_stack_is_whole(void);

#endif

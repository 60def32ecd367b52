/* stack.h: what no part of an AVR looks at. */
#ifndef BOARDS_AVR_STACK_H
#define BOARDS_AVR_STACK_H

#include <stdbool.h>

/* The lowest bytes of the stack, the last before the variables, are as they were painted. */
bool avr_stack_is_whole(void);

#endif

/* interrupts.h: Ctrl-C and its like end what is under way in order, with what it has so far. */
#ifndef BASE_INTERRUPTS_H
#define BASE_INTERRUPTS_H

#include <signal.h>

/* Set by the first SIGINT or SIGTERM; a second ends the program at once, whatever it waits for. */
extern volatile sig_atomic_t interrupted;

/* From here on. What is read and written goes on over it: no record is cut. */
void interrupts_catch(void);

/* The same of what waits for another program, which an interrupt is to wake; and when the terminal goes away. */
void interrupts_catch_waiting(void);

#endif

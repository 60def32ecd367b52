/* interrupts.c: see interrupts.h. */
#include "interrupts.h"

#include <stddef.h>

volatile sig_atomic_t interrupted;

#ifndef WHIRL_NO_SYSTEM /* WASI has no signals */
static void on_interrupt(int signal_number) {
    (void)signal_number;
    interrupted = 1;
}

static void catch_with(int flags) {
    struct sigaction action = {.sa_handler = on_interrupt, .sa_flags = flags};
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    if ((flags & SA_RESTART) == 0) {
        sigaction(SIGHUP, &action, NULL);
    }
}

void interrupts_catch(void) { catch_with(SA_RESTART | (int)SA_RESETHAND); }

void interrupts_catch_waiting(void) { catch_with((int)SA_RESETHAND); }
#endif

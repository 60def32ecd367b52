/* reset_words.h: each family's record of a fault, for hal_reset_words(). */
#ifndef BOARDS_SHARED_RESET_WORDS_H
#define BOARDS_SHARED_RESET_WORDS_H

#include <stdint.h>

#include "core/text.h"

typedef struct board_fault_when {
    uint32_t ticks;  /* time of the fault on the board's clock, which restarts at each start */
    uint32_t state;  /* last argument of hal_reset_mark() */
    uint32_t faults; /* number of faults since power-on, including this one */
} board_fault_when;

/* Adds to `text` a description of the fault that caused the reset. Each family implements this function. */
board_fault_when board_fault_answer(wh_text *text);

#endif

/* reset_words.h: what a family's fault leaves of itself, for hal_reset_words() of reset_words.c. */
#ifndef BOARDS_SHARED_RESET_WORDS_H
#define BOARDS_SHARED_RESET_WORDS_H

#include <stdint.h>

#include "core/text.h"

typedef struct board_fault_when {
    uint32_t ticks;  /* of the board's clock, which begins anew with each start */
    uint32_t state;  /* hal_reset_mark()'s last */
    uint32_t faults; /* so many since the power came, this one included */
} board_fault_when;

/* The family's: adds what the fault was that hal_reset_cause() tells of, and returns when. */
board_fault_when board_fault_told(wh_text *text);

#endif

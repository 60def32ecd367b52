/* kept.h: what outlives a reset (hal/reset.h), in memory that nobody clears (.noinit of boards/shared/sections.ld). */
#ifndef BOARDS_CORTEXM_KEPT_H
#define BOARDS_CORTEXM_KEPT_H

#include <stdbool.h>
#include <stdint.h>

#include "cortexm.h"

/* A fault's record. */
typedef struct board_fault_record {
    board_fault_facts facts;
    uint32_t ticks;  /* of the board's clock, which begins anew with each start */
    uint32_t state;  /* hal_reset_mark()'s last */
    uint32_t faults; /* so many since the power came, this one included */
    uint32_t crc;
} board_fault_record;

/* From the fault's handler. */
void board_kept_fault(const board_fault_facts *facts, uint32_t ticks);

/* What there is of the start before: once, when the program starts. The record is then no longer new. False: none. */
bool board_kept_take_fault(board_fault_record *record);

/* The power came: nothing of this, nor of boards/shared/remembered.c, is known any more. */
void board_kept_forget(void);

/* Anything at all of before: no power-on. */
bool board_kept_anything(void);

#endif

/* kept.h: data that survive a reset (hal/reset.h), in memory that is never cleared (.noinit of sections.ld). */
#ifndef BOARDS_CORTEXM_KEPT_H
#define BOARDS_CORTEXM_KEPT_H

#include <stdbool.h>
#include <stdint.h>

#include "cortexm.h"

/* A fault's record. */
typedef struct board_fault_record {
    board_fault_facts facts;
    uint32_t ticks;  /* of the board's clock, which restarts at each start */
    uint32_t state;  /* hal_reset_mark()'s last */
    uint32_t faults; /* faults since power-on, including this one */
    uint32_t crc;
} board_fault_record;

/* From the fault's handler. */
void board_kept_fault(const board_fault_facts *facts, uint32_t ticks);

/* Read the record from before the start: once, when the program starts. The record is then no longer new. False: none. */
bool board_kept_take_fault(board_fault_record *record);

/* Power-on: forget this, and the bytes of boards/shared/remembered.c. */
void board_kept_forget(void);

/* Do any data from before exist? Then this is no power-on. */
bool board_kept_anything(void);

#endif

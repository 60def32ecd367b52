/* kept.h: data that survive a reset (hal/reset.h), in memory that is never cleared (.noinit of sections.ld). */
#ifndef BOARDS_CORTEXM_KEPT_H
#define BOARDS_CORTEXM_KEPT_H

#include <stdbool.h>
#include <stdint.h>

#include "cortexm.h"

typedef struct board_fault_record {
    board_fault_facts facts;
    uint32_t ticks;  /* time of the fault; the board's clock restarts at each start */
    uint32_t state;  /* last argument of hal_reset_mark() */
    uint32_t faults; /* number of faults since power-on, including this one */
    uint32_t crc;
} board_fault_record;

/* Store the record of a fault. The fault handler calls this. */
void board_kept_fault(const board_fault_facts *facts, uint32_t ticks);

/* Read the record of a fault before this start. Only the first call after a fault finds it. Returns false if there is
 * no record. */
bool board_kept_take_fault(board_fault_record *record);

/* Call this after a power-on: it drops the record, and the bytes of boards/shared/remembered.c, which are then
 * random. */
void board_kept_forget(void);

/* True if data from before the start exist: then the start was no power-on. */
bool board_kept_anything(void);

#endif

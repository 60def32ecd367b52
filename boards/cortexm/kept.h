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
    uint32_t faults; /* number of faults since power-on */
    uint32_t crc;
} board_fault_record;

/* Stores the record of a fault, for the fault handler. */
void board_kept_fault(const board_fault_facts *facts, uint32_t ticks);

/* Reads the record of a fault before this start. Returns false if there is none; a second call finds none. */
bool board_kept_take_fault(board_fault_record *record);

/* Drops the record and the bytes of boards/shared/remembered.c: after a power-on they are random or out of date. */
void board_kept_forget(void);

/* True if valid data from before the start exist. They may also have survived a short power failure. */
bool board_kept_anything(void);

#endif

/* kept.c: a fault's record, in memory that a reset does not clear; its CRC-32 is valid only after a complete write. */
#include "kept.h"

#include <stddef.h>

#include "boards/shared/remembered.h"
#include "core/frame.h"

BOARD_KEPT static board_fault_record fault;

static uint32_t crc_of_fault(void) {
    return wh_frame_crc(BOARD_KEPT_CRC_START, (const uint8_t *)&fault,
                        offsetof(board_fault_record, crc));
}

static bool fault_holds(void) { return fault.crc == crc_of_fault(); }

static void seal(void) {
    board_kept_settle();
    fault.crc = crc_of_fault();
    board_kept_settle();
}

void board_kept_fault(const board_fault_facts *facts, uint32_t ticks) {
    const uint32_t before = fault_holds() ? fault.faults : 0U;
    fault.crc = ~fault.crc;
    board_kept_settle();
    fault.facts = *facts;
    fault.ticks = ticks;
    fault.state = board_kept_state();
    fault.faults = before + 1U;
    seal();
}

/* Writes nothing if the memory is valid and contains no fault, so that a reset seldom interrupts a write. */
bool board_kept_take_fault(board_fault_record *record) {
    const bool held = fault_holds();
    const bool there = held && fault.facts.exception != 0;
    if (there) {
        *record = fault;
    }
    if (!held) {
        fault.faults = 0; /* without a valid record, the count of faults restarts */
    }
    if (there || !held) {
        fault.facts.exception = 0;
        seal();
    }
    return there;
}

void board_kept_forget(void) {
    fault.faults = 0;
    fault.facts.exception = 0;
    seal();
    board_forget();
}

bool board_kept_anything(void) { return fault_holds() || board_remembers(); }

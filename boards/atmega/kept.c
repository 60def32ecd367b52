/* kept.c: a fault's record, in memory that a reset does not clear. */
#include <stddef.h>

#include "atmega.h"
#include "boards/shared/remembered.h"
#include "core/frame.h"

BOARD_KEPT static atmega_fault_record fault;

static uint16_t sum_of_fault(void) {
    return (uint16_t)(wh_frame_crc(BOARD_KEPT_CRC_START, &fault.kind,
                                   offsetof(atmega_fault_record, sum)));
}

static bool fault_holds(void) { return fault.sum == sum_of_fault(); }

static void seal(void) {
    board_kept_settle();
    fault.sum = sum_of_fault();
    board_kept_settle();
}

void atmega_keep_fault(atmega_fault_kind kind, uint32_t at, uint32_t ticks) {
    const uint16_t before = fault_holds() ? fault.faults : 0U;
    fault.sum = (uint16_t)~fault.sum;
    board_kept_settle();
    fault.kind = (uint8_t)kind;
    fault.at = at;
    fault.ticks = ticks;
    fault.state = board_kept_state();
    fault.faults = (uint16_t)(before + 1U);
    seal();
}

void atmega_forget(void) {
    fault.faults = 0;
    fault.kind = ATMEGA_FAULT_NONE;
    seal();
    board_forget();
}

bool atmega_take_fault(atmega_fault_record *record) {
    const bool there = fault_holds() && fault.kind != ATMEGA_FAULT_NONE;
    if (there) {
        *record = fault;
        fault.kind = ATMEGA_FAULT_NONE; /* the count of faults stays */
        seal();
    }
    return there;
}

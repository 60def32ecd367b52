/* kept.c: what outlives a reset: what the program remembers, twice, of which the older is written; and a fault's record.
 *
 * Memory holds what chance gave it when the power comes. What counts has the CRC-32 of its bytes behind it: of chance one in
 * 4e9 has. A reset in the middle of writing spoils one of the two, and the other has what was before. */
#include "kept.h"

#include <stddef.h>

#include "core/frame.h"
#include "hal/reset.h"

typedef struct kept_bytes {
    uint32_t sequence;
    uint32_t count;
    uint8_t bytes[HAL_REMEMBER_BYTES];
    uint32_t crc;
} kept_bytes;

#define KEPT __attribute__((section(".noinit")))
KEPT static kept_bytes slots[2];
KEPT static board_fault_record fault;
KEPT static uint32_t kept_state; /* by itself: it is written every control step */

/* So that memory that is all zeros is none. */
#define CRC_START 0x52494721U

static uint32_t crc_of(const void *bytes, unsigned count) {
    return wh_frame_crc(CRC_START, bytes, count);
}

/* Nothing of it may be left for later, or come before what stands before it. */
static void settle(void) { __asm__ volatile("dmb" ::: "memory"); }

static bool holds(const kept_bytes *slot) {
    return slot->count <= HAL_REMEMBER_BYTES &&
           slot->crc == crc_of(slot, offsetof(kept_bytes, crc));
}

static bool fault_holds(void) {
    return fault.crc == crc_of(&fault, offsetof(board_fault_record, crc));
}

/* Of two that hold the newer; NULL: neither does. */
static const kept_bytes *newest(void) {
    const bool first = holds(&slots[0]);
    const bool second = holds(&slots[1]);
    if (first && second) {
        return (int32_t)(slots[1].sequence - slots[0].sequence) > 0 ? &slots[1] : &slots[0];
    }
    return first ? &slots[0] : second ? &slots[1] : NULL;
}

void hal_remember(const void *bytes, unsigned count) {
    const uint8_t *from = bytes;
    const kept_bytes *last = newest();
    kept_bytes *to = last == &slots[0] ? &slots[1] : &slots[0];
    to->crc = ~to->crc; /* it does not hold while it is written */
    settle();
    to->sequence = last != NULL ? last->sequence + 1U : 0U;
    to->count = count < HAL_REMEMBER_BYTES ? count : HAL_REMEMBER_BYTES;
    for (unsigned i = 0; i < HAL_REMEMBER_BYTES; i++) {
        to->bytes[i] = i < to->count ? from[i] : 0;
    }
    settle();
    to->crc = crc_of(to, offsetof(kept_bytes, crc));
    settle();
}

unsigned hal_recall(void *bytes) {
    uint8_t *to = bytes;
    const kept_bytes *last = newest();
    const unsigned count = last != NULL ? (unsigned)last->count : 0U;
    for (unsigned i = 0; i < count; i++) {
        to[i] = last->bytes[i];
    }
    return count;
}

void hal_reset_mark(uint32_t now) { *(volatile uint32_t *)&kept_state = now; }

void board_kept_fault(const board_fault_facts *facts, uint32_t ticks) {
    const uint32_t before = fault_holds() ? fault.faults : 0U;
    fault.crc = ~fault.crc;
    settle();
    fault.facts = *facts;
    fault.ticks = ticks;
    fault.state = kept_state;
    fault.faults = before + 1U;
    settle();
    fault.crc = crc_of(&fault, offsetof(board_fault_record, crc));
    settle();
}

/* Written only where there is something to forget: a reset finds it whole at nearly any instant. */
bool board_kept_take_fault(board_fault_record *record) {
    const bool held = fault_holds();
    const bool there = held && fault.facts.exception != 0;
    if (there) {
        *record = fault;
    }
    if (there || !held) {
        fault.facts.exception = 0;
        fault.faults = held ? fault.faults : 0U; /* the count goes on */
        settle();
        fault.crc = crc_of(&fault, offsetof(board_fault_record, crc));
        settle();
    }
    return there;
}

bool board_kept_anything(void) { return fault_holds() || newest() != NULL; }

/* kept.c: what outlives a reset (hal/reset.h), in memory that nobody clears (.noinit): what the program remembers, twice, of which
 * the older is written; and a fault's record.
 *
 * Memory holds what chance gave it when the power comes. What is remembered has the CRC-32 of its bytes behind it: of chance one
 * in 4e9 has. A reset in the middle of writing spoils one of the two, and the other has what was before. */
#include <stddef.h>

#include "core/frame.h"
#include "hal/reset.h"

#include "atmega.h"

typedef struct kept_bytes {
    uint8_t sequence;
    uint8_t count;
    uint8_t bytes[HAL_REMEMBER_BYTES];
    uint32_t crc;
} kept_bytes;

#define KEPT __attribute__((section(".noinit")))
KEPT static kept_bytes slots[2];
KEPT static atmega_fault_record fault;
KEPT static uint32_t kept_state; /* by itself: it is written every control step */

/* So that memory that is all zeros is none. */
#define CRC_START 0x52494721U

/* Nothing of it may be left for later, or come before what stands before it. */
static void settle(void) { __asm__ volatile("" ::: "memory"); }

static uint32_t crc_of(const kept_bytes *slot) {
    return wh_frame_crc(CRC_START, &slot->sequence, offsetof(kept_bytes, crc));
}

static bool holds(const kept_bytes *slot) {
    return slot->count <= HAL_REMEMBER_BYTES && slot->crc == crc_of(slot);
}

/* Of two that hold the newer; NULL: neither does. */
static const kept_bytes *newest(void) {
    const bool first = holds(&slots[0]);
    const bool second = holds(&slots[1]);
    if (first && second) {
        return (int8_t)(slots[1].sequence - slots[0].sequence) > 0 ? &slots[1] : &slots[0];
    }
    return first ? &slots[0] : second ? &slots[1] : NULL;
}

void hal_remember(const void *bytes, unsigned count) {
    const uint8_t *from = bytes;
    const kept_bytes *last = newest();
    kept_bytes *to = last == &slots[0] ? &slots[1] : &slots[0];
    to->crc = ~to->crc; /* it does not hold while it is written */
    settle();
    to->sequence = last != NULL ? (uint8_t)(last->sequence + 1U) : 0U;
    to->count = (uint8_t)(count < HAL_REMEMBER_BYTES ? count : HAL_REMEMBER_BYTES);
    for (unsigned i = 0; i < HAL_REMEMBER_BYTES; i++) {
        to->bytes[i] = i < to->count ? from[i] : 0;
    }
    settle();
    to->crc = crc_of(to);
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

/* --- a fault's record ------------------------------------------------------------------------------- */

/* A sum will do: only what comes of a reset that is none of the power's is looked at. */
static uint16_t sum_of_fault(void) {
    return (uint16_t)(wh_frame_crc(CRC_START, &fault.kind, offsetof(atmega_fault_record, sum)));
}

static bool fault_holds(void) { return fault.sum == sum_of_fault(); }

void atmega_keep_fault(atmega_fault_kind kind, uint32_t at, uint32_t ticks) {
    const uint16_t before = fault_holds() ? fault.faults : 0U;
    fault.sum = (uint16_t)~fault.sum;
    settle();
    fault.kind = (uint8_t)kind;
    fault.at = at;
    fault.ticks = ticks;
    fault.state = kept_state;
    fault.faults = (uint16_t)(before + 1U);
    settle();
    fault.sum = sum_of_fault();
    settle();
}

bool atmega_take_fault(atmega_fault_record *record) {
    const bool there = fault_holds() && fault.kind != ATMEGA_FAULT_NONE;
    if (there) {
        *record = fault;
        fault.kind = ATMEGA_FAULT_NONE; /* the count goes on */
        settle();
        fault.sum = sum_of_fault();
        settle();
    }
    return there;
}

/* remembered.c: bytes that survive a reset (hal/reset.h), in memory that is never cleared.
 *
 * A write replaces the older of two copies, so that a reset during the write leaves the newer one. A valid copy ends
 * with the CRC-32 of its bytes: random content passes once in 4e9. After a power-on the caller drops both copies,
 * because the old content survives a short power failure. */
#include "remembered.h"

#include <stddef.h>

#include "core/frame.h"
#include "hal/reset.h"

/* as short as possible, because the CRC costs an 8-bit processor 150 cycles a byte */
typedef struct remembered {
    uint8_t sequence; /* one more than in the older copy, modulo 256 */
    uint8_t count;
    uint8_t bytes[HAL_REMEMBER_BYTES];
    uint32_t crc;
} remembered;

BOARD_KEPT static remembered slots[2];
/* Not in `remembered`, so that writing kept_state in every control step needs no CRC. */
BOARD_KEPT static uint32_t kept_state;

static uint32_t crc_of(const remembered *slot) {
    return wh_frame_crc(BOARD_KEPT_CRC_START, (const uint8_t *)slot,
                        offsetof(remembered, bytes) + HAL_REMEMBER_BYTES);
}

static bool holds(const remembered *slot) {
    return slot->count <= HAL_REMEMBER_BYTES && slot->crc == crc_of(slot);
}

/* Returns the newer valid copy, or NULL. */
static const remembered *newest(void) {
    const remembered *found = NULL;
    for (const remembered *slot = slots; slot < slots + 2; slot++) {
        if (holds(slot) &&
            (found == NULL || (int8_t)(uint8_t)(slot->sequence - found->sequence) > 0)) {
            found = slot;
        }
    }
    return found;
}

void hal_remember(const void *bytes, unsigned count) {
    const uint8_t *from = bytes;
    const remembered *last = newest();
    remembered *to = last == &slots[0] ? &slots[1] : &slots[0];
    to->crc = ~to->crc; /* invalid during the write */
    board_kept_settle();
    to->sequence = last != NULL ? (uint8_t)(last->sequence + 1U) : 0U;
    to->count = (uint8_t)(count < HAL_REMEMBER_BYTES ? count : HAL_REMEMBER_BYTES);
    for (unsigned i = 0; i < HAL_REMEMBER_BYTES; i++) {
        to->bytes[i] = i < to->count ? from[i] : 0;
    }
    board_kept_settle();
    to->crc = crc_of(to);
    board_kept_settle();
}

unsigned hal_recall(void *bytes) {
    uint8_t *to = bytes;
    const remembered *last = newest();
    const unsigned count = last != NULL ? (unsigned)last->count : 0U;
    for (unsigned i = 0; i < count; i++) {
        to[i] = last->bytes[i];
    }
    return count;
}

void board_forget(void) {
    for (remembered *slot = slots; slot < slots + 2; slot++) {
        slot->crc = ~crc_of(slot);
    }
    board_kept_settle();
}

bool board_remembers(void) { return newest() != NULL; }

void hal_reset_mark(uint32_t now) { *(volatile uint32_t *)&kept_state = now; }

uint32_t board_kept_state(void) { return kept_state; }

/* store.h: bytes that survive a power loss, in two slots. One of them always has the last complete record.
 *
 * A record goes into the slot that does not have the newest record. So a power failure during a write leaves the
 * previous record intact. In a slot, multi-byte numbers are low byte first:
 *
 *     format 2 | bytes of the payload 2 | sequence 4 | payload | CRC-32 4
 *
 * The newest record with a right CRC is the valid one. Sequence numbers wrap and skip 0. The memory may be flash, where
 * an erase sets all bits and a write only clears some. A slot is written front to back, once after each erase. */
#ifndef WH_STATION_STORE_H
#define WH_STATION_STORE_H

#include "core/real.h"

#define WH_STORE_SLOTS 2U
#define WH_STORE_HEAD_BYTES 8U   /* bytes of a record before the payload */
#define WH_STORE_FIXED_BYTES 12U /* bytes of a record other than payload */
#define WH_STORE_PAYLOAD_MOST 240U
#define WH_STORE_SLOT_BYTES (WH_STORE_FIXED_BYTES + WH_STORE_PAYLOAD_MOST)

/* Functions that a board supplies (hal/settings.h). Each works on slot 0 or 1. It returns false if the memory reported
 * a failure. */
typedef struct wh_store_memory {
    bool (*erase)(unsigned slot);
    bool (*write)(unsigned slot, unsigned at, const uint8_t *bytes, unsigned count);
    bool (*read)(unsigned slot, unsigned at, uint8_t *bytes, unsigned count);
} wh_store_memory;

/* Load the newest record into bytes[WH_STORE_SLOT_BYTES]; its payload begins at WH_STORE_HEAD_BYTES. Returns the length
 * of the payload, or -1 if there is no record. *sequence gets the record's sequence number, or 0. */
int wh_store_load(const wh_store_memory *memory, uint8_t *bytes, uint32_t *sequence);

/* Write a record with a payload of `count` bytes, at most WH_STORE_PAYLOAD_MOST, at bytes[WH_STORE_HEAD_BYTES]. This
 * function adds the other fields and reads the record back. Returns the sequence number; or 0 if the write failed, and
 * then the previous record is intact. */
uint32_t wh_store_save(const wh_store_memory *memory, uint8_t *bytes, unsigned count);

#endif

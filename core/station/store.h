/* store.h: bytes that survive a power loss, in two slots, one of which always has the last complete record.
 *
 * A record goes into the slot without the newest one, so that a power failure during a write leaves the previous record
 * intact. In a slot, multi-byte numbers are low byte first:
 *
 *     format 2 | bytes of the payload 2 | sequence 4 | payload | CRC-32 4
 *
 * The newest record with a right CRC is the valid one. Sequence numbers wrap and skip 0. The memory may be flash, where
 * an erase sets all bits and a write only clears some. A slot is written front to back, once after each erase. */
#ifndef WH_STATION_STORE_H
#define WH_STATION_STORE_H

#include "core/real.h"

#ifdef __cplusplus
extern "C" {
#endif

#define WH_STORE_SLOTS 2U
#define WH_STORE_HEAD_BYTES 8U   /* bytes of a record before the payload */
#define WH_STORE_FIXED_BYTES 12U /* bytes of a record other than payload */
#define WH_STORE_PAYLOAD_MOST 240U
#define WH_STORE_SLOT_BYTES (WH_STORE_FIXED_BYTES + WH_STORE_PAYLOAD_MOST)

/* Functions that a board supplies (hal/settings.h). Each acts on slot 0 or 1 and returns false if the memory reported a
 * failure. */
typedef struct wh_store_memory {
    bool (*erase)(unsigned slot);
    bool (*write)(unsigned slot, unsigned at, const uint8_t *bytes, unsigned count);
    bool (*read)(unsigned slot, unsigned at, uint8_t *bytes, unsigned count);
} wh_store_memory;

#define wh_store_load WH_NAME(wh_store_load)
#define wh_store_save WH_NAME(wh_store_save)

/* Records are in bytes[WH_STORE_SLOT_BYTES], their payload from WH_STORE_HEAD_BYTES on. */

/* Load the newest record. Returns the length of its payload, or -1 if there is none. *sequence gets the record's
 * sequence, or 0. */
int wh_store_load(const wh_store_memory *memory, uint8_t *bytes, uint32_t *sequence);

/* Write a record with a payload of `count` bytes, at most WH_STORE_PAYLOAD_MOST; this function adds the other fields.
 * It reads the record back. Returns its sequence number, or 0 if the write failed and the previous record is intact. */
uint32_t wh_store_save(const wh_store_memory *memory, uint8_t *bytes, unsigned count);

#ifdef __cplusplus
}
#endif

#endif

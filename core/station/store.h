/* store.h: a record of bytes in permanent memory, in two slots.
 *
 * A save overwrites the older record, so the newer one survives a power failure. Layout of a slot, with sizes in bytes
 * and little-endian numbers:
 *
 *     format 2 | size of the payload 2 | sequence 4 | payload | CRC-32 4
 *
 * The valid record is the newest one whose CRC matches. Sequence numbers wrap and skip 0. The memory may be flash: a
 * slot is written only once after each erase, front to back. */
#ifndef WH_STATION_STORE_H
#define WH_STATION_STORE_H

#include "core/real.h"

#define WH_STORE_SLOTS 2U
#define WH_STORE_HEAD_BYTES 8U   /* bytes of a record before the payload */
#define WH_STORE_FIXED_BYTES 12U /* bytes of a record other than payload */
#define WH_STORE_PAYLOAD_MOST 240U
#define WH_STORE_SLOT_BYTES (WH_STORE_FIXED_BYTES + WH_STORE_PAYLOAD_MOST)

/* The board's access to slot 0 or 1 (hal/settings.h). Each function returns false if the memory reports a failure. */
typedef struct wh_store_memory {
    bool (*erase)(unsigned slot);
    bool (*write)(unsigned slot, unsigned at, const uint8_t *bytes, unsigned count);
    bool (*read)(unsigned slot, unsigned at, uint8_t *bytes, unsigned count);
} wh_store_memory;

/* Loads the newest record into bytes[WH_STORE_SLOT_BYTES], with the payload at WH_STORE_HEAD_BYTES. Returns the
 * payload's size, or -1 if there is no valid record. *sequence gets the record's sequence number, or 0. */
int wh_store_load(const wh_store_memory *memory, uint8_t *bytes, uint32_t *sequence);

/* Saves a payload of `count` <= WH_STORE_PAYLOAD_MOST bytes. It begins at bytes[WH_STORE_HEAD_BYTES], and bytes[] has
 * count + WH_STORE_FIXED_BYTES elements. Returns the sequence number. A failure returns 0 and keeps the old record. */
uint32_t wh_store_save(const wh_store_memory *memory, uint8_t *bytes, unsigned count);

#endif

/* store.h: bytes that outlive the power: in two slots, of which one always holds what was written last.
 *
 * A record goes into the slot that does not hold the newest one, so that a supply that fails at any instant of a write
 * leaves the one before untouched. In a slot, numbers of several bytes low byte first:
 *
 *     format 2 | bytes of the payload 2 | sequence 4 | payload | CRC-32 4
 *
 * The newest good one counts; sequences wrap, and none is 0. The memory may be flash, where an erase makes all bits ones and a write only
 * zeros of them; a slot is written front to back, once behind each erase. */
#ifndef WH_STATION_STORE_H
#define WH_STATION_STORE_H

#include "core/real.h"

#ifdef __cplusplus
extern "C" {
#endif

#define WH_STORE_SLOTS 2U
#define WH_STORE_HEAD_BYTES 8U   /* of a record, before the payload */
#define WH_STORE_FIXED_BYTES 12U /* that are not payload */
#define WH_STORE_PAYLOAD_MOST 240U
#define WH_STORE_SLOT_BYTES (WH_STORE_FIXED_BYTES + WH_STORE_PAYLOAD_MOST)

/* What a board supplies (hal/settings.h). Each acts on slot 0 or 1 and returns false when the memory said that it failed. */
typedef struct wh_store_memory {
    bool (*erase)(unsigned slot);
    bool (*write)(unsigned slot, unsigned at, const uint8_t *bytes, unsigned count);
    bool (*read)(unsigned slot, unsigned at, uint8_t *bytes, unsigned count);
} wh_store_memory;

#define wh_store_load WH_NAME(wh_store_load)
#define wh_store_save WH_NAME(wh_store_save)

/* Records are in bytes[WH_STORE_SLOT_BYTES], their payload from WH_STORE_HEAD_BYTES on. */

/* The newest record; returns the length of its payload, -1 when there is none. Its sequence to *sequence, or 0. */
int wh_store_load(const wh_store_memory *memory, uint8_t *bytes, uint32_t *sequence);

/* A new record, with a payload of `count` bytes, at most WH_STORE_PAYLOAD_MOST; the others are put in here. It is read back
 * once it is written. Returns its sequence; 0: it is not there, and what was loaded before still is. */
uint32_t wh_store_save(const wh_store_memory *memory, uint8_t *bytes, unsigned count);

#ifdef __cplusplus
}
#endif

#endif

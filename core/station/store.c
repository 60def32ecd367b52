/* store.c: bytes that outlive the power, in two slots. */
#include "store.h"

#include "core/frame.h"

#define FORMAT 0x5701U
#define HEAD_BYTES WH_STORE_HEAD_BYTES
#define WITH_ITS_CRC 0x2144DF1CU /* the CRC-32 of whatever ends in its own */

/* What a slot holds. */
typedef struct record {
    uint32_t sequence; /* 0: no good one */
    unsigned length;   /* with head and CRC */
} record;

static const record none;

/* Piece by piece, as there is no room for another one. */
static record read_slot(const wh_store_memory *memory, unsigned slot) {
    uint8_t bytes[HEAD_BYTES];
    record found = {.length = HEAD_BYTES};
    uint32_t crc = 0;
    for (unsigned at = 0; at < found.length; at += HEAD_BYTES) {
        const unsigned rest = found.length - at;
        const unsigned part = rest < HEAD_BYTES ? rest : HEAD_BYTES;
        if (!memory->read(slot, at, bytes, part)) {
            return none;
        }
        crc = wh_frame_crc(crc, bytes, part);
        if (at == 0) {
            wh_bytes head = {.from = bytes, .room = HEAD_BYTES};
            const uint32_t format = wh_bytes_get(&head, 2);
            found.length = WH_STORE_FIXED_BYTES + (unsigned)wh_bytes_get(&head, 2);
            found.sequence = wh_bytes_get(&head, 4);
            if (format != FORMAT || found.length > WH_STORE_SLOT_BYTES) {
                return none;
            }
        }
    }
    return crc == WITH_ITS_CRC ? found : none;
}

/* The slot of the newest record; 1 when there is none. */
static unsigned newest(const wh_store_memory *memory, record *found) {
    const record first = read_slot(memory, 0);
    *found = read_slot(memory, 1);
    if (first.sequence != 0 &&
        (found->sequence == 0 || (int32_t)(found->sequence - first.sequence) <= 0)) {
        *found = first;
        return 0;
    }
    return 1;
}

int wh_store_load(const wh_store_memory *memory, uint8_t *bytes, uint32_t *sequence) {
    record found;
    const unsigned slot = newest(memory, &found);
    *sequence = found.sequence;
    return found.sequence != 0 && memory->read(slot, 0, bytes, found.length)
               ? (int)(found.length - WH_STORE_FIXED_BYTES)
               : -1;
}

uint32_t wh_store_save(const wh_store_memory *memory, uint8_t *bytes, unsigned count) {
    record before;
    if (count > WH_STORE_PAYLOAD_MOST) {
        return 0;
    }
    const unsigned slot = 1U - newest(memory, &before);
    const uint32_t sequence = before.sequence != UINT32_MAX ? before.sequence + 1U : 1U;
    wh_bytes made = {.to = bytes, .room = WH_STORE_SLOT_BYTES};
    wh_bytes_put(&made, FORMAT, 2);
    wh_bytes_put(&made, count, 2);
    wh_bytes_put(&made, sequence, 4);
    made.at += count;
    wh_bytes_put(&made, wh_frame_crc(0, bytes, made.at), 4);
    if (!memory->erase(slot) || !memory->write(slot, 0, bytes, made.at)) {
        return 0;
    }
    const record after = read_slot(memory, slot);
    return after.sequence == sequence && after.length == made.at ? sequence : 0;
}

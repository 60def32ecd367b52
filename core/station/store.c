/* store.c: a record of bytes in permanent memory. */
#include "store.h"

#include "core/frame.h"

#define FORMAT 0x5701U
#define HEAD_BYTES WH_STORE_HEAD_BYTES
#define WITH_ITS_CRC 0x2144DF1CU /* the CRC-32 of any record that ends in its own CRC */

static uint32_t get(const uint8_t *bytes) {
    return bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

static void put(uint8_t *bytes, uint32_t number) {
    bytes[0] = (uint8_t)number;
    bytes[1] = (uint8_t)(number >> 8);
    bytes[2] = (uint8_t)(number >> 16);
    bytes[3] = (uint8_t)(number >> 24);
}

/* Returns the sequence number of a slot's record, or 0 if the record is not valid. *length gets the record's length,
 * including head and CRC. Reads a few bytes at a time to save memory. */
static uint32_t read_slot(const wh_store_memory *memory, unsigned slot, unsigned *length) {
    uint8_t bytes[HEAD_BYTES];
    uint32_t sequence = 0;
    uint32_t crc = 0;
    *length = HEAD_BYTES;
    for (unsigned at = 0; at < *length; at += HEAD_BYTES) {
        const unsigned rest = *length - at;
        const unsigned part = rest < HEAD_BYTES ? rest : HEAD_BYTES;
        if (!memory->read(slot, at, bytes, part)) {
            return 0;
        }
        crc = wh_frame_crc(crc, bytes, part);
        if (at == 0) {
            const uint32_t head = get(bytes);
            *length = WH_STORE_FIXED_BYTES + (unsigned)(head >> 16);
            sequence = get(bytes + 4);
            if ((head & 0xFFFFU) != FORMAT || *length > WH_STORE_SLOT_BYTES) {
                return 0;
            }
        }
    }
    return crc == WITH_ITS_CRC ? sequence : 0;
}

/* Returns the slot with the newest record, or 1 if there is none. */
static unsigned newest(const wh_store_memory *memory, uint32_t *sequence, unsigned *length) {
    unsigned first_length;
    const uint32_t first = read_slot(memory, 0, &first_length);
    *sequence = read_slot(memory, 1, length);
    if (first != 0 && (*sequence == 0 || (int32_t)(*sequence - first) <= 0)) {
        *sequence = first;
        *length = first_length;
        return 0;
    }
    return 1;
}

int wh_store_load(const wh_store_memory *memory, uint8_t *bytes, uint32_t *sequence) {
    unsigned length;
    const unsigned slot = newest(memory, sequence, &length);
    return *sequence != 0 && memory->read(slot, 0, bytes, length)
               ? (int)(length - WH_STORE_FIXED_BYTES)
               : -1;
}

uint32_t wh_store_save(const wh_store_memory *memory, uint8_t *bytes, unsigned count) {
    const unsigned length = WH_STORE_FIXED_BYTES + count;
    uint32_t sequence;
    unsigned before;
    unsigned after;
    if (count > WH_STORE_PAYLOAD_MOST) {
        return 0;
    }
    const unsigned slot = 1U - newest(memory, &sequence, &before);
    sequence += sequence != UINT32_MAX ? 1U : 2U; /* skips 0 */
    put(bytes, FORMAT | (uint32_t)count << 16);
    put(bytes + 4, sequence);
    put(bytes + HEAD_BYTES + count, wh_frame_crc(0, bytes, HEAD_BYTES + count));
    return memory->erase(slot) && memory->write(slot, 0, bytes, length) &&
                   read_slot(memory, slot, &after) == sequence && after == length
               ? sequence
               : 0;
}

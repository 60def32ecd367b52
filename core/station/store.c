/* store.c: bytes that outlive the power, in two slots. */
#include "store.h"

#include "core/frame.h"

#define FORMAT 0x5701U
#define HEAD_BYTES 8U

/* What a slot holds. */
typedef struct record {
    bool good;
    uint32_t sequence;
    unsigned count; /* of the payload, */
    const uint8_t *payload;
} record;

/* A slot as a record, in bytes[WH_STORE_SLOT_BYTES]. */
static record read_slot(const wh_store_memory *memory, unsigned slot, uint8_t *bytes) {
    record found = {.good = false};
    if (!memory->read(slot, 0, bytes, HEAD_BYTES)) {
        return found;
    }
    wh_bytes head = {.from = bytes, .room = HEAD_BYTES};
    const uint32_t format = wh_bytes_get(&head, 2);
    found.count = (unsigned)wh_bytes_get(&head, 2);
    found.sequence = wh_bytes_get(&head, 4);
    found.payload = bytes + HEAD_BYTES;
    if (format != FORMAT || found.count > WH_STORE_PAYLOAD_MOST ||
        !memory->read(slot, HEAD_BYTES, bytes + HEAD_BYTES, found.count + 4U)) {
        return found;
    }
    wh_bytes tail = {.from = bytes + HEAD_BYTES + found.count, .room = 4};
    found.good = wh_bytes_get(&tail, 4) == wh_frame_crc(0, bytes, HEAD_BYTES + found.count);
    return found;
}

/* The slot of the newest record, its bytes in bytes[WH_STORE_SLOT_BYTES]; WH_STORE_SLOTS when there is none. */
static unsigned newest(const wh_store_memory *memory, uint8_t *bytes, record *found) {
    const record first = read_slot(memory, 0, bytes);
    const record second = read_slot(memory, 1, bytes);
    if (second.good && (!first.good || (int32_t)(second.sequence - first.sequence) > 0)) {
        *found = second;
        return 1;
    }
    *found = read_slot(memory, 0, bytes); /* once more: one slot's room is all there is */
    return found->good ? 0 : WH_STORE_SLOTS;
}

int wh_store_load(const wh_store_memory *memory, uint8_t *payload, unsigned room,
                  uint32_t *sequence) {
    uint8_t bytes[WH_STORE_SLOT_BYTES];
    record found;
    const bool any = newest(memory, bytes, &found) < WH_STORE_SLOTS;
    *sequence = any ? found.sequence : 0;
    if (!any || found.count > room) {
        return -1;
    }
    for (unsigned i = 0; i < found.count; i++) {
        payload[i] = found.payload[i];
    }
    return (int)found.count;
}

bool wh_store_save(const wh_store_memory *memory, const uint8_t *payload, unsigned count) {
    uint8_t bytes[WH_STORE_SLOT_BYTES];
    record before;
    if (count > WH_STORE_PAYLOAD_MOST) {
        return false;
    }
    const unsigned holds = newest(memory, bytes, &before);
    const uint32_t sequence =
        holds < WH_STORE_SLOTS && before.sequence != UINT32_MAX ? before.sequence + 1U : 1U;
    const unsigned slot = holds == 0 ? 1U : 0U;
    wh_bytes made = {.to = bytes, .room = sizeof bytes};
    wh_bytes_put(&made, FORMAT, 2);
    wh_bytes_put(&made, count, 2);
    wh_bytes_put(&made, sequence, 4);
    for (unsigned i = 0; i < count; i++) {
        wh_bytes_put(&made, payload[i], 1);
    }
    wh_bytes_put(&made, wh_frame_crc(0, bytes, made.at), 4);
    if (!memory->erase(slot) || !memory->write(slot, 0, bytes, made.at)) {
        return false;
    }
    const record after = read_slot(memory, slot, bytes);
    return after.good && after.sequence == sequence && after.count == count;
}

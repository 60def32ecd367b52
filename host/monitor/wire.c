/* wire.c: see wire.h. */
#include "wire.h"

#include "core/cobs.h"

static wire_event add_text(wire *w, char byte) {
    if (w->line_done) {
        w->columns = 0;
        w->line_done = false;
    }
    if (byte == '\n') {
        w->line_done = true;
        w->line[w->columns] = '\0';
        return WIRE_TEXT;
    }
    if (byte != '\r' && w->columns < WIRE_LINE) {
        w->line[w->columns++] = byte;
    }
    return WIRE_NOTHING;
}

static uint32_t number(const uint8_t *bytes, unsigned size) {
    uint32_t value = 0;
    for (unsigned i = 0; i < size; i++) {
        value |= (uint32_t)bytes[i] << 8 * i;
    }
    return value;
}

static wire_event end_chunk(wire *w) {
    const unsigned length = w->too_long ? 0 : wh_cobs_decode(w->chunk, w->length);
    if (length < WIRE_HEAD + 2 || w->chunk[0] < 0x80U ||
        wh_crc16(WH_CRC16_START, w->chunk, length - 2U) != number(w->chunk + length - 2U, 2)) {
        w->damaged++;
        return WIRE_NOTHING;
    }
    w->frame = (wire_frame){.channel = w->chunk[0] - 0x80U,
                            .sequence = (uint16_t)number(w->chunk + 1, 2),
                            .dropped = (uint16_t)number(w->chunk + 3, 2),
                            .ticks = number(w->chunk + 5, 4),
                            .payload = w->chunk + WIRE_HEAD,
                            .length = length - WIRE_HEAD - 2U};
    return WIRE_FRAME;
}

/* By the second byte it is known what the first was of; a line feed is no frame's first. */
static wire_event add(wire *w, uint8_t byte) {
    if (!w->is_frame && w->length == 1U) {
        w->is_frame = byte >= 0x80U;
        w->is_text = !w->is_frame;
        if (w->is_text) {
            w->length = 0;
            const wire_event first = add_text(w, (char)w->chunk[0]);
            const wire_event second = add_text(w, (char)byte);
            return first == WIRE_TEXT ? first : second;
        }
    }
    if (w->length < WIRE_ROOM) {
        w->chunk[w->length++] = byte;
    } else {
        w->too_long = true;
    }
    return WIRE_NOTHING;
}

wire_event wire_take(wire *w, uint8_t byte) {
    if (byte != 0) {
        return w->is_text ? add_text(w, (char)byte) : add(w, byte);
    }
    wire_event event = WIRE_NOTHING;
    if (w->is_frame) {
        event = end_chunk(w);
    } else if (w->length == 1U) { /* one byte of text between two frames, as an echo is */
        event = add_text(w, (char)w->chunk[0]);
    }
    w->length = 0;
    w->is_text = false;
    w->is_frame = false;
    w->too_long = false;
    return event;
}

void wire_forget(wire *w) {
    w->length = 0;
    w->columns = 0;
    w->is_text = false;
    w->is_frame = false;
    w->too_long = false;
}

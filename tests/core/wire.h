/* wire.h: the tests' own decoder of the station's line, written from the description in core/station/telemetry.h. Its
 * checksums are computed bit by bit. */
#ifndef TESTS_CORE_WIRE_H
#define TESTS_CORE_WIRE_H

#include <stdbool.h>
#include <stdint.h>

#define WIRE_CHUNK 300U
#define WIRE_TEXT 8192U

typedef struct wire_frame {
    unsigned channel;
    uint16_t sequence;
    uint16_t dropped;
    uint32_t ticks;
    const uint8_t *payload;
    unsigned count;
} wire_frame;

/* The state of the decoder. All zeros: no input yet. */
typedef struct wire {
    uint8_t chunk[WIRE_CHUNK]; /* the bytes since the last zero */
    unsigned count;
    bool framed;               /* inside a frame */
    bool text_next;            /* text follows */
    uint8_t whole[WIRE_CHUNK]; /* the last frame, decoded */
    char text[WIRE_TEXT];
    unsigned text_count;
    unsigned bad; /* number of chunks that are neither frame nor text */
} wire;

static inline uint32_t wire_number(const uint8_t *bytes, unsigned size) {
    uint32_t number = 0;
    for (unsigned i = size; i > 0; i--) {
        number = number * 256U + bytes[i - 1U];
    }
    return number;
}

static inline bool wire_sum_is_right(const uint8_t *bytes, unsigned count) {
    uint32_t rest = 0xFFFFU;
    for (unsigned i = 0; i + 2U < count; i++) {
        for (unsigned bit = 8; bit > 0; bit--) {
            const uint32_t in = (uint32_t)(bytes[i] >> (bit - 1U)) & 1U;
            const uint32_t out = rest >> 15 & 1U;
            rest = (rest << 1 & 0xFFFFU) ^ ((in ^ out) != 0 ? 0x1021U : 0U);
        }
    }
    return count > 2U && rest == wire_number(bytes + count - 2U, 2);
}

/* Copies the bytes without the code bytes. (A code of 255 is followed by no zero.) */
static inline unsigned wire_without_codes(const wire *w, uint8_t *to) {
    unsigned left = 1;
    unsigned length = 0;
    bool zero = false;
    for (unsigned i = 0; i < w->count; i++) {
        left--;
        if (left > 0) {
            to[length++] = w->chunk[i];
            continue;
        }
        if (zero) {
            to[length++] = 0;
        }
        left = w->chunk[i];
        zero = left < 255U;
    }
    return left == 1U ? length : 0U;
}

static inline void wire_text(wire *w, char byte) {
    if (w->text_count + 1U < WIRE_TEXT) {
        w->text[w->text_count++] = byte;
        w->text[w->text_count] = '\0';
    }
}

static inline void wire_add(wire *w, uint8_t byte) {
    if (w->count == 1U) {
        w->framed = byte >= 0x80U;
        w->text_next = !w->framed;
        if (w->text_next) {
            wire_text(w, (char)w->chunk[0]);
        }
    }
    if (w->text_next && w->count > 0) {
        wire_text(w, (char)byte);
        w->count = 2; /* too short for a frame */
    } else if (w->count < WIRE_CHUNK) {
        w->chunk[w->count++] = byte;
    }
}

/* Takes a byte. Returns true if it ends a good frame, which is then in *frame. */
static inline bool wire_take(wire *w, uint8_t byte, wire_frame *frame) {
    if (byte != 0) {
        wire_add(w, byte);
        return false;
    }
    const unsigned count = w->framed ? wire_without_codes(w, w->whole) : 0U;
    const bool good = count >= 11U && w->whole[0] >= 0x80U && wire_sum_is_right(w->whole, count);
    if (good) {
        *frame = (wire_frame){.channel = w->whole[0] - 0x80U,
                              .sequence = (uint16_t)wire_number(w->whole + 1, 2),
                              .dropped = (uint16_t)wire_number(w->whole + 3, 2),
                              .ticks = wire_number(w->whole + 5, 4),
                              .payload = w->whole + 9,
                              .count = count - 11U};
    } else if (w->framed) {
        w->bad++;
    } else if (w->count == 1U) {
        wire_text(w, (char)w->chunk[0]);
    }
    w->count = 0;
    w->framed = false;
    w->text_next = false;
    return good;
}

#endif

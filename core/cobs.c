/* cobs.c: consistent overhead byte stuffing, and a CRC. */
#include "cobs.h"

static void put_raw(wh_cobs *c, uint8_t byte) {
    if (c->at < c->room) {
        c->bytes[c->at++] = byte;
    } else {
        c->full = true;
    }
}

static void close_block(wh_cobs *c) {
    if (!c->full) {
        c->bytes[c->head] = (uint8_t)(c->at - c->head);
    }
    c->head = c->at;
    put_raw(c, 0);
}

void wh_cobs_start(wh_cobs *cobs, uint8_t *bytes, unsigned room) {
    *cobs = (wh_cobs){.bytes = bytes, .room = room};
    put_raw(cobs, 0);
}

void wh_cobs_put(wh_cobs *cobs, uint8_t byte) {
    if (byte != 0) {
        put_raw(cobs, byte);
    }
    if (byte == 0 || cobs->at - cobs->head == 255U) {
        close_block(cobs);
    }
}

unsigned wh_cobs_end(wh_cobs *cobs) {
    close_block(cobs); /* this also opens a block, whose head is the final zero */
    return cobs->full ? 0 : cobs->at;
}

unsigned wh_cobs_decode(uint8_t *bytes, unsigned length) {
    unsigned to = 0;
    for (unsigned at = 0; at < length;) {
        const unsigned block = bytes[at++];
        if (block - 1U > length - at) {
            return 0;
        }
        for (unsigned i = 1; i < block; i++) {
            bytes[to++] = bytes[at++];
        }
        if (block < 255U && at < length) {
            bytes[to++] = 0;
        }
    }
    return to;
}

unsigned wh_cobs_short(uint8_t *bytes, unsigned count) {
    unsigned zero = count + 1U; /* index of the next zero */
    bytes[0] = 0;
    bytes[zero] = 0;
    for (unsigned at = zero; at-- > 0;) {
        if (bytes[at] == 0) {
            bytes[at] = (uint8_t)(zero - at);
            zero = at;
        }
    }
    return count + 2U;
}

/* Divides by the polynomial x^16 + x^12 + x^5 + 1, eight bits at a time. */
uint16_t wh_crc16(uint16_t crc, const uint8_t *bytes, unsigned count) {
    for (unsigned i = 0; i < count; i++) {
        unsigned out = (crc >> 8 ^ bytes[i]) & 0xFFU;
        out ^= out >> 4;
        crc = (uint16_t)((unsigned)crc << 8 ^ out << 12 ^ out << 5 ^ out);
    }
    return crc;
}

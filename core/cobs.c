/* cobs.c: bytes without zeros, and a sum over them. */
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
    close_block(cobs); /* the head that it opens is the zero that ends them */
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

/* Four bits at a time. */
uint16_t wh_crc16(uint16_t crc, const uint8_t *bytes, unsigned count) {
    static const uint16_t of_nibble[16] = {0x0000, 0x1021, 0x2042, 0x3063, 0x4084, 0x50A5,
                                           0x60C6, 0x70E7, 0x8108, 0x9129, 0xA14A, 0xB16B,
                                           0xC18C, 0xD1AD, 0xE1CE, 0xF1EF};
    for (unsigned i = 0; i < count; i++) {
        crc = (uint16_t)(crc << 4 ^ of_nibble[(crc >> 12 ^ bytes[i] >> 4) & 15]);
        crc = (uint16_t)(crc << 4 ^ of_nibble[(crc >> 12 ^ bytes[i]) & 15]);
    }
    return crc;
}

/* frame.c: framing: CRC, coding without zeros, numbers in bytes. */
#include "frame.h"

#define CRC_START 0xFFFFFFFFU

/* Four bits at a time: the reflected polynomial 0xEDB88320 times each number of four bits. */
static uint32_t crc_step(uint32_t crc, uint8_t byte) {
    static const uint32_t of_nibble[16] = {0x00000000U, 0x1DB71064U, 0x3B6E20C8U, 0x26D930ACU,
                                           0x76DC4190U, 0x6B6B51F4U, 0x4DB26158U, 0x5005713CU,
                                           0xEDB88320U, 0xF00F9344U, 0xD6D6A3E8U, 0xCB61B38CU,
                                           0x9B64C2B0U, 0x86D3D2D4U, 0xA00AE278U, 0xBDBDF21CU};
    crc = of_nibble[(crc ^ byte) & 15U] ^ crc >> 4;
    return of_nibble[(crc ^ (uint32_t)byte >> 4) & 15U] ^ crc >> 4;
}

uint32_t wh_frame_crc(uint32_t crc, const uint8_t *bytes, unsigned count) {
    crc ^= CRC_START;
    for (unsigned i = 0; i < count; i++) {
        crc = crc_step(crc, bytes[i]);
    }
    return crc ^ CRC_START;
}

/* --- writing -----------------------------------------------------------------------------------------*/

/* Blocks of up to 254 bytes without a zero, each behind a byte that says where the next zero would be. */
typedef struct coder {
    uint8_t *bytes;
    unsigned room;
    unsigned at;   /* the next byte */
    unsigned head; /* the byte in front of this block */
    uint32_t crc;
    bool full;
} coder;

static void put_raw(coder *c, uint8_t byte) {
    if (c->at < c->room) {
        c->bytes[c->at++] = byte;
    } else {
        c->full = true;
    }
}

static void close_block(coder *c) {
    if (!c->full) {
        c->bytes[c->head] = (uint8_t)(c->at - c->head);
    }
    c->head = c->at;
    put_raw(c, 0);
}

static void put_coded(coder *c, uint8_t byte) {
    if (byte != 0) {
        put_raw(c, byte);
    }
    if (byte == 0 || c->at - c->head == 255U) {
        close_block(c);
    }
}

static void put(coder *c, uint32_t number, unsigned size) {
    for (unsigned i = 0; i < size; i++) {
        const uint8_t byte = (uint8_t)(number >> 8U * i);
        c->crc = crc_step(c->crc, byte);
        put_coded(c, byte);
    }
}

unsigned wh_frame_write(const wh_frame *frame, uint8_t *bytes, unsigned room) {
    coder c = {.bytes = bytes, .room = room, .crc = CRC_START};
    put_raw(&c, 0);
    put(&c, WH_FRAME_VERSION, 1);
    put(&c, frame->kind, 1);
    put(&c, frame->sequence, 2);
    put(&c, frame->ticks, 4);
    for (unsigned i = 0; i < frame->length; i++) {
        put(&c, frame->payload[i], 1);
    }
    put(&c, c.crc ^ CRC_START, 4);
    close_block(&c); /* the head that it opens is the zero that ends the frame */
    return c.full ? 0 : c.at;
}

/* --- reading -----------------------------------------------------------------------------------------*/

void wh_frame_reader_start(wh_frame_reader *reader, uint8_t *bytes, unsigned room) {
    *reader = (wh_frame_reader){.bytes = bytes, .room = room};
}

/* In place: what is decoded is never longer. Returns its length; 0 when it is no coded frame. */
static unsigned decode(uint8_t *bytes, unsigned length) {
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

static bool parse(const uint8_t *bytes, unsigned length, wh_frame *frame) {
    if (length < WH_FRAME_FIXED_BYTES) {
        return false;
    }
    wh_bytes fields = {.from = bytes, .room = length};
    frame->version = (uint8_t)wh_bytes_get(&fields, 1);
    frame->kind = (uint8_t)wh_bytes_get(&fields, 1);
    frame->sequence = (uint16_t)wh_bytes_get(&fields, 2);
    frame->ticks = wh_bytes_get(&fields, 4);
    frame->payload = bytes + fields.at;
    frame->length = length - WH_FRAME_FIXED_BYTES;
    fields.at += frame->length;
    return wh_bytes_get(&fields, 4) == wh_frame_crc(0, bytes, length - 4U);
}

bool wh_frame_take(wh_frame_reader *reader, uint8_t byte, wh_frame *frame) {
    if (byte != 0) {
        if (reader->length < reader->room) {
            reader->bytes[reader->length++] = byte;
        } else {
            reader->too_long = true;
        }
        return false;
    }
    const unsigned length = reader->length;
    const bool nothing = length == 0; /* two zeros on end: a sender may begin with one */
    const bool good =
        !reader->too_long && parse(reader->bytes, decode(reader->bytes, length), frame);
    reader->dropped += !good && !nothing;
    reader->length = 0;
    reader->too_long = false;
    return good;
}

/* --- numbers -----------------------------------------------------------------------------------------*/

void wh_bytes_put(wh_bytes *bytes, uint32_t number, unsigned size) {
    if (size > bytes->room - bytes->at) {
        bytes->over = true;
        return;
    }
    for (unsigned i = 0; i < size; i++) {
        bytes->to[bytes->at++] = (uint8_t)(number >> 8U * i);
    }
}

uint32_t wh_bytes_get(wh_bytes *bytes, unsigned size) {
    uint32_t number = 0;
    if (size > bytes->room - bytes->at) {
        bytes->over = true;
        return 0;
    }
    for (unsigned i = 0; i < size; i++) {
        number |= (uint32_t)bytes->from[bytes->at++] << 8U * i;
    }
    return number;
}

void wh_bytes_put_float(wh_bytes *bytes, float number) {
    uint32_t bits;
    __builtin_memcpy(&bits, &number, sizeof bits);
    wh_bytes_put(bytes, bits, 4);
}

float wh_bytes_get_float(wh_bytes *bytes) {
    const uint32_t bits = wh_bytes_get(bytes, 4);
    float number;
    __builtin_memcpy(&number, &bits, sizeof number);
    return number;
}

void wh_bytes_put_words(wh_bytes *bytes, const char *words) {
    do {
        wh_bytes_put(bytes, (uint8_t)*words, 1);
    } while (*words++ != '\0');
}

const char *wh_bytes_get_words(wh_bytes *bytes) {
    const char *words = (const char *)bytes->from + bytes->at;
    for (unsigned i = bytes->at; i < bytes->room; i++) {
        if (bytes->from[i] == 0) {
            bytes->at = i + 1U;
            return words;
        }
    }
    bytes->over = true;
    return "";
}

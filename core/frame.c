/* frame.c: frames: CRC, coding, and numbers in bytes. */
#include "frame.h"

#include "cobs.h"

#define CRC_START 0xFFFFFFFFU

#if WH_SMALL
static uint32_t crc_step(uint32_t crc, uint8_t byte) {
    crc ^= byte;
    for (unsigned bit = 0; bit < 8; bit++) {
        crc = crc >> 1 ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
    }
    return crc;
}
#else
/* Four bits at a time, because an 8-bit processor must finish a record's CRC within a control step. of_nibble[i] is the
 * four-bit number i times the reflected polynomial 0xEDB88320. */
static uint32_t crc_step(uint32_t crc, uint8_t byte) {
    static const uint32_t of_nibble[16] = {0x00000000U, 0x1DB71064U, 0x3B6E20C8U, 0x26D930ACU,
                                           0x76DC4190U, 0x6B6B51F4U, 0x4DB26158U, 0x5005713CU,
                                           0xEDB88320U, 0xF00F9344U, 0xD6D6A3E8U, 0xCB61B38CU,
                                           0x9B64C2B0U, 0x86D3D2D4U, 0xA00AE278U, 0xBDBDF21CU};
    crc = of_nibble[(crc ^ byte) & 15U] ^ crc >> 4;
    return of_nibble[(crc ^ (uint32_t)byte >> 4) & 15U] ^ crc >> 4;
}
#endif

uint32_t wh_frame_crc(uint32_t crc, const uint8_t *bytes, unsigned count) {
    crc ^= CRC_START;
    for (unsigned i = 0; i < count; i++) {
        crc = crc_step(crc, bytes[i]);
    }
    return crc ^ CRC_START;
}

typedef struct coder {
    wh_cobs cobs;
    uint32_t crc;
} coder;

static void put(coder *c, uint32_t number, unsigned size) {
    for (unsigned i = 0; i < size; i++) {
        const uint8_t byte = (uint8_t)(number >> 8U * i);
        c->crc = crc_step(c->crc, byte);
        wh_cobs_put(&c->cobs, byte);
    }
}

unsigned wh_frame_write(const wh_frame *frame, uint8_t *bytes, unsigned room) {
    coder c = {.crc = CRC_START};
    wh_cobs_start(&c.cobs, bytes, room);
    put(&c, WH_FRAME_VERSION, 1);
    put(&c, frame->kind, 1);
    put(&c, frame->sequence, 2);
    put(&c, frame->ticks, 4);
    for (unsigned i = 0; i < frame->length; i++) {
        put(&c, frame->payload[i], 1);
    }
    put(&c, c.crc ^ CRC_START, 4);
    return wh_cobs_end(&c.cobs);
}

void wh_frame_reader_start(wh_frame_reader *reader, uint8_t *bytes, unsigned room) {
    *reader = (wh_frame_reader){.bytes = bytes, .room = room};
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
    /* A zero directly after a zero is no bad frame: a sender may begin with a zero. */
    const bool nothing = length == 0;
    const bool good =
        !reader->too_long && parse(reader->bytes, wh_cobs_decode(reader->bytes, length), frame);
    reader->dropped += !good && !nothing;
    reader->length = 0;
    reader->too_long = false;
    return good;
}

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

/* cobs.h: consistent overhead byte stuffing (Cheshire & Baker, IEEE/ACM Transactions on Networking 7, 1999), and a
 * 16-bit CRC for short blocks.
 *
 * Coded bytes are never zero, and a zero byte ends a message. A reader that starts within a message, or has lost bytes,
 * is synchronized again after the next zero. */
#ifndef WH_COBS_H
#define WH_COBS_H

#include "real.h"

WH_C_BEGIN

/* Largest coded size of `count` bytes, including the final zero. */
#define WH_COBS_BYTES(count) ((count) + (count) / 254U + 2U)

/* An encoder. A head byte before each block of up to 254 bytes gives the distance to the next zero. */
typedef struct wh_cobs {
    uint8_t *bytes; /* the caller's memory, bytes[room] */
    unsigned room;
    unsigned at;   /* index of the next byte to write */
    unsigned head; /* index of the present block's head byte */
    bool full;     /* a byte did not fit and was dropped */
} wh_cobs;

#define wh_cobs_start WH_NAME(wh_cobs_start)
#define wh_cobs_put WH_NAME(wh_cobs_put)
#define wh_cobs_end WH_NAME(wh_cobs_end)
#define wh_cobs_short WH_NAME(wh_cobs_short)
#define wh_cobs_decode WH_NAME(wh_cobs_decode)
#define wh_crc16 WH_NAME(wh_crc16)

void wh_cobs_start(wh_cobs *cobs, uint8_t *bytes, unsigned room);
void wh_cobs_put(wh_cobs *cobs, uint8_t byte);

/* Append the final zero. Returns the number of coded bytes; 0 if they do not fit, and then `bytes` is invalid. */
unsigned wh_cobs_end(wh_cobs *cobs);

/* Code bytes[1] to bytes[count] in place: bytes[0] gets the head byte, bytes[count + 1] a zero. Returns count + 2. */
#define WH_COBS_SHORT_MOST 253U
unsigned wh_cobs_short(uint8_t *bytes, unsigned count);

/* Decode bytes[length], without the final zero, in place. Returns the decoded length; 0 if the code is invalid. */
unsigned wh_cobs_decode(uint8_t *bytes, unsigned length);

/* CRC-16/CCITT of bytes[count], polynomial 0x1021, high bit first. `crc`: WH_CRC16_START, or the CRC so far. */
#define WH_CRC16_START 0xFFFFU
uint16_t wh_crc16(uint16_t crc, const uint8_t *bytes, unsigned count);

WH_C_END

#endif

/* cobs.h: consistent overhead byte stuffing (Cheshire & Baker, IEEE/ACM Transactions on Networking 7, 1999), and a
 * 16-bit CRC for short blocks.
 *
 * Coded bytes are never zero, and a zero ends them; the code adds one byte in 254. A reader that starts in the middle,
 * or has lost bytes, is in step again after the next zero. */
#ifndef WH_COBS_H
#define WH_COBS_H

#include "real.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Most bytes on the line for `count` bytes, including the zero. A constant if `count` is. */
#define WH_COBS_BYTES(count) ((count) + (count) / 254U + 2U)

/* Blocks of up to 254 bytes without a zero, each after a byte that gives the position of the next zero. */
typedef struct wh_cobs {
    uint8_t *bytes; /* the caller's, room[] */
    unsigned room;
    unsigned at;   /* the next byte */
    unsigned head; /* the byte before this block */
    bool full;     /* there was no room */
} wh_cobs;

#define wh_cobs_start WH_NAME(wh_cobs_start)
#define wh_cobs_put WH_NAME(wh_cobs_put)
#define wh_cobs_end WH_NAME(wh_cobs_end)
#define wh_cobs_short WH_NAME(wh_cobs_short)
#define wh_cobs_decode WH_NAME(wh_cobs_decode)
#define wh_crc16 WH_NAME(wh_crc16)

void wh_cobs_start(wh_cobs *cobs, uint8_t *bytes, unsigned room);
void wh_cobs_put(wh_cobs *cobs, uint8_t byte);

/* Append the zero. Returns the number of bytes; 0 if there was no room: the bytes are then useless. */
unsigned wh_cobs_end(wh_cobs *cobs);

/* Code bytes[1] to bytes[count] in place, count <= 253, with the head before them and the zero after them. Returns the
 * number of bytes. */
#define WH_COBS_SHORT_MOST 253U
unsigned wh_cobs_short(uint8_t *bytes, unsigned count);

/* Decode `length` bytes (without their zero) in place: the result is shorter. Returns its length; 0 for invalid code. */
unsigned wh_cobs_decode(uint8_t *bytes, unsigned length);

/* CRC-16/CCITT of bytes[count], polynomial 0x1021, high bit first. `crc` is WH_CRC16_START, or the CRC of the bytes
 * before. */
#define WH_CRC16_START 0xFFFFU
uint16_t wh_crc16(uint16_t crc, const uint8_t *bytes, unsigned count);

#ifdef __cplusplus
}
#endif

#endif

/* cobs.h: consistent overhead byte stuffing (Cheshire & Baker, IEEE/ACM Transactions on Networking 7, 1999), and a
 * 16-bit CRC for short blocks.
 *
 * Coded bytes are never zero, and a zero ends them; the code adds one byte in 254. A reader that starts in the middle,
 * or has lost bytes, is in step again after the next zero. */
#ifndef WH_COBS_H
#define WH_COBS_H

#include "real.h"

WH_C_BEGIN

/* Largest coded size of `count` bytes, including the final zero. A constant if `count` is constant. */
#define WH_COBS_BYTES(count) ((count) + (count) / 254U + 2U)

/* The encoder. It writes blocks of up to 254 bytes without a zero. A head byte before each block gives the position
 * of the next zero. */
typedef struct wh_cobs {
    uint8_t *bytes; /* memory of the caller, room[] bytes */
    unsigned room;
    unsigned at;   /* index of the next byte to write */
    unsigned head; /* index of the head byte of the present block */
    bool full;     /* a byte was dropped for lack of room */
} wh_cobs;

#define wh_cobs_start WH_NAME(wh_cobs_start)
#define wh_cobs_put WH_NAME(wh_cobs_put)
#define wh_cobs_end WH_NAME(wh_cobs_end)
#define wh_cobs_short WH_NAME(wh_cobs_short)
#define wh_cobs_decode WH_NAME(wh_cobs_decode)
#define wh_crc16 WH_NAME(wh_crc16)

void wh_cobs_start(wh_cobs *cobs, uint8_t *bytes, unsigned room);
void wh_cobs_put(wh_cobs *cobs, uint8_t byte);

/* Append the final zero. Returns the number of coded bytes; or 0 if there was no room, and then `bytes` has no valid
 * content. */
unsigned wh_cobs_end(wh_cobs *cobs);

/* Code bytes[1] to bytes[count] in place, count <= 253. The head goes into bytes[0], the zero after the last byte.
 * Returns the number of coded bytes. */
#define WH_COBS_SHORT_MOST 253U
unsigned wh_cobs_short(uint8_t *bytes, unsigned count);

/* Decode `length` bytes (without the final zero) in place: the result is shorter. Returns its length; 0 for invalid code. */
unsigned wh_cobs_decode(uint8_t *bytes, unsigned length);

/* CRC-16/CCITT of bytes[count], polynomial 0x1021, high bit first. `crc` is WH_CRC16_START, or the CRC of the
 * preceding bytes. */
#define WH_CRC16_START 0xFFFFU
uint16_t wh_crc16(uint16_t crc, const uint8_t *bytes, unsigned count);

WH_C_END

#endif

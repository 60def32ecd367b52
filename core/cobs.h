/* cobs.h: bytes coded so that none of them is zero, and a zero ends them: consistent overhead byte stuffing (Cheshire &
 * Baker, IEEE/ACM Transactions on Networking 7, 1999), one byte in 254 more; and a sum of 16 bits over short ones.
 *
 * A reader that comes in the middle, or has lost bytes, is in step again after the next zero. */
#ifndef WH_COBS_H
#define WH_COBS_H

#include "real.h"

#ifdef __cplusplus
extern "C" {
#endif

/* So many bytes take at most so many on the line, the zero included. A constant where `count` is. */
#define WH_COBS_BYTES(count) ((count) + (count) / 254U + 2U)

/* Blocks of up to 254 bytes without a zero, each behind a byte that says where the next zero would be. */
typedef struct wh_cobs {
    uint8_t *bytes; /* the caller's, room[] */
    unsigned room;
    unsigned at;   /* the next byte */
    unsigned head; /* the byte in front of this block */
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

/* The zero. Returns how many bytes there are; 0 when there was no room: nothing in them is then of use. */
unsigned wh_cobs_end(wh_cobs *cobs);

/* bytes[1] to bytes[count], of which there are 253 at most, in place: with the head in front of them and the zero behind
 * them. Returns how many there are. */
#define WH_COBS_SHORT_MOST 253U
unsigned wh_cobs_short(uint8_t *bytes, unsigned count);

/* What was coded, without its zero; in place, as what is decoded is never longer. Returns its length; 0 when it was none. */
unsigned wh_cobs_decode(uint8_t *bytes, unsigned length);

/* CRC-16/CCITT of bytes[count], polynomial 0x1021, high bit first; `crc` is WH_CRC16_START, or what the bytes before
 * gave. */
#define WH_CRC16_START 0xFFFFU
uint16_t wh_crc16(uint16_t crc, const uint8_t *bytes, unsigned count);

#ifdef __cplusplus
}
#endif

#endif

/* frame.h: messages over a stream of bytes that may lose, break or invent some: a serial line, a pipe, a file.
 *
 * A frame is, before it is coded, with numbers of several bytes low byte first:
 *
 *     version 1 | kind 1 | sequence 2 | ticks 4 | payload 0 .. | CRC-32 4
 *
 * The CRC is that of IEEE 802.3 over all before it. The whole is coded so that no byte of it is zero, and a zero byte
 * ends it (cobs.h). So a reader that comes in the middle, or has lost bytes, is in step again after the next zero. What does
 * not end in the right CRC is dropped and counted; what it was is not known.
 *
 * No memory but the caller's; the same code on every machine.
 */
#ifndef WH_FRAME_H
#define WH_FRAME_H

#include "real.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Raised whenever the meaning of a frame changes. A reader hands out frames of every version: the caller must look. */
#define WH_FRAME_VERSION 1U

/* Bytes of a frame that are not payload, before it is coded. */
#define WH_FRAME_FIXED_BYTES 12U
/* The most that a frame with so much payload takes on the line, its zero byte included. A constant where `payload` is. */
#define WH_FRAME_BYTES(payload) \
    (WH_FRAME_FIXED_BYTES + (payload) + (WH_FRAME_FIXED_BYTES + (payload)) / 254U + 2U)

typedef struct wh_frame {
    uint8_t version;
    uint8_t kind;      /* what the payload is: the user's */
    uint16_t sequence; /* of the sender, wrapping: a gap tells of lost frames */
    uint32_t ticks;    /* the sender's time */
    const uint8_t *payload;
    unsigned length; /* of the payload */
} wh_frame;

typedef struct wh_frame_reader {
    uint8_t *bytes; /* the caller's, room[] */
    unsigned room;
    unsigned length;  /* of the frame that is under way */
    bool too_long;    /* it is longer than the room: it will be dropped */
    uint32_t dropped; /* frames, or what lay between two zeros and was none; wraps */
} wh_frame_reader;

#define wh_frame_crc WH_NAME(wh_frame_crc)
#define wh_frame_write WH_NAME(wh_frame_write)
#define wh_frame_reader_start WH_NAME(wh_frame_reader_start)
#define wh_frame_take WH_NAME(wh_frame_take)

/* CRC-32 of bytes[count]; `crc` is 0, or what the bytes before gave. */
uint32_t wh_frame_crc(uint32_t crc, const uint8_t *bytes, unsigned count);

/* Write the frame, coded, with the zero that ends it, into bytes[room]; `version` is set by itself. Returns its length;
 * 0 when there is no room: nothing in `bytes` is then of use. */
unsigned wh_frame_write(const wh_frame *frame, uint8_t *bytes, unsigned room);

/* Begin to read. Frames of up to room - 1 coded bytes before their zero are taken: WH_FRAME_BYTES(payload) is enough. */
void wh_frame_reader_start(wh_frame_reader *reader, uint8_t *bytes, unsigned room);

/* The next byte of the line. True when it ends a good frame: *frame is that, its payload in the reader's memory until
 * the next call. */
bool wh_frame_take(wh_frame_reader *reader, uint8_t byte, wh_frame *frame);

/* --- numbers in a payload, low byte first -------------------------------------------------------*/

/* Bytes that are written, or read, one number after the other. Beyond the end nothing is written, zeros are read, and
 * `over` is set. */
typedef struct wh_bytes {
    uint8_t *to;         /* written */
    const uint8_t *from; /* read */
    unsigned room;
    unsigned at;
    bool over;
} wh_bytes;

#define wh_bytes_put WH_NAME(wh_bytes_put)
#define wh_bytes_put_float WH_NAME(wh_bytes_put_float)
#define wh_bytes_put_words WH_NAME(wh_bytes_put_words)
#define wh_bytes_get WH_NAME(wh_bytes_get)
#define wh_bytes_get_float WH_NAME(wh_bytes_get_float)
#define wh_bytes_get_words WH_NAME(wh_bytes_get_words)

/* The low `size` bytes (1 to 4) of a number. */
void wh_bytes_put(wh_bytes *bytes, uint32_t number, unsigned size);
uint32_t wh_bytes_get(wh_bytes *bytes, unsigned size);

/* The 32 bits of a float. */
void wh_bytes_put_float(wh_bytes *bytes, float number);
float wh_bytes_get_float(wh_bytes *bytes);

/* A string with its zero. What is read points into the bytes; "" where none ends there. */
void wh_bytes_put_words(wh_bytes *bytes, const char *words);
const char *wh_bytes_get_words(wh_bytes *bytes);

#ifdef __cplusplus
}
#endif

#endif

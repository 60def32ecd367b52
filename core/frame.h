/* frame.h: messages over a stream of bytes that may lose, corrupt or insert bytes: a serial line, a pipe, a file.
 *
 * A frame before coding, with multi-byte numbers low byte first:
 *
 *     version 1 | kind 1 | sequence 2 | ticks 4 | payload 0 .. | CRC-32 4
 *
 * The CRC is that of IEEE 802.3 over all bytes before it. The coded frame has no zero byte, and a zero byte ends it
 * (cobs.h). So a reader that starts within a frame, or has lost bytes, is synchronized again after the next zero. It
 * drops and counts frames with a wrong CRC. The functions use only the caller's memory. */
#ifndef WH_FRAME_H
#define WH_FRAME_H

#include "real.h"

WH_C_BEGIN

/* Raised whenever the meaning of a frame changes. wh_frame_take() returns frames of all versions, for the caller to
 * check. */
#define WH_FRAME_VERSION 1U

/* Bytes of a frame other than its payload, before coding. */
#define WH_FRAME_FIXED_BYTES 12U
/* Largest coded size of a frame with a payload of this many bytes, including the final zero. */
#define WH_FRAME_BYTES(payload) \
    (WH_FRAME_FIXED_BYTES + (payload) + (WH_FRAME_FIXED_BYTES + (payload)) / 254U + 2U)

typedef struct wh_frame {
    uint8_t version;
    uint8_t kind;      /* kind of payload, defined by the user of this file */
    uint16_t sequence; /* counts this sender's frames, wrapping: a gap shows lost frames */
    uint32_t ticks;    /* the sender's time */
    const uint8_t *payload;
    unsigned length; /* in bytes */
} wh_frame;

typedef struct wh_frame_reader {
    uint8_t *bytes; /* the caller's memory, bytes[room] */
    unsigned room;
    unsigned length;  /* bytes of the frame in progress */
    bool too_long;    /* the frame in progress exceeds `room` and will be dropped */
    uint32_t dropped; /* number of bad frames, wrapping; bytes between two zeros are one frame */
} wh_frame_reader;

#define wh_frame_crc WH_NAME(wh_frame_crc)
#define wh_frame_write WH_NAME(wh_frame_write)
#define wh_frame_reader_start WH_NAME(wh_frame_reader_start)
#define wh_frame_take WH_NAME(wh_frame_take)

/* CRC-32 of bytes[count]. `crc` is 0, or the CRC of the preceding bytes. */
uint32_t wh_frame_crc(uint32_t crc, const uint8_t *bytes, unsigned count);

/* Write the coded frame with its final zero into bytes[room], with version WH_FRAME_VERSION. Returns the coded length;
 * 0 if it does not fit, and then `bytes` is invalid. */
unsigned wh_frame_write(const wh_frame *frame, uint8_t *bytes, unsigned room);

/* Begin to read frames, with the memory bytes[room]. WH_FRAME_BYTES(n) is enough for payloads of up to n bytes. */
void wh_frame_reader_start(wh_frame_reader *reader, uint8_t *bytes, unsigned room);

/* Process the next byte. Returns true if it ends a good frame: *frame is then that frame, and its payload stays in the
 * reader's memory until the next call. */
bool wh_frame_take(wh_frame_reader *reader, uint8_t byte, wh_frame *frame);

/* --- numbers in a payload, low byte first -------------------------------------------------------*/

/* A cursor in a payload. Beyond the payload's end, writing does nothing and reading gives zeros; both set `over`. */
typedef struct wh_bytes {
    uint8_t *to;         /* for writing */
    const uint8_t *from; /* for reading */
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

/* Write or read a number's low `size` bytes (1 to 4). */
void wh_bytes_put(wh_bytes *bytes, uint32_t number, unsigned size);
uint32_t wh_bytes_get(wh_bytes *bytes, unsigned size);

void wh_bytes_put_float(wh_bytes *bytes, float number);
float wh_bytes_get_float(wh_bytes *bytes);

/* Write or read a string with its final zero. Reading returns a pointer into the payload; "" if the zero is missing. */
void wh_bytes_put_words(wh_bytes *bytes, const char *words);
const char *wh_bytes_get_words(wh_bytes *bytes);

WH_C_END

#endif

/* test_frame.c: framing: frames are read as written, broken frames are dropped, and the next frame is read again. */
#include "core/frame.h"

#include "draw.h"
#include "tests/suites.h"

/* The payload is longer than two COBS blocks of 254 bytes (core/cobs.h); on an AVR, longer than one. */
#if defined(__AVR__)
enum { PAYLOAD_BYTES = 280 };
#else
enum { PAYLOAD_BYTES = 520 };
#endif
enum { LINE_BYTES = WH_FRAME_BYTES(PAYLOAD_BYTES) };

static uint8_t payload[PAYLOAD_BYTES];
static uint8_t line[LINE_BYTES];
static uint8_t room[LINE_BYTES];
static wh_frame_reader reader;
static wh_frame got;
static uint64_t seed;

/* Fills a payload with random bytes, with many zeros, or without zeros. */
static void fill(unsigned length, unsigned kind) {
    for (unsigned i = 0; i < length; i++) {
        const uint8_t byte = (uint8_t)draw_bits(&seed);
        payload[i] = kind == 0 ? byte : kind == 1 ? (uint8_t)(byte & 1U) : (uint8_t)(byte | 1U);
    }
}

static unsigned code_frame(unsigned length, uint16_t sequence) {
    const wh_frame frame = {.kind = (uint8_t)(length % 7U),
                            .sequence = sequence,
                            .ticks = 0xFFFFFF00U + length,
                            .payload = payload,
                            .length = length};
    return wh_frame_write(&frame, line, sizeof line);
}

/* Reads bytes[count]. Returns the number of frames; the last is in `got`. */
static unsigned feed(const uint8_t *bytes, unsigned count) {
    unsigned frames = 0;
    for (unsigned i = 0; i < count; i++) {
        frames += wh_frame_take(&reader, bytes[i], &got);
    }
    return frames;
}

static void expect_same(unsigned length, uint16_t sequence) {
    TEST_ASSERT_EQUAL_UINT(WH_FRAME_VERSION, got.version);
    TEST_ASSERT_EQUAL_UINT(length % 7U, got.kind);
    TEST_ASSERT_EQUAL_UINT(sequence, got.sequence);
    TEST_ASSERT_EQUAL_UINT32(0xFFFFFF00U + length, got.ticks);
    TEST_ASSERT_EQUAL_UINT(length, got.length);
    if (length > 0) {
        TEST_ASSERT_EQUAL_UINT8_ARRAY(payload, got.payload, length);
    }
}

/* The standard check value of this CRC. */
TEST(frame, crc) {
    const uint8_t digits[9] = {'1', '2', '3', '4', '5', '6', '7', '8', '9'};
    TEST_ASSERT_EQUAL_HEX32(0xCBF43926U, wh_frame_crc(0, digits, 9));
    TEST_ASSERT_EQUAL_HEX32(0xCBF43926U, wh_frame_crc(wh_frame_crc(0, digits, 4), digits + 4, 5));
    TEST_ASSERT_EQUAL_HEX32(0U, wh_frame_crc(0, digits, 0));
}

/* Payloads of every length and kind: the frame is read as written, has no zero inside, and is not longer than
 * WH_FRAME_BYTES(). */
TEST(frame, round_trip) {
    seed = 1;
    for (unsigned length = 0; length <= PAYLOAD_BYTES; length++) {
        fill(length, length % 3U);
        const unsigned count = code_frame(length, (uint16_t)(length * 131U));
        TEST_ASSERT_TRUE(count > length + WH_FRAME_FIXED_BYTES && count <= WH_FRAME_BYTES(length));
        for (unsigned i = 0; i + 1U < count; i++) {
            TEST_ASSERT_TRUE(line[i] != 0);
        }
        TEST_ASSERT_EQUAL_UINT(0, line[count - 1U]);
        /* Room for the coded frame without its final zero. */
        wh_frame_reader_start(&reader, room, WH_FRAME_BYTES(length) - 1U);
        TEST_ASSERT_EQUAL_UINT(1, feed(line, count));
        expect_same(length, (uint16_t)(length * 131U));
        TEST_ASSERT_EQUAL_UINT(0, reader.dropped);
    }
}

/* With one byte too little the function returns 0 and writes nothing beyond the buffer. */
TEST(frame, no_room) {
    seed = 2;
    for (unsigned length = 0; length <= PAYLOAD_BYTES; length += 13) {
        fill(length, length % 3U);
        const unsigned count = code_frame(length, 1);
        const wh_frame frame = {
            .payload = payload, .length = length, .kind = (uint8_t)(length % 7U)};
        for (unsigned given = 0; given < count; given += 1U + given / 5U) {
            room[given] = 0xA5;
            TEST_ASSERT_EQUAL_UINT(0, wh_frame_write(&frame, room, given));
            TEST_ASSERT_EQUAL_HEX8(0xA5, room[given]);
        }
        wh_frame_reader_start(&reader, room, count - 2U);
        TEST_ASSERT_EQUAL_UINT(0, feed(line, count));
        TEST_ASSERT_EQUAL_UINT(1, reader.dropped);
    }
}

/* Every flipped bit, and bursts of up to 32 bits, are detected, even if they move the end of the frame. The next frame
 * is read. */
TEST(frame, flips) {
    seed = 3;
    for (unsigned length = 0; length < 64; length += 9) {
        fill(length, length % 3U);
        const unsigned count = code_frame(length, 7);
        for (unsigned bit = 0; bit < 8U * (count - 1U); bit++) {
            wh_frame_reader_start(&reader, room, sizeof room);
            line[bit / 8U] = (uint8_t)(line[bit / 8U] ^ 1U << bit % 8U);
            TEST_ASSERT_EQUAL_UINT(0, feed(line, count));
            TEST_ASSERT_TRUE(reader.dropped >= 1);
            line[bit / 8U] = (uint8_t)(line[bit / 8U] ^ 1U << bit % 8U);
            TEST_ASSERT_EQUAL_UINT(1, feed(line, count));
            expect_same(length, 7);
        }
    }
}

/* Frames with missing bytes are rejected. If a frame breaks off before its final zero, the next frame is lost, too.
 * The frame after that is read. */
TEST(frame, truncations) {
    seed = 4;
    for (unsigned round = 0; round < 300; round++) {
        const unsigned length = (unsigned)(draw_bits(&seed) % (PAYLOAD_BYTES / 2U));
        fill(length, round % 3U);
        const unsigned count = code_frame(length, (uint16_t)round);
        const unsigned from = (unsigned)(draw_bits(&seed) % count);
        const unsigned gone = 1U + (unsigned)(draw_bits(&seed) % (count - from));
        wh_frame_reader_start(&reader, room, sizeof room);
        unsigned frames = feed(line, from);
        frames += feed(line + from + gone, count - from - gone);
        TEST_ASSERT_EQUAL_UINT(0, frames);
        const unsigned next = feed(line, count);
        const bool stuck = from > 0 && from + gone == count;
        TEST_ASSERT_EQUAL_UINT(stuck ? 0 : 1, next);
        TEST_ASSERT_EQUAL_UINT(1, feed(line, count));
        expect_same(length, (uint16_t)round);
    }
}

/* In random bytes no frame is found (one in 2^32 would pass the CRC), nothing overflows, and the first frame after a
 * zero is read. */
TEST(frame, noise) {
    seed = 5;
    for (unsigned size = 1; size <= 64; size *= 4) {
        wh_frame_reader_start(&reader, room, size);
        for (unsigned i = size; i < sizeof room; i++) {
            room[i] = 0xA5;
        }
        for (unsigned i = 0; i < 20000; i++) {
            const uint8_t byte = (uint8_t)draw_bits(&seed);
            TEST_ASSERT_FALSE(wh_frame_take(&reader, i % 3U == 0 ? byte & 15U : byte, &got));
        }
        for (unsigned i = size; i < sizeof room; i++) {
            TEST_ASSERT_EQUAL_HEX8(0xA5, room[i]);
        }
        TEST_ASSERT_TRUE(reader.dropped > 100);
    }
    wh_frame_reader_start(&reader, room, sizeof room);
    for (unsigned i = 0; i < 5000; i++) {
        (void)wh_frame_take(&reader, (uint8_t)draw_bits(&seed), &got);
    }
    const uint8_t zero = 0;
    TEST_ASSERT_EQUAL_UINT(0, feed(&zero, 1));
    fill(40, 0);
    TEST_ASSERT_EQUAL_UINT(1, feed(line, code_frame(40, 9)));
    expect_same(40, 9);
}

/* A frame with another version is returned, with its version. */
TEST(frame, version) {
    uint8_t raw[WH_FRAME_FIXED_BYTES + 2U] = {1, WH_FRAME_VERSION + 1U, 3, 1, 1, 1, 1, 1, 1};
    const uint32_t crc = wh_frame_crc(0, raw + 1, 8);
    unsigned at = 9;
    for (unsigned i = 0; i < 4; i++) {
        raw[at++] = (uint8_t)(crc >> 8U * i);
    }
    raw[0] = (uint8_t)at; /* one block: none of its bytes is zero */
    raw[at++] = 0;
    for (unsigned i = 0; i + 1U < at; i++) {
        TEST_ASSERT_TRUE(raw[i] != 0);
    }
    wh_frame_reader_start(&reader, room, sizeof room);
    TEST_ASSERT_EQUAL_UINT(1, feed(raw, at));
    TEST_ASSERT_EQUAL_UINT(WH_FRAME_VERSION + 1U, got.version);
    TEST_ASSERT_EQUAL_UINT(0, got.length);
}

TEST(frame, numbers) {
    static const float numbers[] = {0.0f, -0.0f, 1.5f, -3.0e-40f, 3.0e38f};
    uint8_t bytes[64];
    wh_bytes out = {.to = bytes, .room = sizeof bytes};
    for (unsigned i = 0; i < 5; i++) {
        wh_bytes_put_float(&out, numbers[i]);
    }
    wh_bytes_put(&out, 0x12345678U, 3);
    wh_bytes_put_words(&out, "duty");
    wh_bytes_put_words(&out, "");
    TEST_ASSERT_FALSE(out.over);
    TEST_ASSERT_EQUAL_HEX8(0x78, bytes[20]); /* low byte first */
    wh_bytes in = {.from = bytes, .room = out.at};
    for (unsigned i = 0; i < 5; i++) {
        const float number = wh_bytes_get_float(&in);
        TEST_ASSERT_EQUAL_INT(0, __builtin_memcmp(&number, &numbers[i], sizeof number));
    }
    TEST_ASSERT_EQUAL_HEX32(0x345678U, wh_bytes_get(&in, 3));
    TEST_ASSERT_EQUAL_STRING("duty", wh_bytes_get_words(&in));
    TEST_ASSERT_EQUAL_STRING("", wh_bytes_get_words(&in));
    TEST_ASSERT_FALSE(in.over);
    TEST_ASSERT_EQUAL_STRING("", wh_bytes_get_words(&in));
    TEST_ASSERT_TRUE(in.over);
    wh_bytes little = {.to = bytes, .room = 3};
    wh_bytes_put(&little, 1, 4);
    TEST_ASSERT_TRUE(little.over && little.at == 0);
}

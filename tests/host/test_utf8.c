/* test_utf8.c: all pairs of first bytes, with what stands behind them at the limits of their ranges and any number of bytes
 * left, against arithmetic: the code point that the bytes spell, and the shortest spelling of it. */
#include "host/base/utf8.h"

#include <stdint.h>

#include "unity.h"

void suite_utf8(void);

/* Bytes that a code point is spelled with, or 0 for what is none that may be printed: surrogates, what lies behind the last
 * one, and the controls above ASCII. */
static unsigned shortest(uint32_t point) {
    if (point > 0x10ffffU || (point >= 0xd800U && point <= 0xdfffU) ||
        (point >= 0x80U && point <= 0x9fU)) {
        return 0;
    }
    const unsigned bits[] = {7, 11, 16, 21};
    unsigned bytes = 1;
    while (point >> bits[bytes - 1] != 0) {
        bytes++;
    }
    return bytes;
}

/* What the bytes spell: the ones that the first begins with say how many there are. */
static unsigned expected(const unsigned char *text, unsigned left) {
    unsigned ones = 0;
    while (ones < 8 && (text[0] & (0x80U >> ones)) != 0) {
        ones++;
    }
    if (ones == 0) {
        return 1;
    }
    if (ones == 1 || ones > 4 || ones > left) {
        return 0;
    }
    uint32_t point = text[0] & (0x7fU >> ones);
    for (unsigned i = 1; i < ones; i++) {
        if (text[i] >> 6 != 2) {
            return 0;
        }
        point = point << 6 | (text[i] & 0x3fU);
    }
    return shortest(point) == ones ? ones : 0;
}

static void test_every_pair_of_bytes(void) {
    static const unsigned char edges[] = {0x00, 0x7f, 0x80, 0xbf, 0xc0};
    unsigned wrong = 0;
    unsigned characters = 0;
    for (unsigned pair = 0; pair < 0x10000U; pair++) {
        for (unsigned i = 0; i < sizeof edges * sizeof edges; i++) {
            const unsigned char text[] = {(unsigned char)(pair >> 8), (unsigned char)(pair & 0xffU),
                                          edges[i / sizeof edges], edges[i % sizeof edges]};
            for (unsigned left = 1; left <= sizeof text; left++) {
                const unsigned bytes = expected(text, left);
                wrong += utf8_length((const char *)text, left) != bytes;
                characters += bytes > 1;
            }
        }
    }
    TEST_ASSERT_EQUAL_UINT(0, wrong);
    TEST_ASSERT_GREATER_THAN_UINT(100000, characters);
}

void suite_utf8(void) { RUN_TEST(test_every_pair_of_bytes); }

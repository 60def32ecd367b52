/* test_station_line.c: splits bytes into lines, and lines into words and numbers. */
#include "core/station/line.h"
#include "core/text.h"
#include "draw.h"
#include "tests/suites.h"

static wh_line line;
static uint64_t seed;

static wh_line_event take(const char *bytes) {
    wh_line_event last = WH_LINE_NOTHING;
    for (; *bytes != '\0'; bytes++) {
        const wh_line_event event = wh_line_take(&line, *bytes);
        last = event != WH_LINE_NOTHING ? event : last;
    }
    return last;
}

TEST(station_line, three_line_endings) {
    static const char *const ends[] = {"\r", "\n", "\r\n"};
    for (unsigned i = 0; i < 9; i++) {
        line = (wh_line){.length = 0};
        for (unsigned k = 0; k < 3; k++) { /* every kind of line end follows every kind */
            TEST_ASSERT_TRUE(take(k == 0 ? "arm" : "start 330") == WH_LINE_NOTHING);
            TEST_ASSERT_TRUE(take(ends[k == 1U ? i % 3U : i / 3U]) == WH_LINE_WHOLE);
            TEST_ASSERT_EQUAL_STRING(k == 0 ? "arm" : "start 330", line.text);
        }
    }
    line = (wh_line){.length = 0};
    TEST_ASSERT_TRUE(take("\r") == WH_LINE_WHOLE && line.length == 0); /* an empty line is a line */
    TEST_ASSERT_TRUE(take("\n") == WH_LINE_NOTHING);
    TEST_ASSERT_TRUE(take("\n") == WH_LINE_WHOLE);
}

TEST(station_line, typing_errors_are_taken_back) {
    line = (wh_line){.length = 0};
    TEST_ASSERT_TRUE(take("\b\x7fstat\brt 33\x7f\x7f"
                          "170\n") == WH_LINE_WHOLE);
    TEST_ASSERT_EQUAL_STRING("start 170", line.text);
}

TEST(station_line, escape_discards_the_line) {
    static const char *const keys[] = {"\x1b", "\x1b[A", "\x1bOP", "\x1b[15~", "\x1b[1;5C"};
    for (unsigned i = 0; i < 5; i++) {
        line = (wh_line){.length = 0};
        take("half a li");
        TEST_ASSERT_TRUE(take(keys[i]) == WH_LINE_ESCAPE);
        TEST_ASSERT_TRUE(take("stop\n") == WH_LINE_WHOLE);
        TEST_ASSERT_EQUAL_STRING("stop", line.text);
    }
}

TEST(station_line, invalid_lines_are_refused) {
    char bytes[WH_LINE_MOST + 3U];
    for (unsigned length = WH_LINE_MOST - 1U; length <= WH_LINE_MOST + 1U; length++) {
        line = (wh_line){.length = 0};
        for (unsigned i = 0; i < length; i++) {
            bytes[i] = 'x';
        }
        bytes[length] = '\n';
        bytes[length + 1U] = '\0';
        TEST_ASSERT_TRUE(take(bytes) == (length <= WH_LINE_MOST ? WH_LINE_WHOLE : WH_LINE_BAD));
        TEST_ASSERT_TRUE(take("arm\n") == WH_LINE_WHOLE); /* the line after a bad one is read */
        TEST_ASSERT_EQUAL_STRING("arm", line.text);
    }
    for (unsigned byte = 1; byte < 256U; byte++) {
        const bool edits = byte == 8U || byte == 0x7FU || byte == 0x1BU;
        const bool ends = byte == '\r' || byte == '\n';
        const bool is_text = byte == '\t' || (byte >= 0x20U && byte < 0x7FU);
        line = (wh_line){.length = 0};
        const char odd[] = {'a', (char)byte, 'b', '\n', '\0'};
        if (!edits && !ends) {
            TEST_ASSERT_TRUE(take(odd) == (is_text ? WH_LINE_WHOLE : WH_LINE_BAD));
        }
    }
}

/* Random bytes: nothing is written beyond the line, and each line end counts once. */
TEST(station_line, any_bytes) {
    seed = 3;
    line = (wh_line){.length = 0};
    unsigned whole = 0;
    for (uint32_t i = 0; i < 60000U; i++) {
        const unsigned kind = draw_one_of(&seed, 40);
        const char byte = (char)(kind == 0   ? '\n'
                                 : kind == 1 ? 0x1B
                                 : kind < 5  ? (int)draw_one_of(&seed, 256)
                                             : 'a' + (int)draw_one_of(&seed, 26));
        const wh_line_event event = wh_line_take(&line, byte);
        TEST_ASSERT_TRUE(line.length <= WH_LINE_MOST && line.text[line.length] == '\0');
        TEST_ASSERT_TRUE(event != WH_LINE_WHOLE || byte == '\n' || byte == '\r');
        whole += event == WH_LINE_WHOLE ? 1U : 0U;
    }
    TEST_ASSERT_TRUE(whole > 500U);
}

TEST(station_line, words) {
    char text[] = "  conf \t set  speed 330 now ";
    wh_words words;
    wh_line_split(&words, text);
    TEST_ASSERT_EQUAL_UINT(5, words.count);
    TEST_ASSERT_EQUAL_STRING("conf", words.word[0]);
    TEST_ASSERT_EQUAL_STRING("set", words.word[1]);
    TEST_ASSERT_EQUAL_STRING("speed", words.word[2]);
    TEST_ASSERT_EQUAL_STRING("330", words.word[3]);
    char none[] = " \t ";
    wh_line_split(&words, none);
    TEST_ASSERT_EQUAL_UINT(0, words.count);
    TEST_ASSERT_EQUAL_STRING("", words.word[0]);
}

/* A whole number and a fraction are written as text. The text must be read as their sum. */
TEST(station_line, numbers_drawn) {
    static const uint32_t tens[] = {1, 10, 100, 1000, 10000};
    seed = 7;
    for (unsigned i = 0; i < 2000U; i++) {
        char bytes[24];
        wh_text text;
        wh_text_start(&text, bytes, sizeof bytes);
        const unsigned decimals = draw_one_of(&seed, 5);
        const uint32_t whole = (uint32_t)(draw_bits(&seed) % 10000U);
        const uint32_t part = (uint32_t)(draw_bits(&seed) % tens[decimals]);
        const bool negative = draw_one_in(&seed, 2);
        wh_text_add(&text, negative ? "-" : draw_one_in(&seed, 2) ? "+" : "");
        wh_text_add_unsigned(&text, whole);
        wh_text_add(&text, decimals > 0 || draw_one_in(&seed, 2) ? "." : "");
        for (unsigned digit = decimals; digit > 0; digit--) {
            wh_text_add_unsigned(&text, part / tens[digit - 1U] % 10U);
        }
        const wh_real size = (wh_real)whole + (wh_real)part / (wh_real)tens[decimals];
        wh_real found = WH_R(0.0);
        TEST_ASSERT_TRUE(wh_line_number(bytes, &found));
        CHECK_NEAR(2e-7f * (float)size, negative ? -(float)size : (float)size, found);
    }
}

TEST(station_line, invalid_numbers_are_refused) {
    static const char *const none[] = {"",    "-",          "+",   ".",    "-.",  "3-",
                                       "--3", "3..1",       "1e3", "0x10", "nan", "inf",
                                       "3,5", "1234567890", "33O", "3 "};
    for (unsigned i = 0; i < sizeof none / sizeof none[0]; i++) {
        wh_real found = WH_R(0.0);
        TEST_ASSERT_FALSE(wh_line_number(none[i], &found));
    }
}

/* test_packed_words.c: words that are packed, back to text. How they are packed: tests/cli/packed_words.sh. */
#include "core/packed_words.h"

#include "core/word_pairs.h"
#include "tests/scattered.h"
#include "unity.h"

void suite_packed_words(void);

#define PAIR(number, left, right) {number, left, right},
static const uint8_t rows[][3] = {WH_WORD_PAIR_ROWS(PAIR)};
#define ROWS (sizeof rows / sizeof rows[0])
#define FIRST 128U

/* What a byte stands for, found another way: pairs are put in the place of the last ones, until there are none. */
static unsigned spread(const char *packed, char *bytes) {
    unsigned count = 0;
    for (; packed[count] != '\0'; count++) {
        bytes[count] = packed[count];
    }
    for (unsigned row = ROWS; row-- > 0;) {
        for (unsigned i = 0; i < count; i++) {
            if ((uint8_t)bytes[i] == rows[row][0]) {
                for (unsigned k = count++; k > i; k--) {
                    bytes[k] = bytes[k - 1U];
                }
                bytes[i] = (char)rows[row][1];
                bytes[i + 1U] = (char)rows[row][2];
            }
        }
    }
    bytes[count] = '\0';
    return count;
}

static void test_rows_are_of_rows_before(void) {
    unsigned deep[FIRST + ROWS];
    for (unsigned i = 0; i < FIRST; i++) {
        deep[i] = 0;
    }
    for (unsigned i = 0; i < ROWS; i++) {
        TEST_ASSERT_EQUAL_UINT(FIRST + i, rows[i][0]);
        const unsigned left = rows[i][1];
        const unsigned right = rows[i][2];
        TEST_ASSERT_TRUE(left < FIRST + i && right < FIRST + i && left >= ' ' && right >= ' ');
        deep[FIRST + i] = 1U + (deep[left] > deep[right] ? deep[left] : deep[right]);
        TEST_ASSERT_TRUE(deep[FIRST + i] <= WH_WORD_PAIRS_DEEP);
    }
}

#define MOST 6U

static void test_any_bytes_unpack(void) {
    scattered_state = 29;
    for (unsigned i = 0; i < 2000; i++) {
        char packed[MOST + 1U];
        char wanted[256];
        char bytes[256];
        wh_text text;
        const unsigned count = i < ROWS ? 1U : (unsigned)(scattered() >> 40) % (MOST + 1U);
        for (unsigned k = 0; k < count; k++) {
            const unsigned any = 1U + (unsigned)(scattered() >> 40) % (FIRST + ROWS - 1U);
            packed[k] = (char)(i < ROWS ? FIRST + i : any); /* each alone, first */
        }
        packed[count] = '\0';
        wh_text_start(&text, bytes, sizeof bytes);
        wh_text_add(&text, "# ");
        wh_words_unpack(&text, packed);
        TEST_ASSERT_EQUAL_UINT(2U + spread(packed, wanted), text.length);
        TEST_ASSERT_EQUAL_STRING(wanted, bytes + 2);
        TEST_ASSERT_FALSE(text.truncated);
    }
}

/* No byte beyond the room, whatever is cut off. */
static void test_what_does_not_fit_is_cut(void) {
    for (unsigned size = 1; size < 40; size++) {
        const char packed[] = {'a', (char)(FIRST + ROWS - 1U), 'b', (char)(FIRST + 4U), 'c', '\0'};
        char wanted[256];
        char bytes[64];
        wh_text text;
        const unsigned all = spread(packed, wanted);
        for (unsigned i = 0; i < sizeof bytes; i++) {
            bytes[i] = '~';
        }
        wh_text_start(&text, bytes, size);
        wh_words_unpack(&text, packed);
        TEST_ASSERT_EQUAL_UINT(all < size ? all : size - 1U, text.length);
        TEST_ASSERT_TRUE(text.truncated == (all >= size) && bytes[size] == '~');
        wanted[text.length] = '\0';
        TEST_ASSERT_EQUAL_STRING(wanted, bytes);
    }
}

static void test_words_are_as_they_are_written(void) {
    char bytes[40];
    wh_text text;
    wh_text_start(&text, bytes, sizeof bytes);
    wh_words_unpack(&text, "the rig is not armed");
    TEST_ASSERT_EQUAL_STRING("the rig is not armed", bytes);
}

void suite_packed_words(void) {
    RUN_TEST(test_rows_are_of_rows_before);
    RUN_TEST(test_any_bytes_unpack);
    RUN_TEST(test_what_does_not_fit_is_cut);
    RUN_TEST(test_words_are_as_they_are_written);
}

/* test_allocations.c: allocations. The sanitizers, which run the other suites, find leaks. */
#include "command.h"
#include "host/base/alloc.h"
#include "host/base/exit.h"

/* Allocations must have the full size, and zeros if these are promised. A size that is impossible, for whatever
 * reason, must end the program with its message. */
enum { BYTES_MOST = 5000 };

static bool all_are(const unsigned char *bytes, size_t count, unsigned char value) {
    for (size_t i = 0; i < count; i++) {
        if (bytes[i] != value) {
            return false;
        }
    }
    return true;
}

TEST(allocations, allocations_of_random_sizes) {
    dice d = dice_of("room", 2511);
    for (unsigned i = 0; i < 200; i++) {
        const size_t size = 1U + dice_one_of(&d, 40);
        const size_t head = dice_one_of(&d, 60);
        const int64_t count = (int64_t)dice_one_of(&d, 100);
        const size_t bytes = size * (size_t)count;
        unsigned char *plain = alloc(count, size);
        unsigned char *tail = alloc_tail(head + 1, count, size);
        TEST_ASSERT_TRUE(all_are(plain, bytes, 0));
        TEST_ASSERT_TRUE(all_are(tail, head + 1 + bytes, 0));
        memset(plain, 7, bytes);
        memset(tail, 9, head + 1 + bytes);
        plain = alloc_more(plain, count + 1 + (int64_t)dice_one_of(&d, 100), size);
        TEST_ASSERT_TRUE(all_are(plain, bytes, 7));
        char *copy = alloc_copy((const char *)plain, bytes);
        TEST_ASSERT_TRUE(all_are((const unsigned char *)copy, bytes, 7));
        TEST_ASSERT_EQUAL_CHAR('\0', copy[bytes]);
        free(copy);
        free(tail);
        free(plain);
    }
}

TEST(allocations, words_of_any_length) {
    for (int length = 0; length < BYTES_MOST; length = length * 5 / 4 + 1) {
        char *words = alloc_words("%*s|%d", length, "", length);
        TEST_ASSERT_EQUAL_INT('|', words[length]);
        TEST_ASSERT_EQUAL_INT(length, (int)strtol(words + length + 1, NULL, 10));
        TEST_ASSERT_EQUAL_size_t((size_t)length, strspn(words, " "));
        free(words);
    }
}

TEST(allocations, texts_of_any_length) {
    for (int length = 0; length < BYTES_MOST; length = length * 5 / 4 + 1) {
        char *text = NULL;
        size_t bytes = 0;
        FILE *to = alloc_text(&text, &bytes);
        fprintf(to, "%*s|", length, "");
        alloc_text_end(to);
        TEST_ASSERT_EQUAL_size_t((size_t)length + 1U, bytes);
        TEST_ASSERT_EQUAL_size_t(bytes, strlen(text));
        TEST_ASSERT_EQUAL_INT('|', text[length]);
        free(text);
    }
}

/* Half of SIZE_MAX, rounded up: twice this number overflows to 0. */
#define HALF (SIZE_MAX / 2U + 1U)

/* The address sanitizer itself ends a program that requests an impossible size. */
#if defined(__SANITIZE_ADDRESS__)
#define SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define SANITIZED 1
#endif
#endif

static void end_badly(const char *name, const char *mode) {
    FILE *to = fopen(name, mode);
    if (to != NULL) {
        fputs("text", to);
        alloc_text_end(to);
    }
}

/* Impossible requests: negative counts, products and sums that overflow size_t, and sizes that the heap refuses. */
static int ask(int count, char **words) {
    (void)count;
    void *made = NULL;
    switch (words[0][0]) {
    case 'a': made = alloc(-1, 8); break;
    case 'b': made = alloc_more(NULL, -1, 8); break;
    case 'c': made = alloc_tail(8, -1, 8); break;
    case 'd': made = alloc_copy("", SIZE_MAX); break;
    case 'e': made = alloc_more(NULL, 2, HALF + 4U); break;
    case 'f': made = alloc_tail(8, 2, HALF + 4U); break;
    case 'g': made = alloc_tail(SIZE_MAX - 7U, 2, 8); break;
#ifndef SANITIZED
    case 'h': made = alloc(INT64_MAX, 1); break;
    case 'i': made = alloc_more(NULL, INT64_MAX, 1); break;
    case 'j': made = alloc_tail(0, INT64_MAX, 1); break;
    case 'k': made = alloc_copy("", HALF); break;
    case 'l': made = alloc(3, HALF); break;
#endif
    /* streams with a write error, which shows when they are closed or before */
    case 'm': end_badly("/dev/full", "w"); break;
    case 'n': end_badly("/dev/null", "r"); break;
    default: return 0;
    }
    free(made);
    return 0;
}

#ifdef SANITIZED
#define ASKED "abcdefgmn"
#else
#define ASKED "abcdefghijklmn"
#endif

TEST(allocations, impossible_sizes_end_the_program) {
    static const char asked[] = ASKED "-";
    for (size_t i = 0; asked[i] != '\0'; i++) {
        const char word[] = {asked[i], '\0'};
        const char *const words[] = {word, NULL};
        const bool ends = asked[i] != '-';
        said what;
        command_say(ask, words, &what);
        TEST_ASSERT_EQUAL_INT_MESSAGE(ends ? EXIT_RUN_FAILED : 0, what.status, word);
        TEST_ASSERT_EQUAL_STRING_MESSAGE(ends ? "whirl: out of memory\n" : "", what.err, word);
    }
}

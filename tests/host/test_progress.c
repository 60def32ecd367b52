/* test_progress.c: the line that shows how far a sweep has got (host/sweep/progress.h), read again: what is done, the bar,
 * how fast, and how long it will take at that pace. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "host/base/room.h"
#include "host/sweep/progress.h"
#include "unity.h"

void suite_progress(void);

static char *shown;
static size_t length;

/* As if it had begun so long ago. */
static progress begun(double ago_s, uint64_t from, uint64_t end) {
    progress p = progress_start(room_text(&shown, &length), from, end);
    p.start_s -= ago_s;
    return p;
}

static void finish(progress *p) {
    room_text_end(p->out);
    free(shown);
}

static unsigned filled(const char *bar, size_t *width) {
    *width = strcspn(bar, "]");
    return (unsigned)strspn(bar, "#");
}

static void test_what_is_shown(void) {
    dice d = dice_of("progress", 71);
    for (unsigned i = 0; i < 200U; i++) {
        const uint64_t end = 1U + dice_one_of(&d, 100000);
        const uint64_t from = dice_one_of(&d, (unsigned)end);
        const uint64_t done = from + dice_one_of(&d, (unsigned)(end - from) + 1U);
        const double took_s = exp(dice_between(&d, -1.0, 6.0));
        const double part = (double)done / (double)end;
        progress p = begun(took_s, from, end);
        progress_show(&p, done);
        TEST_ASSERT_TRUE(p.drawn);
        char counts[60];
        size_t width;
        double number;
        const char *at = said_number(shown + 1, &number);
        TEST_ASSERT_EQUAL_CHAR('\r', shown[0]);
        TEST_ASSERT_DOUBLE_WITHIN(0.0501, 100.0 * part, number);
        at = said_words(at, "% [");
        const unsigned marks = filled(at, &width);
        TEST_ASSERT_TRUE(fabs((double)marks - part * (double)width) <= 1.0);
        TEST_ASSERT_TRUE(marks == width || done < end);
        TEST_ASSERT_TRUE(marks > 0 || done == 0);
        TEST_ASSERT_EQUAL_size_t(width - marks, strspn(at + marks, "."));
        snprintf(counts, sizeof counts, " %llu/%llu", (unsigned long long)done,
                 (unsigned long long)end);
        at += width + 1;
        TEST_ASSERT_EQUAL_STRING_LEN(counts, at, strlen(counts));
        at += strlen(counts);
        if (done == from) {
            TEST_ASSERT_EQUAL_STRING("", at); /* no pace yet */
        } else {
            double rate;
            double hours;
            double minutes;
            double seconds;
            at = said_words(said_number(at, &rate), "points/s");
            at = said_exactly(said_number(said_exactly(said_number(at, &hours), ":"), &minutes),
                              ":");
            at = said_words(said_number(at, &seconds), "to go");
            const double left_s = took_s * (double)(end - done) / (double)(done - from);
            TEST_ASSERT_DOUBLE_WITHIN(0.006 * rate, (double)(done - from) / took_s, rate);
            TEST_ASSERT_TRUE(minutes < 60.0 && seconds < 60.0);
            TEST_ASSERT_DOUBLE_WITHIN(1.01 + 1e-3 * left_s, left_s,
                                      3600.0 * hours + 60.0 * minutes + seconds);
        }
        finish(&p);
    }
}

/* Not again at once; nothing of nothing is all of it; and where nobody looks nothing is drawn. */
static void test_when_it_is_shown(void) {
    progress p = begun(1.0, 0, 0);
    progress_show(&p, 0);
    TEST_ASSERT_NOT_NULL(strstr(shown, "100.0 %"));
    TEST_ASSERT_NOT_NULL(strstr(shown, "0/0"));
    const size_t once = length;
    progress_show(&p, 0);
    fflush(p.out);
    TEST_ASSERT_EQUAL_size_t(once, length);
    progress_clear(&p);
    TEST_ASSERT_FALSE(p.drawn);
    TEST_ASSERT_TRUE(length > once && shown[length - 1] == '\r');
    TEST_ASSERT_EQUAL_CHAR('\r', shown[once]);
    TEST_ASSERT_TRUE(strspn(shown + once + 1, " ") >=
                     once - 1); /* all of the line is blank again */
    const size_t cleared = length;
    progress_clear(&p);
    fflush(p.out);
    TEST_ASSERT_EQUAL_size_t(cleared, length);
    p.shown_s -= 0.25;
    progress_show(&p, 0);
    TEST_ASSERT_TRUE(p.drawn && length > cleared);
    finish(&p);
    progress unseen = progress_start(NULL, 0, 10);
    progress_show(&unseen, 5);
    progress_clear(&unseen);
    TEST_ASSERT_FALSE(unseen.drawn);
    TEST_ASSERT_TRUE(progress_elapsed_s(&unseen) >= 0.0 && progress_elapsed_s(&unseen) < 60.0);
}

void suite_progress(void) {
    RUN_TEST(test_what_is_shown);
    RUN_TEST(test_when_it_is_shown);
}

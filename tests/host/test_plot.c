/* test_plot.c: what reaches gnuplot is text and no command, and stands in the picture as it was given: generated
 * names, titles and units of what gnuplot, a shell or XML could take for their own. */
#include "host/plot/plot.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "command.h"
#include "host/plot/gnuplot.h"
#include "host/plot/scatter.h"
#include "unity.h"

void suite_plot(void);

#define PICTURE "build/tests/drawn.svg"
#define MADE "build/tests/made" /* what a command would make */

static const char *const pieces[] = {"`touch build/tests/made`",
                                     "'.system('touch build/tests/made').'",
                                     "\n!touch build/tests/made\n",
                                     "$(touch build/tests/made)",
                                     "\"`touch build/tests/made`\"",
                                     "\\",
                                     "\\\\",
                                     "\\n",
                                     "'",
                                     "''",
                                     "\"",
                                     "_",
                                     "_{a}",
                                     "{",
                                     "}",
                                     "@",
                                     "&",
                                     "&amp;",
                                     "&#65;",
                                     "<",
                                     ">",
                                     "]]>",
                                     "~a{.8b}",
                                     "%",
                                     "%d",
                                     "#",
                                     ";",
                                     "|",
                                     "!",
                                     "$x",
                                     "\t",
                                     "\r",
                                     "\x01",
                                     "\x7f",
                                     "\xc3\xa4",
                                     "\xe2\x86\x92",
                                     "\xf0\x9d\x84\x9e",
                                     "a b  c",
                                     "word",
                                     "EOD",
                                     "0",
                                     "12"};

static void mix(dice *d, char *text, size_t size) {
    text[0] = '\0';
    strcat(text, "a");
    for (unsigned k = 2 + dice_one_of(d, 6); k > 0; k--) {
        const char *piece = pieces[dice_one_of(d, sizeof pieces / sizeof pieces[0])];
        TEST_ASSERT_TRUE(strlen(text) + strlen(piece) + 2 < size);
        strcat(text, piece);
    }
    strcat(text, "z");
}

/* As XML has it, with a blank for a control character. */
static void escaped(const char *text, char *to) {
    for (; *text != '\0'; text++) {
        const unsigned char code = (unsigned char)*text;
        if (*text == '&') {
            to = stpcpy(to, "&amp;");
        } else if (*text == '<') {
            to = stpcpy(to, "&lt;");
        } else {
            *to++ = code < 0x20 || code == 0x7f ? ' ' : *text;
        }
    }
    *to = '\0';
}

/* The picture without its tags and without what parts "]]>". */
static char *shown(void) {
    FILE *in = fopen(PICTURE, "rb");
    TEST_ASSERT_NOT_NULL(in);
    char *text = calloc(1, 1 << 18);
    TEST_ASSERT_NOT_NULL(text);
    bool tag = false;
    int brackets = 0; /* of them side by side: "]]>" is no XML */
    size_t length = 0;
    for (int c = fgetc(in); c != EOF && length < (1 << 18) - 1; c = fgetc(in)) {
        TEST_ASSERT_FALSE(c == '>' && brackets >= 2);
        brackets = c == ']' ? brackets + 1 : 0;
        tag = tag || c == '<';
        if (!tag) {
            text[length++] = (char)c;
        }
        if (!tag && length > 2 && memcmp(text + length - 3, "\xe2\x81\xa0", 3) == 0) {
            length -= 3;
        }
        text[length] = '\0';
        tag = tag && c != '>';
    }
    fclose(in);
    return text;
}

static void find(const char *in, const char *text) {
    char wanted[4096];
    escaped(text, wanted);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(in, wanted), wanted);
}

static void test_texts_are_no_commands(void) {
    if (system("command -v gnuplot >/dev/null 2>&1") != 0) {
        TEST_IGNORE_MESSAGE("no gnuplot here");
    }
    static const double data[] = {0.0, 1.0, 2.0, 1.0, 2.0, 3.0};
    dice d = dice_of("texts of pictures", 5201);
    const unsigned cases = dice_cases(25);
    unlink(MADE);
    for (unsigned i = 0; i < cases; i++) {
        char title[600];
        char name[2][600];
        char unit[2][600];
        mix(&d, title, sizeof title);
        for (int k = 0; k < 2; k++) {
            mix(&d, name[k], sizeof name[k]);
            mix(&d, unit[k], sizeof unit[k]);
        }
        const curve curves[] = {{name[0], unit[0], 1}, {name[1], unit[1], 2}};
        TEST_ASSERT_TRUE(plot_draw(PICTURE, title, curves, 2, data, 2, 3, 0.0));
        TEST_ASSERT_TRUE_MESSAGE(access(MADE, F_OK) != 0, title);
        char *text = shown();
        find(text, title);
        for (int k = 0; k < 2; k++) {
            find(text, name[k]);
            find(text, unit[k]);
        }
        free(text);
    }
    unlink(PICTURE);
}

/* Where no file can be, or none that can be drawn, a picture is not taken for drawn. */
static void test_no_picture(void) {
    if (!gnuplot_is_there()) {
        TEST_IGNORE_MESSAGE("no gnuplot here");
    }
    static const double data[] = {1.0, 2.0, 3.0, 4.0};
    const scatter_series series[] = {
        {.name = "light", .x = data, .y = data, .count = 4},
        {.name = "heavy", .x = data, .y = data, .count = 4, .heavy = true}};
    const curve curves[] = {{"name", "m", 1}};
    for (int count = 1; count <= 2; count++) {
        TEST_ASSERT_TRUE(scatter_draw(PICTURE, "title", "x", "y", series, count));
        TEST_ASSERT_FALSE(scatter_draw("/dev/null/x.svg", "title", "x", "y", series, count));
    }
    TEST_ASSERT_FALSE(plot_draw("/dev/null/x.svg", "title", curves, 1, data, 2, 2, 0.0));
    unlink(PICTURE);
}

void suite_plot(void) {
    RUN_TEST(test_texts_are_no_commands);
    RUN_TEST(test_no_picture);
}

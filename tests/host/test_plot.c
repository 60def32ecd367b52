/* test_plot.c: what reaches gnuplot is text and no command, and stands in the picture as it was given: generated
 * names, titles and units of what gnuplot, a shell or XML could take for their own. */
#include "host/io/plot.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "command.h"
#include "host/io/gnuplot.h"
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

/* A run of these curves: a time column, then one for each, names first. */
static plot_run run_of(const char *title, const char *const names[], const char *const units[],
                       int curves, const double *data, int rows) {
    plot_run run;
    plot_run_open(&run, title, "label", curves + 1);
    plot_run_name(&run, 0, "time", "s", "");
    for (int k = 0; k < curves; k++) {
        plot_run_name(&run, k + 1, names[k], units[k], "");
    }
    const size_t size = sizeof(double) * (size_t)rows * (size_t)(curves + 1);
    run.data = malloc(size);
    TEST_ASSERT_NOT_NULL(run.data);
    memcpy(run.data, data, size);
    run.rows = rows;
    return run;
}

static bool draw(const char *file, const plot_run *run) {
    return plot_draw("run", file, &(plot_choice){0}, run, 1);
}

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

/* The picture, after its alternative text, without its tags and without what parts "]]>". */
static char *shown(void) {
    FILE *in = fopen(PICTURE, "rb");
    TEST_ASSERT_NOT_NULL(in);
    char *text = calloc(1, 1 << 18);
    TEST_ASSERT_NOT_NULL(text);
    char head[4096] = "";
    while (strncmp(head, "<desc>", 6) != 0) {
        TEST_ASSERT_NOT_NULL(fgets(head, sizeof head, in));
    }
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
        plot_run run = run_of(title, (const char *const[]){name[0], name[1]},
                              (const char *const[]){unit[0], unit[1]}, 2, data, 2);
        TEST_ASSERT_TRUE(draw(PICTURE, &run));
        plot_run_close(&run);
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
    plot_run run =
        run_of("title", (const char *const[]){"name"}, (const char *const[]){"m"}, 1, data, 2);
    TEST_ASSERT_FALSE(draw("/dev/null/x.svg", &run));
    plot_run_close(&run);
    unlink(PICTURE);
}

/* A panel a unit, in the order in which units first stand: each is written once. */
static void test_a_panel_a_unit(void) {
    enum { CURVES = 6, UNITS = 4 };
    static const char *const units[UNITS] = {"unita", "unitb", "unitc", "unitd"};
    static const char *const names[CURVES] = {"first",  "second", "third",
                                              "fourth", "fifth",  "sixth"};
    static double data[3 * (CURVES + 1)];
    if (!gnuplot_is_there()) {
        TEST_IGNORE_MESSAGE("no gnuplot here");
    }
    dice d = dice_of("panels", 5202);
    for (unsigned round = 0; round < 8U; round++) {
        const char *of[CURVES];
        unsigned written[UNITS] = {0};
        for (int r = 0; r < 3 * (CURVES + 1); r++) {
            data[r] = dice_between(&d, -5.0, 5.0);
        }
        for (int r = 0; r < 3; r++) {
            data[r * (CURVES + 1)] = r;
        }
        for (int k = 0; k < CURVES; k++) {
            const unsigned unit = dice_one_of(&d, UNITS);
            of[k] = units[unit];
            written[unit] = 1;
        }
        plot_run run = run_of("title", names, of, CURVES, data, 3);
        TEST_ASSERT_TRUE(draw(PICTURE, &run));
        plot_run_close(&run);
        char *text = shown();
        for (int u = 0; u < UNITS; u++) {
            unsigned found = 0;
            for (const char *at = text; (at = strstr(at, units[u])) != NULL; at++) {
                found++;
            }
            TEST_ASSERT_EQUAL_UINT(written[u], found);
        }
        for (int k = 0; k < CURVES; k++) {
            find(text, names[k]);
        }
        free(text);
    }
    unlink(PICTURE);
}

void suite_plot(void) {
    RUN_TEST(test_texts_are_no_commands);
    RUN_TEST(test_a_panel_a_unit);
    RUN_TEST(test_no_picture);
}

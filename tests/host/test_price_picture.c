/* test_price_picture.c: a table as a picture (host/price/table_plot.c): what reaches gnuplot, which is a script here that
 * hands it on, of drawn tables. */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "command.h"
#include "host/base/room.h"
#include "host/price/table_text.h"
#include "priced.h"
#include "unity.h"

void suite_price_picture(void);

static const char *const scene_text[] = {
    "mechanism m\ncoordinate x [mm]\nT = 1 [kg]*x'^2/2\nV = 9 [N/m]*x^2/2\n"
    "scene s { start x = 100 [mm]; step 1 [ms]; until 1 [s] }\n"};
enum { ROWS = 60, TEXT = 40000 };

static char drawn[TEXT]; /* what gnuplot was told, codes of characters put back */

static void read_drawn(const char *file) {
    FILE *from = fopen(file, "r");
    TEST_ASSERT_NOT_NULL(from);
    size_t to = 0;
    for (int c = fgetc(from); c != EOF && to + 1 < sizeof drawn; c = fgetc(from)) {
        if (c == '\\') {
            char code[4] = "";
            TEST_ASSERT_TRUE(fread(code, 1, 3, from) == 3);
            c = (int)strtol(code, NULL, 8);
        }
        drawn[to++] = (char)c;
    }
    drawn[to] = '\0';
    fclose(from);
}

static void draw_table(dice *d, table *made) {
    for (int i = 0; i < ROWS; i++) {
        table_row *r = &made->row[i];
        setting s = setting_at((int)dice_one_of(d, (unsigned)setting_count()));
        if (dice_one_of(d, 2) == 0) { /* few of them, so that many are alike */
            s.image.method = (wh_method)dice_one_of(d, 2);
        }
        static const deviation_pace paces[] = {{1, 5}, {1, 2}, {1, 1}, {2, 1}};
        *r = (table_row){.setting = s, .pace = paces[dice_one_of(d, 4)]};
        r->result.error = dice_one_of(d, 9) == 0 ? 0.0 : pow(10.0, dice_between(d, -9.0, -1.0));
        r->price = (table_price){.unit = PRICE_INSTRUCTIONS,
                                 .value = dice_one_of(d, 9) == 0 ? 0.0 : dice_between(d, 1e3, 1e5)};
    }
    made->count = ROWS;
    table_sort(made);
}

static void words_of(const setting *s, char name[96]) {
    const bool matrix = s->image.matrix != MATRIX_NONE;
    snprintf(name, 96, "%s%s, %s", matrix ? "matrix " : "",
             matrix ? image_matrix_words[s->image.matrix] : wh_methods[s->image.method].word,
             setting_word(s, AXIS_NUMBER));
}

/* Of which line of the picture a row is; "" of none. */
static void name_of(const table *made, int which, char name[96]) {
    const setting *s = &made->row[which].setting;
    const deviation_pace *pace = &made->row[which].pace;
    name[0] = '\0';
    if (s->image.tables != TABLES_NONE) {
        return;
    }
    for (int i = 0; i < which; i++) {
        const setting *o = &made->row[i].setting;
        const deviation_pace *other = &made->row[i].pace;
        if (o->image.tables == TABLES_NONE && o->image.method == s->image.method &&
            o->image.matrix == s->image.matrix && o->number == s->number &&
            o->image.compensated == s->image.compensated &&
            (double)other->steps / (double)other->records ==
                (double)pace->steps / (double)pace->records) {
            return; /* a cheaper one of the same */
        }
    }
    words_of(s, name);
}

static const char *expect_point(const char *at, const table_row *r) {
    if (!(r->result.error > 0.0 && r->price.value > 0.0)) {
        return at; /* it has no logarithm */
    }
    double x;
    double y;
    at = said_number(said_number(at, &x), &y);
    TEST_ASSERT_TRUE(x == r->price.value && y == r->result.error && *at == '\n');
    return at + 1;
}

/* The front, then the settings on it, then all others, as the rows come; how many. */
static int names_of(const table *made, char names[2 * ROWS + 1][96]) {
    int lines = 0;
    snprintf(names[lines], 96, "front: the least error for its price");
    for (int i = 0; i < made->count; i++) {
        lines = made->row[i].on_front ? 1 : lines;
    }
    for (int round = 0; round < 2; round++) {
        for (int i = 0; i < made->count; i++) {
            char name[96] = "";
            int k = 0;
            if (round > 0) {
                name_of(made, i, name);
            } else if (made->row[i].on_front && made->row[i].setting.image.tables == TABLES_NONE) {
                words_of(&made->row[i].setting, name);
            }
            while (k < lines && strcmp(names[k], name) != 0) {
                k++;
            }
            if (name[0] != '\0' && k == lines) {
                snprintf(names[lines++], 96, "%s", name);
            }
        }
    }
    return lines;
}

/* Where a setting is named beside the front, it is that of a row on it. */
static void expect_labels(const table *made) {
    unsigned labels = 0;
    for (const char *at = drawn; (at = strstr(at, "set label \"")) != NULL; labels++) {
        bool there = false;
        at += strlen("set label \"");
        for (int i = 0; i < made->count; i++) {
            char name[96];
            words_of(&made->row[i].setting, name);
            there = there || (made->row[i].on_front && strncmp(at, name, strlen(name)) == 0 &&
                              at[strlen(name)] == '"');
        }
        TEST_ASSERT_TRUE(there);
    }
    unsigned points = 0;
    for (int i = 0; i < made->count; i++) {
        const table_row *r = &made->row[i];
        points += r->on_front && r->result.error > 0.0 && r->price.value > 0.0 ? 1 : 0;
    }
    TEST_ASSERT_TRUE(labels <= points && (labels > 0) == (points > 0));
}

static void expect_picture(const table *made) {
    enum { LINES_MOST = 8 };
    static char names[2 * ROWS + 1][96];
    const int all = names_of(made, names);
    const int lines = all < LINES_MOST ? all : LINES_MOST;
    char more[40];
    snprintf(more, sizeof more, "\"and %d more: --csv\"", all - lines);
    TEST_ASSERT_EQUAL_INT(all > lines, strstr(drawn, more) != NULL);
    expect_labels(made);
    const char *at = strstr(drawn, "$data0");
    TEST_ASSERT_NOT_NULL(at);
    for (int k = 0; k < lines; k++) {
        char begin[40];
        snprintf(begin, sizeof begin, "$data%d << EOD\n", k);
        at = said_words(at, begin);
        for (int i = 0; i < made->count; i++) {
            char name[96];
            name_of(made, i, name);
            if (k == 0 ? made->row[i].on_front : strcmp(names[k], name) == 0) {
                at = expect_point(at, &made->row[i]);
            }
        }
        at = said_words(at, "EOD\n");
    }
    at = strstr(at, "\nplot ");
    TEST_ASSERT_NOT_NULL(at);
    for (int k = 0; k < lines; k++) {
        char want[200];
        snprintf(want, sizeof want, "$data%d using", k);
        at = strstr(at, want);
        TEST_ASSERT_NOT_NULL(at);
        TEST_ASSERT_TRUE((strncmp(at + strlen(want), " 1:2 with lines lw 4", 20) == 0) == (k == 0));
        snprintf(want, sizeof want, " title \"%s\"", names[k]);
        TEST_ASSERT_EQUAL_STRING_LEN(want, strstr(at, " title "), strlen(want));
    }
}

static void test_drawn_tables_are_lines_of_a_picture(void) {
    static char folder[] = "build/tests/drawn-XXXXXX";
    snprintf(folder, sizeof folder, "build/tests/drawn-XXXXXX");
    TEST_ASSERT_NOT_NULL_MESSAGE(mkdtemp(folder), "run from the project's root");
    char *tool = room_words("%s/gnuplot", folder);
    char *file = room_words("%s/picture.svg", folder);
    FILE *to = fopen(tool, "w");
    TEST_ASSERT_NOT_NULL(to);
    fputs("#!/bin/sh\ncat\necho \"</svg>\"\n", to);
    TEST_ASSERT_TRUE(fclose(to) == 0 && chmod(tool, 0700) == 0);
    char *before = room_words("%s", getenv("PATH"));
    char *longer = room_words("%s:%s", folder, before);
    setenv("PATH", longer, 1);
    dice d = dice_of("price_picture", 51);
    for (unsigned n = 0; n < dice_cases(few_or_all(8, 100)); n++) {
        priced p;
        priced_open(&p, scene_text, 1);
        TEST_ASSERT_TRUE(
            priced_begin(&p, "mps2-an386", (whole_ratio){1, 50}, 20, n % 2 ? "x'" : NULL));
        table_row row[ROWS];
        table made = {.row = row};
        if (n != 2) {
            draw_table(&d, &made);
        }
        TEST_ASSERT_TRUE(table_plot(file, &p.trial, &made));
        read_drawn(file);
        TEST_ASSERT_NOT_NULL(
            strstr(drawn, "title \"s on mps2-an386 (Cortex-M4F): error against price\""));
        TEST_ASSERT_NOT_NULL(strstr(drawn, n == 2 ? "xlabel \"cycles a simulated second\""
                                                  : "xlabel \"instructions a simulated second\""));
        TEST_ASSERT_NOT_NULL(
            strstr(drawn, n % 2 ? "ylabel \"error of x' [mm/s] to 0.4 s\""
                                : "ylabel \"error, part of the largest value, to 0.4 s\""));
        if (n != 2) {
            expect_picture(&made);
        }
        priced_close(&p);
    }
    table nothing = {.count = 0};
    priced p;
    priced_open(&p, scene_text, 1);
    TEST_ASSERT_TRUE(priced_begin(&p, "mps2-an386", (whole_ratio){1, 50}, 20, NULL));
    unlink(file);
    to = fopen(tool, "w");
    fputs("#!/bin/sh\nexit 1\n", to);
    fclose(to);
    fflush(stderr);
    const int errors = dup(STDERR_FILENO);
    FILE *unseen = tmpfile();
    dup2(fileno(unseen), STDERR_FILENO);
    const bool made = table_plot(file, &p.trial, &nothing);
    fflush(stderr);
    dup2(errors, STDERR_FILENO);
    close(errors);
    fclose(unseen);
    TEST_ASSERT_FALSE(made);
    priced_close(&p);
    setenv("PATH", before, 1);
    unlink(tool);
    unlink(file);
    TEST_ASSERT_EQUAL_INT(0, rmdir(folder));
    free(tool);
    free(file);
    free(before);
    free(longer);
}

void suite_price_picture(void) { RUN_TEST(test_drawn_tables_are_lines_of_a_picture); }

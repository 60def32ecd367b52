/* test_map_picture.c: drawn maps as pictures: what gnuplot is told, read again and held to what the map was drawn from: which
 * verdict fills which pairs, and where each cell ends. `cat` plays gnuplot, so that its picture is what
 * it was told. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "host/study/stability_map.h"
#include "shown_map.h"

#include "unity.h"

void suite_map_picture(void);

#define PICTURE "build/tests/drawn_map.svg"
#define PLAYERS "build/tests/players"

/* Where cell i of rising values ends, below or above: halfway to its neighbour, in the axis's scale. Of one value alone
 * there is no half way: it lies within. */
static double end_of(const axis *a, const double *v, uint64_t i, bool up) {
    const uint64_t n = a->count;
    const uint64_t next = up ? (i + 1 < n ? i + 1 : i - 1) : (i > 0 ? i - 1 : i + 1);
    const bool inside = up ? i + 1 < n : i > 0;
    if (a->is_log) {
        const double half = sqrt(v[next] / v[i]);
        return inside ? v[i] * half : v[i] / half;
    }
    const double half = 0.5 * (v[next] - v[i]);
    return inside ? v[i] + half : v[i] - half;
}

static void expect_end(const axis *a, const double *v, uint64_t i, bool up, double got) {
    if (a->count == 1) {
        TEST_ASSERT_TRUE(up ? got > v[0] : got < v[0]);
        return;
    }
    const double wanted = end_of(a, v, i, up);
    const double size = fabs(a->from) + fabs(a->to) + fabs(wanted);
    TEST_ASSERT_DOUBLE_WITHIN(1e-8 * size, wanted, got);
}

typedef struct box {
    double x, y, left, right, low, high;
} box;

/* The next stretch of a row from `*i` on that has this verdict; false: there is none. */
static bool next_stretch(const shown_map *s, uint64_t row, map_verdict verdict, uint64_t *from,
                         uint64_t *end) {
    uint64_t i = *end;
    while (i < shown_map_across(s) && s->at[row][i]->verdict != verdict) {
        i++;
    }
    *from = i;
    while (i < shown_map_across(s) && s->at[row][i]->verdict == verdict) {
        i++;
    }
    *end = i;
    return *from < *end;
}

/* One box for each stretch of each row, and none besides, in the file's order of rows. */
static void expect_boxes(const shown_map *s, map_verdict verdict, const char *text) {
    const axis *along = &s->axes[s->map.along];
    const axis *rows = &s->axes[1 - s->map.along];
    for (uint64_t k = 0; k < rows->count; k++) {
        const uint64_t row = rows->from <= rows->to ? k : rows->count - 1 - k;
        uint64_t from = 0;
        uint64_t end = 0;
        while (next_stretch(s, row, verdict, &from, &end)) {
            box b;
            text = said_number(said_number(text, &b.x), &b.y);
            text = said_number(said_number(text, &b.left), &b.right);
            text = said_words(said_number(said_number(text, &b.low), &b.high), "\n");
            TEST_ASSERT_TRUE(b.left < b.x && b.x < b.right && b.low < b.y && b.y < b.high);
            expect_end(along, s->value[0], from, false, b.left);
            expect_end(along, s->value[0], end - 1, true, b.right);
            expect_end(rows, s->value[1], row, false, b.low);
            expect_end(rows, s->value[1], row, true, b.high);
        }
    }
    TEST_ASSERT_EQUAL_INT(0, strncmp(text, "EOD\n", 4));
}

/* A range, its logarithm and its label. */
static void expect_axis(const char *told, const axis *a, const double *v, char letter,
                        double *ends) {
    char what[80];
    snprintf(what, sizeof what, "set %crange [", letter);
    const char *at = strstr(told, what);
    TEST_ASSERT_NOT_NULL(at);
    at = said_words(said_number(at + strlen(what), &ends[0]), ":");
    said_words(said_number(at, &ends[1]), "]\n");
    expect_end(a, v, 0, false, ends[0]);
    expect_end(a, v, a->count - 1, true, ends[1]);
    snprintf(what, sizeof what, "set logscale %c\n", letter);
    TEST_ASSERT_EQUAL_INT(a->is_log && a->from > 0.0, strstr(told, what) != NULL);
    snprintf(what, sizeof what, "set %clabel \"%s\".'%s' noenhanced\n", letter, a->column,
             a->symbol == NULL       ? " [s]"
             : a->symbol->index == 0 ? " [N/m]"
                                     : " [kg]");
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(told, what), what);
}

static void expect_plot_line(const char *told, bool drawn, const char *what) {
    const char *plot = strstr(told, "\nplot ");
    TEST_ASSERT_NOT_NULL(plot);
    TEST_ASSERT_EQUAL_INT_MESSAGE(drawn, strstr(plot, what) != NULL, what);
}

static void expect_picture(const shown_map *s) {
    static char told[1 << 16];
    TEST_ASSERT_TRUE(map_plot(PICTURE, &s->map, "words"));
    FILE *in = fopen(PICTURE, "rb");
    TEST_ASSERT_NOT_NULL(in);
    told[fread(told, 1, sizeof told - 1, in)] = '\0';
    fclose(in);
    double ends[2];
    double heights[2];
    expect_axis(told, &s->axes[s->map.along], s->value[0], 'x', ends);
    expect_axis(told, &s->axes[1 - s->map.along], s->value[1], 'y', heights);
    bool any = false;
    for (int verdict = 0; verdict < MAP_VERDICTS; verdict++) {
        char block[60];
        snprintf(block, sizeof block, "$%s << EOD\n", map_verdicts[verdict].word);
        const char *at = strstr(told, block);
        const bool drawn = verdict <= MAP_DIVERGES && map_count(&s->map, (map_verdict)verdict) > 0;
        TEST_ASSERT_EQUAL_INT(drawn, at != NULL);
        snprintf(block, sizeof block, "$%s with boxxyerror", map_verdicts[verdict].word);
        expect_plot_line(told, drawn, block);
        snprintf(block, sizeof block, "'%s: %.20s", map_verdicts[verdict].word,
                 map_verdicts[verdict].words);
        expect_plot_line(told, drawn, block);
        if (at != NULL) {
            expect_boxes(s, (map_verdict)verdict, strchr(at, '\n') + 1);
            any = true;
        }
    }
    expect_plot_line(told, !any, "plot NaN");
    TEST_ASSERT_NULL(strstr(told, "plot ,"));
}

/* --- drawn -------------------------------------------------------------------------------------------*/

/* A script of this line in the place of gnuplot, in front of all other folders with programs. */
static char *play_gnuplot(const char *part) {
    const char *path = getenv("PATH");
    char *before = strdup(path != NULL ? path : "");
    char *longer = malloc(strlen(before) + sizeof PLAYERS + 1);
    TEST_ASSERT_TRUE(before != NULL && longer != NULL);
    (void)mkdir(PLAYERS, 0777);
    (void)unlink(PLAYERS "/gnuplot");
    FILE *player = fopen(PLAYERS "/gnuplot", "w");
    TEST_ASSERT_NOT_NULL(player);
    fprintf(player, "#!/bin/sh\n%s\n", part);
    fclose(player);
    TEST_ASSERT_EQUAL_INT(0, chmod(PLAYERS "/gnuplot", 0777));
    sprintf(longer, PLAYERS ":%s", before);
    TEST_ASSERT_EQUAL_INT(0, setenv("PATH", longer, 1));
    free(longer);
    return before;
}

static void stop_playing(char *path) {
    setenv("PATH", path, 1);
    free(path);
    unlink(PICTURE);
    unlink(PLAYERS "/gnuplot");
    rmdir(PLAYERS);
}

static void test_pictures_show_what_maps_hold(void) {
    dice d = dice_of("map_picture", 2311);
    char *path = play_gnuplot("cat && echo '</svg>'");
    shown_map s;
    for (unsigned i = few_or_all(15, 400); i > 0; i--) {
        shown_map_draw(&d, &s);
        expect_picture(&s);
    }
    stop_playing(path);
}

/* Told, and no picture that is said to be there. */
static void test_pictures_that_cannot_be_drawn(void) {
    dice d = dice_of("map_picture", 2320);
    shown_map s;
    shown_map_draw(&d, &s);
    TEST_ASSERT_FALSE(map_plot("build/tests/none/map.svg", &s.map, "words"));
    char *path = play_gnuplot("exit 1");
    TEST_ASSERT_FALSE(map_plot(PICTURE, &s.map, "words"));
    stop_playing(path);
}

void suite_map_picture(void) {
    RUN_TEST(test_pictures_that_cannot_be_drawn);
    RUN_TEST(test_pictures_show_what_maps_hold);
}

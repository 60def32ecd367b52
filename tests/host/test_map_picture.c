/* test_map_picture.c: made-up stability maps as pictures, words and CSV, compared with map_picture.txt. The program
 * `cat` takes the place of gnuplot, so the "picture" is the script. */
#include "test.h"

#include <sys/stat.h>
#include <unistd.h>

#include "host/study/stability_map.h"

#include "caught.h"
#include "derived.h"

#define PICTURE "build/tests/drawn_map.svg"
#define PLAYERS "build/tests/players"

static const symbol swept[2] = {
    {.kind = SYM_PARAMETER, .name = "k", .text = "", .unit = "N/m", .dim.twelfths = {0, 12, -24}},
    {.kind = SYM_PARAMETER,
     .name = "m",
     .text = "",
     .unit = "kg",
     .index = 1,
     .dim.twelfths = {0, 12}}};

/* Axes: the step is the first axis, the second, or none. Values rise or fall, are logarithmic or negative, or there
 * is only one. */
static const axis axes_of[][2] = {
    {{.name = "step", .column = "step", .from = 0.001, .to = 0.1, .count = 7, .is_log = true},
     {.name = "k", .column = "k", .symbol = &swept[0], .from = 9.0, .to = 1.0, .count = 5}},
    {{.name = "m",
      .column = "m",
      .symbol = &swept[1],
      .from = -0.5,
      .to = -8.0,
      .count = 4,
      .is_log = true},
     {.name = "step", .column = "step", .from = 0.4, .to = 0.1, .count = 4}},
    {{.name = "k", .column = "k", .symbol = &swept[0], .from = -1.0, .to = 2.0, .count = 3},
     {.name = "m", .column = "m", .symbol = &swept[1], .from = 3.0, .to = 3.0, .count = 1}},
    {{.name = "k",
      .column = "k",
      .symbol = &swept[0],
      .from = 2.0,
      .to = 2.0,
      .count = 1,
      .is_log = true},
     {.name = "m",
      .column = "m",
      .symbol = &swept[1],
      .from = 1.0,
      .to = 4.0,
      .count = 3,
      .is_log = true}}};
enum { MAPS = sizeof axes_of / sizeof axes_of[0], CELLS = 35 };

/* Contains pointers into itself, so it must not be moved. */
typedef struct shown {
    axis axes[2];
    grid grid;
    map_cell cell[CELLS];
    stability_map map;
} shown;

static void made_up_map(shown *s, int n) {
    memcpy(s->axes, axes_of[n], sizeof s->axes);
    s->grid = (grid){.axes = s->axes, .count = 2, .points = s->axes[0].count * s->axes[1].count};
    s->map = (stability_map){.grid = &s->grid,
                             .cell = s->cell,
                             .done = s->grid.points,
                             .along = n == 0 ? 0 : 1,
                             .by_step = n < 2};
    for (unsigned i = 0; i < s->grid.points; i++) {
        const unsigned verdict = n == 0   ? i * i % 11U % 6U
                                 : n == 1 ? i / 3U
                                 : n == 2 ? 4U + i % 2U
                                          : i;
        s->cell[i] = (map_cell){(map_verdict)verdict, 0.5 + i, 0.25 * i,
                                i % 3U == 0 ? (double)NAN : 0.125 * i};
    }
}

/* Writes a shell script with this line, and makes it the first `gnuplot` in PATH. */
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

static void copy_picture(FILE *out, const shown *s) {
    char line[400];
    TEST_ASSERT_TRUE(map_plot(PICTURE, &s->map, "words"));
    FILE *in = fopen(PICTURE, "rb");
    TEST_ASSERT_NOT_NULL(in);
    while (fgets(line, sizeof line, in) != NULL) {
        fputs(line, out);
    }
    fclose(in);
}

TEST(map_picture, pictures_that_cannot_be_drawn) {
    shown s;
    made_up_map(&s, 0);
    TEST_ASSERT_FALSE(map_plot("build/tests/none/map.svg", &s.map, "words"));
    char *path = play_gnuplot("exit 1");
    TEST_ASSERT_FALSE(map_plot(PICTURE, &s.map, "words"));
    stop_playing(path);
}

TEST(map_picture, maps_are_shown_as_before) {
    char *path = play_gnuplot("cat && echo '</svg>'");
    caught all;
    catch_text(&all);
    for (int n = 0; n < MAPS; n++) {
        shown s;
        made_up_map(&s, n);
        fprintf(all.to, "=== map %d\n", n);
        map_print(all.to, &s.map, "what was run");
        map_csv(all.to, &s.map);
        copy_picture(all.to, &s);
    }
    alloc_text_end(all.to);
    stop_playing(path);
    for (char *at = all.text; (at = strchr(at, '\r')) != NULL; at++) {
        *at = '|'; /* marks the end of a row of the CSV */
    }
    expect_printed("map_picture", all.text);
    free(all.text);
}

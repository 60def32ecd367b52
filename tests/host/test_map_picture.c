/* test_map_picture.c: stability maps as pictures and text. The script for gnuplot is parsed and compared with the
 * map: which verdict fills which pairs, and where each cell ends. `cat` stands in for gnuplot, so that its "picture"
 * is the script. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "host/study/stability_map.h"

#include "derived.h"
#include "shown_map.h"

#include "unity.h"

void suite_map_picture(void);
void suite_map_shown(void);

/* === map picture ============================================================================== */

#define PICTURE "build/tests/drawn_map.svg"
#define PLAYERS "build/tests/players"

/* Edge of cell i of rising values: halfway to its neighbour in the axis's scale. A single value has no halfway point;
 * it lies inside. */
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

/* The next run of cells of a row, from `*i` on, with this verdict. False: no more. */
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

/* A script of this line as gnuplot, first in PATH. */
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

/* === map shown ================================================================================ */
/* Drawn maps in words and in CSV, parsed and compared cell by cell. */

enum { LINE = 400 };

static void marks_of(const shown_map *s, uint64_t row, char *marks) {
    for (uint64_t i = 0; i < shown_map_across(s); i++) {
        *marks++ = ".ox#-?"[s->at[row][i]->verdict];
    }
    *marks = '\0';
}

static void expect_row(const shown_map *s, uint64_t row, const char *line) {
    char marks[1 + SHOWN_MOST];
    char found[LINE] = "";
    double value = 0.0;
    marks_of(s, row, marks);
    const char *behind = said_word(said_number(line, &value), found, sizeof found);
    behind += strspn(behind, " ");
    TEST_ASSERT_DOUBLE_WITHIN(1e-5 * fabs(s->value[1][row]) + 1e-9, s->value[1][row], value);
    TEST_ASSERT_EQUAL_STRING(marks, found);
    TEST_ASSERT_EQUAL_STRING("\n", behind);
}

static void expect_legend(const shown_map *s, FILE *in) {
    char line[LINE];
    for (int verdict = 0; verdict < MAP_VERDICTS; verdict++) {
        unsigned long count = 0;
        for (uint64_t i = 0; i < s->grid.points; i++) {
            count += s->cell[i].verdict == (map_verdict)verdict;
        }
        if (count == 0) {
            continue;
        }
        char mark[2];
        char word[LINE];
        double told = 0.0;
        TEST_ASSERT_NOT_NULL(fgets(line, sizeof line, in));
        said_number(said_word(said_word(line, mark, sizeof mark), word, sizeof word), &told);
        TEST_ASSERT_EQUAL_INT(".ox#-?"[verdict], mark[0]);
        TEST_ASSERT_EQUAL_STRING(map_verdicts[verdict].word, word);
        TEST_ASSERT_TRUE(told == (double)count);
    }
    TEST_ASSERT_NULL(fgets(line, sizeof line, in));
}

static void expect_words(const shown_map *s) {
    char line[LINE];
    char first[LINE];
    char second[LINE];
    double from = 0.0;
    double to = 0.0;
    FILE *both = tmpfile();
    TEST_ASSERT_NOT_NULL(both);
    map_print(both, &s->map, "what was run");
    rewind(both);
    TEST_ASSERT_NOT_NULL(fgets(line, sizeof line, both));
    TEST_ASSERT_EQUAL_STRING("what was run\n", line);
    TEST_ASSERT_NOT_NULL(fgets(line, sizeof line, both));
    TEST_ASSERT_NOT_NULL(fgets(line, sizeof line, both));
    const char *at = said_word(said_word(line, first, sizeof first), second, sizeof second);
    said_number(said_words(said_number(said_words(at, "from"), &from), "to"), &to);
    TEST_ASSERT_EQUAL_STRING(s->axes[1 - s->map.along].column, first);
    TEST_ASSERT_EQUAL_STRING(s->axes[s->map.along].column, second);
    TEST_ASSERT_DOUBLE_WITHIN(1e-5 * fabs(from), s->value[0][0], from);
    TEST_ASSERT_DOUBLE_WITHIN(1e-5 * fabs(to), s->value[0][shown_map_across(s) - 1], to);
    TEST_ASSERT_EQUAL_INT(s->axes[s->map.along].is_log, strstr(line, ", logarithmic") != NULL);
    for (uint64_t row = shown_map_rows(s); row-- > 0;) { /* the largest on top */
        TEST_ASSERT_NOT_NULL(fgets(line, sizeof line, both));
        expect_row(s, row, line);
    }
    TEST_ASSERT_NOT_NULL(fgets(line, sizeof line, both));
    TEST_ASSERT_EQUAL_STRING("\n", line);
    expect_legend(s, both);
    fclose(both);
}

/* The next field of a line of CSV; NAN if empty. */
static double next_field(char **at) {
    char *end = *at + strcspn(*at, ",\r");
    const double value = end == *at ? (double)NAN : strtod(*at, NULL);
    *at = *end == ',' ? end + 1 : end;
    return value;
}

static void expect_field(double wanted, char **at) {
    const double got = next_field(at);
    TEST_ASSERT_EQUAL_INT(isnan(wanted), isnan(got));
    TEST_ASSERT_TRUE(isnan(wanted) || fabs(got - wanted) <= 1e-13 * fabs(wanted) + 1e-15);
}

static void expect_csv(const shown_map *s) {
    char line[LINE];
    FILE *both = tmpfile();
    TEST_ASSERT_NOT_NULL(both);
    map_csv(both, &s->map);
    rewind(both);
    TEST_ASSERT_NOT_NULL(fgets(line, sizeof line, both));
    char head[LINE];
    snprintf(head, sizeof head, "%s,%s,verdict,until,end,energy_left_over\r\n", s->axes[0].column,
             s->axes[1].column);
    TEST_ASSERT_EQUAL_STRING(head, line);
    for (uint64_t i = 0; i < s->grid.points; i++) {
        const map_cell *c = &s->cell[i];
        const uint64_t which[2] = {i / s->axes[1].count, i % s->axes[1].count};
        if (c->verdict == MAP_UNTRIED) {
            continue;
        }
        const bool known = c->verdict != MAP_NONE;
        TEST_ASSERT_NOT_NULL(fgets(line, sizeof line, both));
        char *at = line;
        expect_field(shown_map_value(&s->axes[0], which[0]), &at);
        expect_field(shown_map_value(&s->axes[1], which[1]), &at);
        const char *word = map_verdicts[c->verdict].word;
        TEST_ASSERT_EQUAL_INT(0, strncmp(at, word, strlen(word)));
        at += strlen(word) + 1;
        expect_field(known ? c->until_s : (double)NAN, &at);
        expect_field(known ? c->end_s : (double)NAN, &at);
        expect_field(c->left_over, &at);
        TEST_ASSERT_EQUAL_STRING("\r\n", at);
    }
    TEST_ASSERT_NULL(fgets(line, sizeof line, both));
    fclose(both);
}

static void test_maps_say_what_they_hold(void) {
    dice d = dice_of("map_shown", 2311);
    shown_map s;
    for (unsigned i = few_or_all(15, 1000); i > 0; i--) {
        shown_map_draw(&d, &s);
        expect_words(&s);
        expect_csv(&s);
    }
}

static struct {
    double last;
    unsigned within; /* pairs */
    double points;
} heard;

static void hear(double runs, void *told) {
    TEST_ASSERT_TRUE(told == &heard);
    TEST_ASSERT_TRUE(runs >= heard.last && runs <= heard.points);
    heard.within += runs > floor(runs) ? 1U : 0U;
    heard.last = runs;
}

/* Progress counts finished runs plus the fraction of the current one. It never decreases and ends at the total. */
static void test_progress_goes_on(void) {
    static const char *const text =
        "mechanism m\ncoordinate x [m]\nparameter k = 1 [N/m]\nT = 1 [kg]*x'^2/2\nV = k*x^2/2\n"
        "scene s {\n start x = 1 [m]\n step 1 [ms]\n until 20 [s]\n}\n";
    static const char *const over[][2] = {{"step=1..2[ms]:2", "k=1..2[N/m]:3"},
                                          {"k=1..2[N/m]:3", "step=1..4[ms]:4"}};
    for (unsigned i = 0; i < 2U; i++) {
        derived d = derived_scene(text, "s");
        derived_expect(&d, text);
        diags *errors = diags_new();
        grid axes = {.count = 0};
        const overrides changes = {.balance = true};
        const mechanism *of = d.model->mechanisms[0];
        for (int k = 0; k < 2; k++) {
            TEST_ASSERT_TRUE(grid_add(&axes, of, over[i][k], errors));
        }
        heard.last = 0.0;
        heard.within = 0;
        heard.points = (double)axes.points;
        const map_wish wish = {.of = {.grid = &axes,
                                      .mechanism = of,
                                      .scene = d.model->scenes[0],
                                      .changes = &changes,
                                      .kind = &engine_double,
                                      .engine = {.method = WH_RK4}},
                               .tolerance = 1e-3,
                               .progress = hear,
                               .told = &heard};
        stability_map made = map_make(&wish);
        TEST_ASSERT_EQUAL_DOUBLE(heard.points, heard.last);
        TEST_ASSERT_TRUE(heard.within >= axes.points);
        map_free(&made);
        grid_free(&axes);
        diags_free(errors);
        derived_free(&d);
    }
}

void suite_map_shown(void) {
    RUN_TEST(test_maps_say_what_they_hold);
    RUN_TEST(test_progress_goes_on);
}

/* test_map_shown.c: drawn maps of any verdicts, over ranges of every kind, in words, in rows and as a picture, read again
 * and held to what they were drawn from: what stands at which pair, where its cell ends, where the limit stands. No
 * scene is run; `cat` plays gnuplot, so that its picture is what it was told. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "command.h"
#include "host/map/map_plot.h"
#include "host/map/map_text.h"

#include "unity.h"

void suite_map_shown(void);

enum { MOST = 7, LINE = 400 };
#define PICTURE "build/tests/drawn_map.svg"
#define PLAYERS "build/tests/players"

static const symbol swept[2] = {
    {.kind = SYM_PARAMETER, .name = "k", .text = "", .unit = ""},
    {.kind = SYM_PARAMETER, .name = "m", .text = "", .unit = "", .index = 1}};

/* A map, and its pairs in the order of the values: [row][along], both rising. */
typedef struct shown_map {
    axis axes[2];
    grid grid;
    stability_map map;
    map_cell cell[MOST * MOST];
    double limit_s[MOST];
    double value[2][MOST];   /* of the axis along, and of the rows; rising */
    uint64_t place[2][MOST]; /* which of its axis each is */
    const map_cell *at[MOST][MOST];
    double limit_of[MOST]; /* of the rows as they rise */
} shown_map;

/* A range whose ends have the same sign where it is logarithmic; the step's is above zero. */
static axis drawn_axis(dice *d, const symbol *of, char *name) {
    axis a = {.name = name, .column = name, .symbol = of, .count = 1 + dice_one_of(d, MOST)};
    a.is_log = dice_one_of(d, 2) == 0;
    const double sign = of != NULL && dice_one_of(d, 3) == 0 ? -1.0 : 1.0;
    a.from = sign * dice_between(d, 0.01, 3.0);
    a.to = a.from * dice_between(d, 1.5, 40.0);
    if (of != NULL && !a.is_log && dice_one_of(d, 2) == 0) {
        a.to = -a.to;
    }
    if (dice_one_of(d, 2) == 0) {
        const double from = a.from;
        a.from = a.to;
        a.to = from;
    }
    if (a.count == 1) {
        a.to = a.from;
    }
    return a;
}

static double value_of(const axis *a, uint64_t i) {
    const double share = a->count > 1 ? (double)i / (double)(a->count - 1) : 0.0;
    if (a->is_log) {
        return a->from * exp(share * log(a->to / a->from));
    }
    return (1.0 - share) * a->from + share * a->to;
}

static void rising(const axis *a, double *value, uint64_t *which) {
    for (uint64_t i = 0; i < a->count; i++) {
        which[i] = a->from <= a->to ? i : a->count - 1 - i;
        value[i] = value_of(a, which[i]);
    }
}

/* Beyond the map on either side, at none, or within it. */
static double drawn_limit_s(dice *d, const shown_map *s, uint64_t along) {
    const double *v = s->value[0];
    switch (dice_one_of(d, 5)) {
    case 0: return (double)NAN;
    case 1: return 0.0;
    case 2: return 3.0 * v[along - 1];
    default: return dice_between(d, 0.5 * v[0], 1.2 * v[along - 1]);
    }
}

static void draw_map(dice *d, shown_map *s) {
    memset(s, 0, sizeof *s);
    static char names[3][8] = {"step", "k", "m"};
    const unsigned step = dice_one_of(d, 3); /* the first, the second, or none is the step */
    for (unsigned k = 0; k < 2; k++) {
        s->axes[k] = drawn_axis(d, step == k ? NULL : &swept[k], names[step == k ? 0 : 1 + k]);
    }
    s->grid = (grid){.axes = s->axes, .count = 2, .points = s->axes[0].count * s->axes[1].count};
    const int along = step == 0 ? 0 : 1;
    const axis *rows = &s->axes[1 - along];
    const uint64_t across = s->axes[along].count;
    rising(&s->axes[along], s->value[0], s->place[0]);
    rising(rows, s->value[1], s->place[1]);
    s->map = (stability_map){.grid = &s->grid,
                             .cell = s->cell,
                             .done = s->grid.points,
                             .along = along,
                             .has_limit = step < 2,
                             .limit_s = s->limit_s};
    const unsigned kinds = 1 + dice_one_of(d, MAP_VERDICTS);
    for (uint64_t i = 0; i < s->grid.points; i++) {
        const map_verdict verdict = (map_verdict)dice_one_of(d, kinds);
        s->cell[i] = (map_cell){verdict, dice_between(d, 1.0, 9.0), dice_between(d, 0.0, 1.0),
                                dice_one_of(d, 2) == 0 ? (double)NAN : dice_between(d, 0.0, 1.0)};
    }
    for (uint64_t row = 0; row < rows->count; row++) {
        s->limit_of[row] = step < 2 ? drawn_limit_s(d, s, across) : (double)NAN;
        s->limit_s[s->place[1][row]] = s->limit_of[row];
        for (uint64_t i = 0; i < across; i++) {
            const uint64_t first = along == 0 ? s->place[0][i] : s->place[1][row];
            const uint64_t second = along == 0 ? s->place[1][row] : s->place[0][i];
            s->at[row][i] = &s->cell[first * s->axes[1].count + second];
        }
    }
}

static uint64_t across_of(const shown_map *s) { return s->axes[s->map.along].count; }
static uint64_t rows_of(const shown_map *s) { return s->axes[1 - s->map.along].count; }

/* --- in words --------------------------------------------------------------------------------------------*/

/* A row as it should stand: its marks, with the limit between the last step that it lets be and the next. */
static void marks_of(const shown_map *s, uint64_t row, char *marks) {
    const double limit_s = s->limit_of[row];
    bool before = isfinite(limit_s);
    for (uint64_t i = 0; i < across_of(s); i++) {
        if (before && s->value[0][i] > limit_s) {
            *marks++ = '|';
            before = false;
        }
        *marks++ = ".ox#-?"[s->at[row][i]->verdict];
    }
    if (before) {
        *marks++ = '|';
    }
    *marks = '\0';
}

static void expect_row(const shown_map *s, uint64_t row, const char *line) {
    char marks[2 * MOST];
    char found[LINE] = "";
    char behind[LINE] = "";
    double value = 0.0;
    marks_of(s, row, marks);
    TEST_ASSERT_TRUE_MESSAGE(sscanf(line, " %lf %399s %399[^\n]", &value, found, behind) >= 2,
                             line);
    TEST_ASSERT_DOUBLE_WITHIN(1e-5 * fabs(s->value[1][row]) + 1e-9, s->value[1][row], value);
    TEST_ASSERT_EQUAL_STRING(marks, found);
    const double limit_s = s->limit_of[row];
    if (isnan(limit_s)) {
        TEST_ASSERT_EQUAL_STRING("", behind);
    } else if (limit_s == 0.0) {
        TEST_ASSERT_EQUAL_STRING("none", behind);
    } else {
        char *unit;
        TEST_ASSERT_DOUBLE_WITHIN(1e-3 * limit_s, limit_s, strtod(behind, &unit));
        TEST_ASSERT_EQUAL_STRING(" s", unit);
    }
}

/* Each verdict that occurs, from good to bad, and how often. */
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
        char mark;
        char word[LINE];
        unsigned long told = 0;
        TEST_ASSERT_NOT_NULL(fgets(line, sizeof line, in));
        TEST_ASSERT_EQUAL_INT(3, sscanf(line, " %c %399s %lu", &mark, word, &told));
        TEST_ASSERT_EQUAL_INT(".ox#-?"[verdict], mark);
        TEST_ASSERT_EQUAL_STRING(map_verdicts[verdict].word, word);
        TEST_ASSERT_EQUAL_UINT64(count, told);
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
    TEST_ASSERT_EQUAL_INT_MESSAGE(
        4, sscanf(line, " %399s %399s from %lf to %lf", first, second, &from, &to), line);
    TEST_ASSERT_EQUAL_STRING(s->axes[1 - s->map.along].column, first);
    TEST_ASSERT_EQUAL_STRING(s->axes[s->map.along].column, second);
    TEST_ASSERT_DOUBLE_WITHIN(1e-5 * fabs(from), s->value[0][0], from);
    TEST_ASSERT_DOUBLE_WITHIN(1e-5 * fabs(to), s->value[0][across_of(s) - 1], to);
    TEST_ASSERT_EQUAL_INT(s->axes[s->map.along].is_log, strstr(line, ", logarithmic") != NULL);
    TEST_ASSERT_EQUAL_INT(s->map.has_limit, strstr(line, "longest stable step") != NULL);
    for (uint64_t row = rows_of(s); row-- > 0;) { /* the largest on top */
        TEST_ASSERT_NOT_NULL(fgets(line, sizeof line, both));
        expect_row(s, row, line);
    }
    TEST_ASSERT_NOT_NULL(fgets(line, sizeof line, both));
    TEST_ASSERT_EQUAL_STRING("\n", line);
    expect_legend(s, both);
    fclose(both);
}

/* --- in rows ---------------------------------------------------------------------------------------------*/

/* The next field of a line of CSV: empty is NAN. */
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
    TEST_ASSERT_TRUE(map_csv(both, &s->map));
    rewind(both);
    TEST_ASSERT_NOT_NULL(fgets(line, sizeof line, both));
    char head[LINE];
    snprintf(head, sizeof head, "%s,%s,verdict,until,end,energy_left_over,limit\r\n",
             s->axes[0].column, s->axes[1].column);
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
        expect_field(value_of(&s->axes[0], which[0]), &at);
        expect_field(value_of(&s->axes[1], which[1]), &at);
        const char *word = map_verdicts[c->verdict].word;
        TEST_ASSERT_EQUAL_INT(0, strncmp(at, word, strlen(word)));
        at += strlen(word) + 1;
        expect_field(known ? c->until_s : (double)NAN, &at);
        expect_field(known ? c->end_s : (double)NAN, &at);
        expect_field(c->left_over, &at);
        expect_field(s->limit_s[which[1 - s->map.along]], &at);
        TEST_ASSERT_EQUAL_STRING("\r\n", at);
    }
    TEST_ASSERT_NULL(fgets(line, sizeof line, both));
    fclose(both);
}

/* --- the picture -----------------------------------------------------------------------------------------*/

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
    while (i < across_of(s) && s->at[row][i]->verdict != verdict) {
        i++;
    }
    *from = i;
    while (i < across_of(s) && s->at[row][i]->verdict == verdict) {
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
            TEST_ASSERT_EQUAL_INT(6, sscanf(text, "%lf %lf %lf %lf %lf %lf", &b.x, &b.y, &b.left,
                                            &b.right, &b.low, &b.high));
            text = strchr(text, '\n') + 1;
            TEST_ASSERT_TRUE(b.left < b.x && b.x < b.right && b.low < b.y && b.y < b.high);
            expect_end(along, s->value[0], from, false, b.left);
            expect_end(along, s->value[0], end - 1, true, b.right);
            expect_end(rows, s->value[1], row, false, b.low);
            expect_end(rows, s->value[1], row, true, b.high);
        }
    }
    TEST_ASSERT_EQUAL_INT(0, strncmp(text, "EOD\n", 4));
}

/* The limit where it is within the picture, as high as its row; a gap where it is not. */
static unsigned expect_limits(const shown_map *s, const double ends[2], const char *text) {
    const axis *rows = &s->axes[1 - s->map.along];
    unsigned count = 0;
    for (uint64_t k = 0; k < rows->count; k++) {
        const uint64_t row = rows->from <= rows->to ? k : rows->count - 1 - k;
        const double limit_s = s->limit_of[row];
        if (!(limit_s > ends[0] && limit_s < ends[1])) {
            TEST_ASSERT_EQUAL_INT('\n', *text);
            text++;
            continue;
        }
        box b;
        TEST_ASSERT_EQUAL_INT(4,
                              sscanf(text, "%lf %lf %lf %lf", &b.left, &b.low, &b.right, &b.high));
        text = strchr(strchr(text, '\n') + 1, '\n') + 1;
        TEST_ASSERT_DOUBLE_WITHIN(1e-8 * limit_s, limit_s, b.left);
        TEST_ASSERT_DOUBLE_WITHIN(1e-8 * limit_s, limit_s, b.right);
        expect_end(rows, s->value[1], row, false, b.low);
        expect_end(rows, s->value[1], row, true, b.high);
        count++;
    }
    TEST_ASSERT_EQUAL_INT(0, strncmp(text, "EOD\n", 4));
    return count;
}

/* A range, its logarithm and its label. */
static void expect_axis(const char *told, const axis *a, const double *v, char letter,
                        double *ends) {
    char what[80];
    snprintf(what, sizeof what, "set %crange [", letter);
    const char *at = strstr(told, what);
    TEST_ASSERT_NOT_NULL(at);
    TEST_ASSERT_EQUAL_INT(2, sscanf(at + strlen(what), "%lf:%lf]", &ends[0], &ends[1]));
    expect_end(a, v, 0, false, ends[0]);
    expect_end(a, v, a->count - 1, true, ends[1]);
    snprintf(what, sizeof what, "set logscale %c\n", letter);
    TEST_ASSERT_EQUAL_INT(a->is_log && a->from > 0.0, strstr(told, what) != NULL);
    snprintf(what, sizeof what, "set %clabel \"%s\".'%s' noenhanced\n", letter, a->column,
             a->symbol == NULL ? " [s]" : "");
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
        char block[40];
        snprintf(block, sizeof block, "$%s << EOD\n", map_verdicts[verdict].word);
        const char *at = strstr(told, block);
        const bool drawn = verdict <= MAP_DIVERGES && map_count(&s->map, (map_verdict)verdict) > 0;
        TEST_ASSERT_EQUAL_INT(drawn, at != NULL);
        snprintf(block, sizeof block, "$%s with boxxyerror", map_verdicts[verdict].word);
        expect_plot_line(told, drawn, block);
        if (at != NULL) {
            expect_boxes(s, (map_verdict)verdict, strchr(at, '\n') + 1);
            any = true;
        }
    }
    const char *limits = strstr(told, "$limit << EOD\n");
    TEST_ASSERT_NOT_NULL(limits);
    const bool line = expect_limits(s, ends, strchr(limits, '\n') + 1) > 0;
    expect_plot_line(told, line, "$limit with lines");
    expect_plot_line(told, !line && !any, "plot NaN");
    TEST_ASSERT_NULL(strstr(told, "plot ,"));
}

/* --- all three -------------------------------------------------------------------------------------------*/

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

static void test_maps_say_what_they_hold(void) {
    dice d = dice_of("map_shown", 2311);
    char *path = play_gnuplot("exec cat");
    shown_map s;
    for (unsigned i = few_or_all(usual_or(60, 15), 400); i > 0; i--) {
        draw_map(&d, &s);
        expect_words(&s);
        expect_csv(&s);
        expect_picture(&s);
    }
    stop_playing(path);
}

/* Told, and no picture that is said to be there. */
static void test_pictures_that_cannot_be_drawn(void) {
    dice d = dice_of("map_shown", 2320);
    shown_map s;
    draw_map(&d, &s);
    TEST_ASSERT_FALSE(map_plot("build/tests/none/map.svg", &s.map, "words"));
    char *path = play_gnuplot("exit 1");
    TEST_ASSERT_FALSE(map_plot(PICTURE, &s.map, "words"));
    stop_playing(path);
}

void suite_map_shown(void) {
    RUN_TEST(test_pictures_that_cannot_be_drawn);
    RUN_TEST(test_maps_say_what_they_hold);
}

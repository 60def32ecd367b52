/* test_map_shown.c: drawn maps in words and in rows, read again and held to what they were drawn from: what stands at which
 * pair. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "derived.h"
#include "host/study/stability_map.h"
#include "shown_map.h"

#include "unity.h"

void suite_map_shown(void);

enum { LINE = 400 };

/* --- in words --------------------------------------------------------------------------------------------*/

/* A row as it should stand. */
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

/* --- both ------------------------------------------------------------------------------------------------*/

static void test_maps_say_what_they_hold(void) {
    dice d = dice_of("map_shown", 2311);
    shown_map s;
    for (unsigned i = few_or_all(15, 1000); i > 0; i--) {
        shown_map_draw(&d, &s);
        expect_words(&s);
        expect_csv(&s);
    }
}

/* --- while it is made --------------------------------------------------------------------------------------*/

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

/* How many runs are done, with what is done of the one under way: never less than before, and all of them at the end. */
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

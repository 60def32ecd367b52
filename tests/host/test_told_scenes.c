/* test_told_scenes.c: what is told of every built-in scene in words: by `whirl describe`, and at the head of its generated C,
 * whose scene names what the file defines. (The JSON of it: test_describe.c.) */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "derived.h"
#include "host/emit/description.h"
#include "host/emit/emit.h"
#include "unity.h"

void suite_told_scenes(void);

static unsigned tables_seen;

/* The words of a line that begins with these, blanks apart from each other as they like: " real [0] X [m] 0 carriage". */
static bool has_row(const char *text, const char *row) {
    for (const char *line = text; line != NULL; line = strchr(line, '\n')) {
        const char *at = line += *line == '\n';
        const char *want = row;
        for (;;) {
            at += strspn(at, " ");
            want += strspn(want, " ");
            if (*want == '\0') {
                break;
            }
            const size_t length = strcspn(want, " ");
            if (strncmp(at, want, length) != 0 || (at[length] != ' ' && at[length] != '\n')) {
                break;
            }
            at += length;
            want += length;
        }
        if (*want == '\0' && *at == '\n') {
            return true;
        }
    }
    return false;
}

static void expect_row(const char *text, const char *row) {
    if (!has_row(text, row)) {
        printf("  no row '%s' in\n%s", row, text);
        TEST_FAIL_MESSAGE(row);
    }
}

static void expect_quantities(const char *text, const char *kind, const image_quantity *q,
                              int count, bool valued) {
    for (int i = 0; i < count; i++) {
        char row[600];
        char value[40] = "";
        snprintf(value, sizeof value, "%.9g", q[i].value);
        snprintf(row, sizeof row, "%s[%d] %s [%s] %s %s", kind, i, q[i].name, q[i].unit.si,
                 valued ? value : "", q[i].text);
        expect_row(text, row);
    }
}

/* What an image has stands in it, each on its own row. */
static void check_text(const image *im) {
    char *text = derived_written(describe_text, im);
    char row[600];
    for (int i = 0; i < im->angles + im->reals; i++) {
        const component c = image_component(im, i);
        const image_unknown *u = &im->unknown[c.unknown];
        const bool turns = i < im->angles;
        const int index = turns ? i : i - im->angles;
        char primes[20];
        TEST_ASSERT_TRUE(c.primes >= 0 && (size_t)c.primes < sizeof primes);
        memset(primes, '\'', (size_t)c.primes);
        primes[c.primes] = '\0';
        snprintf(row, sizeof row, "%s[%d] %s%s [%s] %.9g %s", turns ? "angle " : "real  ", index,
                 u->name, primes, u->unit[c.primes].si,
                 turns ? im->start_rad[index] : im->start_real[index],
                 c.primes == 0 ? u->text : "");
        expect_row(text, row);
    }
    expect_quantities(text, "input ", im->input, im->inputs, true);
    expect_quantities(text, "output", im->output, im->own_outputs, false);
    expect_quantities(text, "param ", im->parameter, im->parameters, true);
    for (int i = 0; i < im->effects; i++) {
        snprintf(row, sizeof row, "with %s: %s", im->effect[i].name, im->effect[i].text);
        TEST_ASSERT_EQUAL_MESSAGE(im->effect[i].with, has_row(text, row), row);
    }
    const tape_cost cost = tape_count(im->list[IMAGE_STEP]);
    snprintf(row, sizeof row, "step %d %d %d %d %d %d", im->list[IMAGE_STEP]->results,
             cost.arithmetic, cost.divisions, cost.roots, cost.waves, cost.calls);
    expect_row(text, row);
    free(text);
}

/* A scene names what the file defines, and whatever the file defines of these. */
static void check_what_c_defines(const char *text) {
    static const char *const defined[][2] = {
        {".ahead = ahead,", " ahead(const wh_scene *"},
        {".observe = observe,", " observe(const wh_scene *"},
        {".start_angle = start_angle,", " start_angle["},
        {".start_real = start_real,", " start_real["},
        {".start_input = start_input,", " start_input["},
        {".advance = advance,", " advance(const wh_scene *"},
    };
    for (size_t i = 0; i < sizeof defined / sizeof defined[0]; i++) {
        TEST_ASSERT_EQUAL_MESSAGE(strstr(text, defined[i][1]) != NULL,
                                  strstr(text, defined[i][0]) != NULL, defined[i][0]);
    }
}

/* Generated C says at its head what its arrays hold. */
static void check_names_in_c(const image *im) {
    char *text = derived_written(emit_c, im);
    check_what_c_defines(text);
    for (int i = 0; i < im->angles + im->reals; i++) {
        const component c = image_component(im, i);
        char primes[20] = "";
        char row[200];
        memset(primes, '\'', (size_t)c.primes);
        snprintf(row, sizeof row, "* %s[%d] %s%s", i < im->angles ? "angle" : "real",
                 i < im->angles ? i : i - im->angles, im->unknown[c.unknown].name, primes);
        expect_row(text, row);
    }
    for (int i = 0; i < im->inputs; i++) {
        char row[200];
        snprintf(row, sizeof row, "* input[%d] %s", i, im->input[i].name);
        expect_row(text, row);
    }
    for (int i = 0; i < im->own_outputs; i++) {
        char row[200];
        snprintf(row, sizeof row, "* output[%d] %s", i, im->output[i].name);
        expect_row(text, row);
    }
    free(text);
}

/* Tables of what one angle's functions are, each with its size and how far off it may be. */
static void check_tables(const derived *d) {
    for (int form = TABLES_LINEAR; form <= TABLES_CUBIC; form++) {
        const image_settings settings = {
            .tables = (image_tables)form, .cells = 64, .method = WH_RK4};
        diags *errors = diags_new();
        image *im =
            image_make(d->equations, d->instance->conserve, &settings, IMAGE_TO_WRITE, errors);
        diags_free(errors);
        if (im == NULL) {
            continue; /* there is nothing to look up */
        }
        const tape_tables *t = &im->list[IMAGE_STEP]->tables;
        char *text = derived_written(describe_text, im);
        for (int k = 0; k < t->count; k++) {
            char row[200];
            snprintf(row, sizeof row, "%d up to %.4g in size, off by %.2g at most", k, t->size[k],
                     t->off[k]);
            expect_row(text, row);
            tables_seen++;
        }
        free(text);
        image_free(im);
    }
}

static int check_scene(const scene *s) {
    derived d = derived_builtin(s->name);
    derived_expect(&d, s->name);
    check_text(d.image);
    check_names_in_c(d.image);
    check_tables(&d);
    derived_free(&d);
    return 1;
}

static void test_every_scene_is_told(void) {
    tables_seen = 0;
    TEST_ASSERT_TRUE(each_builtin_scene(check_scene) > 60);
    TEST_ASSERT_TRUE(tables_seen > 20);
}

/* Declared ranges in SI, under one heading. */
static void test_ranges_are_told(void) {
    derived d = derived_scene(derived_ranged, "s");
    derived_expect(&d, derived_ranged);
    char *told = derived_written(describe_text, d.image);
    const char *heading = strstr(told, "ranges, SI");
    TEST_ASSERT_NOT_NULL_MESSAGE(heading, told);
    TEST_ASSERT_NULL_MESSAGE(strstr(heading + 1, "ranges, SI"), told);
    expect_row(told, "pull -2000 .. 4000");
    expect_row(told, "x -1.5 .. 3");
    expect_row(told, "a' 1 .. 2");
    free(told);
    derived_free(&d);
}

void suite_told_scenes(void) {
    RUN_TEST(test_every_scene_is_told);
    RUN_TEST(test_ranges_are_told);
}

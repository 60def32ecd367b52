/* test_describe.c: `whirl describe --json`: declared ranges, a step as a matrix; docs/describe.md has each field; and the checker
 * that says so refuses what is not JSON. (Every field, of drawn scenes: test_described_drawn.c.) */
#define _POSIX_C_SOURCE 200809L

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "derived.h"
#include "host/emit/description.h"
#include "json_check.h"
#include "motion.h"
#include "unity.h"

void suite_describe(void);

static char *described(const image *im) { return derived_written(describe_json, im); }

static void expect_value(const char *text, const char *path, const char *wanted) {
    char value[100];
    TEST_ASSERT_NOT_NULL_MESSAGE(json_value(text, path, value), path);
    TEST_ASSERT_EQUAL_STRING_MESSAGE(wanted, value, path);
}

static void expect_number(const char *text, const char *path, double wanted) {
    char value[100];
    TEST_ASSERT_NOT_NULL_MESSAGE(json_value(text, path, value), path);
    TEST_ASSERT_TRUE_MESSAGE(strtod(value, NULL) == wanted, path);
}

static void expect_valid(const char *text, const char *what) {
    char why[100];
    const bool valid = json_is_valid(text, why);
    if (!valid) {
        printf("  %s: %s\n", what, why);
    }
    TEST_ASSERT_TRUE_MESSAGE(valid, what);
}

/* Whose momentum an account of the books is, in which unit; and which row goes into which. */
static void check_accounts(const char *text, const image *im) {
    char path[60];
    TEST_ASSERT_EQUAL_INT(im->ledger.accounts, json_length(text, "ledger/accounts"));
    for (int i = 0; i < im->ledger.accounts; i++) {
        const image_unknown *u = i > 0 ? &im->unknown[im->ledger.unknown[i]] : NULL;
        snprintf(path, sizeof path, "ledger/accounts/%d/index", i);
        expect_number(text, path, i);
        snprintf(path, sizeof path, "ledger/accounts/%d/of", i);
        expect_value(text, path, i > 0 ? u->name : "energy");
        snprintf(path, sizeof path, "ledger/accounts/%d/si", i);
        expect_value(text, path, i > 0 ? u->momentum_si : "J");
    }
    for (int i = 0; i < im->ledger.smooth; i++) {
        snprintf(path, sizeof path, "ledger/rows/%d/account", i);
        expect_number(text, path, im->ledger.entry[i].account);
        snprintf(path, sizeof path, "ledger/rows/%d/kind", i);
        expect_value(text, path, describe_ledger_kind(im->ledger.entry[i].kind));
    }
}

/* Declared ranges in SI, whatever unit and order they were declared in; of all others null. */
static void test_ranges_are_described(void) {
    derived d = derived_scene(derived_ranged, "s");
    derived_expect(&d, derived_ranged);
    char *json = described(d.image);
    expect_valid(json, derived_ranged);
    for (int i = 0; i < d.image->reals + d.image->inputs; i++) {
        static const struct {
            const char *name;
            double low, high;
        } declared[] = {{"pull", -2000.0, 4000.0}, {"x", -1.5, 3.0}, {"a'", 1.0, 2.0}};
        const bool is_input = i >= d.image->reals;
        const char *list = is_input ? "inputs" : "reals";
        const int index = is_input ? i - d.image->reals : i;
        int found = -1;
        char path[80];
        for (int k = 0; k < 3; k++) {
            found = strcmp(declared[k].name, d.image->range[i].name) == 0 ? k : found;
        }
        snprintf(path, sizeof path, "%s/%d/range", list, index);
        TEST_ASSERT_EQUAL_INT_MESSAGE(found < 0 ? -1 : 2, json_length(json, path), path);
        if (found >= 0) {
            snprintf(path, sizeof path, "%s/%d/range/0", list, index);
            expect_number(json, path, declared[found].low);
            snprintf(path, sizeof path, "%s/%d/range/1", list, index);
            expect_number(json, path, declared[found].high);
        }
    }
    free(json);
    derived_free(&d);
}

static double number_at(const char *json, const char *list, int row, int column) {
    char path[60];
    char value[100];
    snprintf(path, sizeof path, column < 0 ? "%s/%d" : "%s/%d/%d", list, row, column);
    TEST_ASSERT_NOT_NULL_MESSAGE(json_value(json, path, value), path);
    return strtod(value, NULL);
}

/* A step as a matrix: what it makes of the start is where a step of the method gets to. */
static void test_a_matrix_is_described(void) {
    static const char text[] =
        "mechanism m\ncoordinate x [m]\ncoordinate y [m]\nparameter k = 7 [N/m]\n"
        "input push = 3 [N]\ninput pull = -2 [N]\nT = 2 [kg]*x'^2/2 + 3 [kg]*y'^2/2\n"
        "V = k*(x - y)^2/2 + k*x^2 + 5 [N]*y\nF = 0.4 [kg/s]*(x'^2 + x'*y')/2\n"
        "Q(x) = push\nQ(y) = pull\n"
        "scene s {\nstart x = 0.3 [m], y = -0.2 [m], x' = 1 [m/s], y' = 2 [m/s]\nstep 20 [ms]\n"
        "until 1 [s]\n}\n";
    motion with;
    motion m;
    double x[2][8];
    motion_open_text(&with, text,
                     (stepping){.kind = &engine_double, .method = WH_RK4, .matrix = MATRIX_RK4});
    motion_open_text(&m, text, IN_DOUBLE);
    char *json = described(with.image);
    expect_valid(json, text);
    expect_value(json, "matrix", "rk4");
    const int states = m.image->reals;
    TEST_ASSERT_EQUAL_INT(4, states);
    TEST_ASSERT_EQUAL_INT(states, json_length(json, "phi"));
    TEST_ASSERT_EQUAL_INT(states, json_length(json, "gamma"));
    TEST_ASSERT_EQUAL_INT(states, json_length(json, "g"));
    m.kind->state(m.run, NULL, x[0]);
    TEST_ASSERT_EQUAL_INT(WH_OK, motion_step(&m, 1));
    m.kind->state(m.run, NULL, x[1]);
    for (int i = 0; i < states; i++) {
        TEST_ASSERT_EQUAL_INT(states, json_length(json, i == 0 ? "phi/0" : "phi/3"));
        TEST_ASSERT_EQUAL_INT(2, json_length(json, i == 0 ? "gamma/0" : "gamma/3"));
        double sum = number_at(json, "g", i, -1);
        for (int k = 0; k < states; k++) {
            sum += number_at(json, "phi", i, k) * x[0][k];
        }
        for (int k = 0; k < 2; k++) {
            sum += number_at(json, "gamma", i, k) * m.image->input[k].value;
        }
        TEST_ASSERT_DOUBLE_WITHIN(1e-13, x[1][i], sum);
    }
    free(json);
    motion_close(&m);
    motion_close(&with);
}

static void test_the_checker_is_strict(void) {
    static const char *const wrong[] = {"",
                                        "{",
                                        "{}}",
                                        "[1,]",
                                        "{\"a\":1,}",
                                        "{a:1}",
                                        "[01]",
                                        "[1.]",
                                        "[.5]",
                                        "[+1]",
                                        "[1e]",
                                        "[nan]",
                                        "[inf]",
                                        "[0x1]",
                                        "[\"\\x\"]",
                                        "[\"\n\"]",
                                        "['a']",
                                        "[\"\\u12\"]",
                                        "[\"\xff\"]",
                                        "[1 2]",
                                        "{\"a\":1,\"a\":2}",
                                        "[true,false,nul]",
                                        "[] []",
                                        "[\"a]"};
    static const char *const right[] = {"{}", "[]", " [ 1 , -0.5e+3 ] ",
                                        "{\"a\":[null,true,false]}", "\"\\u00e9\\n\""};
    char why[100];
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        TEST_ASSERT_FALSE_MESSAGE(json_is_valid(wrong[i], why), wrong[i]);
    }
    for (size_t i = 0; i < sizeof right / sizeof right[0]; i++) {
        TEST_ASSERT_TRUE_MESSAGE(json_is_valid(right[i], why), right[i]);
    }
}

/* --- the page ------------------------------------------------------------------------------------------*/

static char *page_text(void) {
    FILE *in = fopen("docs/describe.md", "rb");
    TEST_ASSERT_NOT_NULL(in);
    char *text = calloc(1, 1 << 16);
    TEST_ASSERT_NOT_NULL(text);
    TEST_ASSERT_TRUE(fread(text, 1, (1 << 16) - 1, in) > 1000);
    fclose(in);
    return text;
}

/* Each key that is written stands in docs/describe.md; one a line, as json.h writes them. */
static void check_keys(const char *json, const char *page) {
    for (const char *line = json; line != NULL; line = strchr(line, '\n')) {
        line += strspn(line, "\n ");
        const size_t length = *line == '"' ? strcspn(line + 1, "\"") : 0;
        if (length > 0 && line[length + 2] == ':') {
            char named[60];
            snprintf(named, sizeof named, "`%.*s`", (int)length, line + 1);
            TEST_ASSERT_NOT_NULL_MESSAGE(strstr(page, named), named);
        }
    }
}

static void test_every_field_is_documented(void) {
    static const char *const scenes[] = {"shuttle_clamped", "thomson_a_conserved", "carriage_stop"};
    char *page = page_text();
    for (size_t i = 0; i < sizeof scenes / sizeof scenes[0]; i++) {
        derived d = derived_builtin(scenes[i]);
        derived_expect(&d, scenes[i]);
        d.instance->ledger = true;
        diags *errors = diags_new();
        image *kept =
            image_make(d.equations, d.instance->conserve, &plainly, IMAGE_TO_WRITE, errors);
        TEST_ASSERT_NOT_NULL(kept);
        char *json = described(kept);
        expect_valid(json, scenes[i]);
        check_keys(json, page);
        check_accounts(json, kept);
        free(json);
        image_free(kept);
        diags_free(errors);
        derived_free(&d);
    }
    free(page);
}

void suite_describe(void) {
    RUN_TEST(test_every_field_is_documented);
    RUN_TEST(test_the_checker_is_strict);
    RUN_TEST(test_ranges_are_described);
    RUN_TEST(test_a_matrix_is_described);
}

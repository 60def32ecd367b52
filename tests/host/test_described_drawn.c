/* test_described_drawn.c: `whirl describe --json` of scenes that are drawn holds every field of the image, and is laid out as
 * its brackets say. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/contact.h"
#include "derived.h"
#include "drawn_scene.h"
#include "host/emit/description.h"
#include "host/image/turned.h"
#include "json_check.h"
#include "unity.h"

void suite_described_drawn(void);

static dice die;
static drawn_scene drawn;
static char *json;

/* --- JSON ----------------------------------------------------------------------------------------------------- */

static void expect_text(const char *path, const char *wanted) {
    char value[200];
    char escaped[200];
    size_t used = 0;
    for (const char *at = wanted; *at != '\0'; at++) { /* as it stands between its quotes */
        if (*at == '"' || *at == '\\') {
            escaped[used++] = '\\';
        }
        escaped[used++] = *at;
    }
    escaped[used] = '\0';
    TEST_ASSERT_NOT_NULL_MESSAGE(json_value(json, path, value), path);
    TEST_ASSERT_EQUAL_STRING_MESSAGE(escaped, value, path);
}

static void expect_number(const char *path, double wanted) {
    char value[200];
    TEST_ASSERT_NOT_NULL_MESSAGE(json_value(json, path, value), path);
    TEST_ASSERT_TRUE_MESSAGE(strtod(value, NULL) == wanted, path);
}

static void expect_bool(const char *path, bool wanted) {
    expect_text(path, wanted ? "true" : "false");
}

/* "LIST/INDEX/KEY" */
static const char *in(const char *list, int i, const char *key) {
    static char path[120];
    snprintf(path, sizeof path, "%s/%d/%s", list, i, key);
    return path;
}

static void expect_unit(const char *list, int i, const image_unit *unit) {
    expect_text(in(list, i, "si"), unit->si);
    expect_text(in(list, i, "unit"), unit->shown);
    expect_number(in(list, i, "unit_si"),
                  unit->scale == unit->divisor ? 1.0 : unit->scale / unit->divisor);
}

static void expect_place(const char *list, int i, place at) {
    expect_number(in(list, i, "line"), at.line);
    expect_number(in(list, i, "column"), at.column);
    expect_text(in(list, i, "statement"), drawn_scene_statement(at.line));
}

static void expect_quantities(const char *list, const image_quantity *q, int count, bool valued) {
    char value[200];
    for (int i = 0; i < count; i++) {
        expect_number(in(list, i, "index"), i);
        expect_text(in(list, i, "name"), q[i].name);
        expect_text(in(list, i, "text"), q[i].text);
        expect_unit(list, i, &q[i].unit);
        expect_place(list, i, q[i].at);
        if (valued) {
            expect_number(in(list, i, "value"), q[i].value);
        } else {
            TEST_ASSERT_NULL(json_value(json, in(list, i, "value"), value));
        }
    }
}

static void expect_range(const char *list, int i, const image_range *range) {
    char path[120];
    TEST_ASSERT_EQUAL_INT(range->declared ? 2 : -1, json_length(json, in(list, i, "range")));
    if (range->declared) {
        snprintf(path, sizeof path, "%s/%d/range/0", list, i);
        expect_number(path, range->low);
        snprintf(path, sizeof path, "%s/%d/range/1", list, i);
        expect_number(path, range->high);
    } else {
        expect_text(in(list, i, "range"), "null");
    }
}

static void expect_component(const char *list, int i, component c) {
    const image_unknown *u = &drawn.unknown[c.unknown];
    expect_number(in(list, i, "index"), i);
    expect_text(in(list, i, "name"), u->name);
    expect_number(in(list, i, "primes"), c.primes);
    expect_text(in(list, i, "text"), u->text);
    expect_unit(list, i, &u->unit[c.primes]);
}

static void check_state(const image *im) {
    TEST_ASSERT_EQUAL_INT(im->angles, json_length(json, "angles"));
    TEST_ASSERT_EQUAL_INT(im->reals, json_length(json, "reals"));
    TEST_ASSERT_EQUAL_INT(im->inputs, json_length(json, "inputs"));
    TEST_ASSERT_EQUAL_INT(im->outputs, json_length(json, "outputs"));
    TEST_ASSERT_EQUAL_INT(im->parameters, json_length(json, "parameters"));
    for (int i = 0; i < im->angles; i++) {
        expect_component("angles", i, im->angle[i]);
        expect_number(in("angles", i, "start"), im->start_rad[i]);
        expect_number(in("angles", i, "start_float"), (double)im->start_turns[i]);
    }
    for (int i = 0; i < im->reals; i++) {
        expect_component("reals", i, im->real[i]);
        expect_number(in("reals", i, "start"), im->start_real[i]);
        expect_number(in("reals", i, "start_float"), (double)(float)im->start_real[i]);
        expect_range("reals", i, &im->range[i]);
    }
    expect_quantities("inputs", im->input, im->inputs, true);
    for (int i = 0; i < im->inputs; i++) {
        expect_range("inputs", i, &im->range[im->reals + i]);
    }
    expect_quantities("outputs", im->output, im->own_outputs, false);
    expect_quantities("parameters", im->parameter, im->parameters, true);
    for (int k = 0; k < 2 * im->recovered; k++) {
        const int i = im->own_outputs + k;
        expect_component("outputs", i, (component){im->from_momentum[k / 2], k % 2});
        expect_bool(in("outputs", i, "from_momentum"), true);
    }
}

static void check_contacts(const image *im) {
    TEST_ASSERT_EQUAL_INT(im->contacts, json_length(json, "contacts"));
    for (int k = 0; k < im->contacts; k++) {
        const image_contact *c = &im->contact[k];
        expect_number(in("contacts", k, "index"), k);
        expect_text(in("contacts", k, "kind"), c->word);
        expect_number(in("contacts", k, "direction"), c->direction);
        expect_number(in("contacts", k, "pin"), c->pin);
        expect_number(in("contacts", k, "sets"), c->sets);
        expect_place("contacts", k, c->at);
    }
}

static void check_ledger(const image *im) {
    static const char *const kinds[] = {"work", "loss", "energies", "drive", "damping"};
    const image_ledger *l = &im->ledger;
    if (!l->kept) {
        expect_text("ledger", "null");
        return;
    }
    expect_bool("ledger/asked", l->asked);
    expect_number("ledger/entries", l->entries);
    TEST_ASSERT_EQUAL_INT(l->accounts, json_length(json, "ledger/accounts"));
    for (int i = 0; i < l->accounts; i++) {
        const image_unknown *u = i > 0 ? &im->unknown[l->unknown[i]] : NULL;
        expect_number(in("ledger/accounts", i, "index"), i);
        expect_text(in("ledger/accounts", i, "of"), i > 0 ? u->name : "energy");
        expect_text(in("ledger/accounts", i, "si"), i > 0 ? u->momentum_si : "J");
    }
    TEST_ASSERT_EQUAL_INT(l->smooth, json_length(json, "ledger/rows"));
    for (int i = 0; i < l->smooth; i++) {
        expect_number(in("ledger/rows", i, "index"), i);
        expect_number(in("ledger/rows", i, "account"), l->entry[i].account);
        expect_text(in("ledger/rows", i, "kind"), kinds[l->entry[i].kind]);
        expect_place("ledger/rows", i, l->entry[i].at);
    }
}

static void expect_count(const char *role, const char *key, int wanted) {
    char path[80];
    snprintf(path, sizeof path, "lists/%s/%s", role, key);
    expect_number(path, wanted);
}

static void check_lists(const image *im) {
    char value[200];
    char path[80];
    for (int role = 0; role < IMAGE_ROLES; role++) {
        const op_list *t = im->list[role];
        if (t == NULL) {
            snprintf(path, sizeof path, "lists/%s", drawn_scene_roles[role]);
            TEST_ASSERT_NULL_MESSAGE(json_value(json, path, value), path);
            continue;
        }
        const op_list_cost cost = op_list_count(t);
        expect_count(drawn_scene_roles[role], "results", t->results);
        expect_count(drawn_scene_roles[role], "operations", op_list_operations(t));
        expect_count(drawn_scene_roles[role], "additions_and_products", cost.arithmetic);
        expect_count(drawn_scene_roles[role], "divisions", cost.divisions);
        expect_count(drawn_scene_roles[role], "roots", cost.roots);
        expect_count(drawn_scene_roles[role], "waves", cost.waves);
        expect_count(drawn_scene_roles[role], "calls", cost.calls);
        expect_count(drawn_scene_roles[role], "look_ups", cost.look_ups);
    }
}

static void check_tables(const image *im) {
    const op_list_tables *of = &im->list[IMAGE_STEP]->tables;
    if (im->settings.tables == TABLES_NONE) {
        expect_text("tables", "null");
        return;
    }
    expect_text("tables/form", im->settings.tables == TABLES_LINEAR ? "linear" : "cubic");
    expect_number("tables/cells", im->settings.cells);
    expect_bool("tables/folds", of->folds);
    TEST_ASSERT_EQUAL_INT(of->count, json_length(json, "tables/of"));
    for (int k = 0; k < of->count; k++) {
        expect_number(in("tables/of", k, "index"), k);
        expect_number(in("tables/of", k, "size"), of->size[k]);
        expect_number(in("tables/of", k, "off"), of->off[k]);
    }
}

static void check_matrix(const image *im) {
    static const char *const words[] = {"none", "exact", "rk4"};
    const int states = im->angles + im->reals;
    char path[60];
    expect_text("matrix", words[im->settings.matrix]);
    TEST_ASSERT_EQUAL_INT(im->settings.matrix == MATRIX_NONE ? -1 : states,
                          json_length(json, "phi"));
    for (int i = 0; i < states && im->settings.matrix != MATRIX_NONE; i++) {
        const double *row = im->matrix.entry + i * im->matrix.columns;
        snprintf(path, sizeof path, "phi/%d", i);
        TEST_ASSERT_EQUAL_INT(states, json_length(json, path));
        snprintf(path, sizeof path, "gamma/%d", i);
        TEST_ASSERT_EQUAL_INT(im->inputs, json_length(json, path));
        for (int k = 0; k < states + im->inputs; k++) {
            const bool of_input = k >= states;
            snprintf(path, sizeof path, "%s/%d/%d", of_input ? "gamma" : "phi", i,
                     of_input ? k - states : k);
            expect_number(path, row[k]);
        }
        snprintf(path, sizeof path, "g/%d", i);
        expect_number(path, row[states + im->inputs]);
    }
}

static void check_head(const image *im) {
    char hash[24];
    snprintf(hash, sizeof hash, "0x%016" PRIx64, im->hash);
    expect_number("version", 1);
    expect_text("name", im->name);
    expect_text("title", im->title);
    expect_text("mechanism", im->mechanism);
    expect_text("file", "x.whirl");
    expect_text("hash", hash);
    expect_text("form", im->form == WH_SECOND_ORDER ? "second order" : "first order");
    expect_bool("energies", im->has_energies);
    expect_text("method", wh_methods[im->settings.method].word);
    expect_number("stages",
                  im->settings.matrix != MATRIX_NONE ? 0 : wh_methods[im->settings.method].stages);
    expect_bool("compensated", im->settings.compensated);
    expect_text("sines", im->settings.tables != TABLES_NONE ? "tables"
                         : image_turns(im)                  ? "turned"
                                                            : "lookup");
    expect_number("step_s", im->step_s);
    expect_number("step_ratio/numerator", (double)im->step.numerator);
    expect_number("step_ratio/denominator", (double)im->step.denominator);
    expect_number("steps", (double)im->steps);
    expect_number("until_s", im->until_s);
    TEST_ASSERT_EQUAL_INT(im->effects, json_length(json, "effects"));
    for (int i = 0; i < im->effects; i++) {
        expect_text(in("effects", i, "name"), im->effect[i].name);
        expect_text(in("effects", i, "text"), im->effect[i].text);
        expect_bool(in("effects", i, "with"), im->effect[i].with);
    }
    if (im->contacts == 0) {
        expect_number("memory/float_bytes", (double)drawn_scene_bytes(im, 4));
        expect_number("memory/double_bytes", (double)drawn_scene_bytes(im, 8));
    } else {
        const size_t words = (drawn_scene_bytes(im, 4) + 7) / 8;
        expect_number("memory/float_bytes", (double)(words * 8 + sizeof(wh_contacts)));
    }
    expect_number("bounds/evaluations", drawn_scene_evaluations(im));
    expect_number("bounds/signals", drawn_scene_signals(im));
    expect_number("bounds/events", im->contacts > 0 ? WH_EVENTS_MAX : 0);
}

/* Two blanks a bracket that is open; one line a value; nothing behind a comma; a line's end at the end. */
static void check_layout(void) {
    int depth = 0;
    for (const char *line = json; *line != '\0';) {
        const size_t length = strcspn(line, "\n");
        const size_t indent = strspn(line, " ");
        const bool closes = line[indent] == '}' || line[indent] == ']';
        TEST_ASSERT_EQUAL_CHAR('\n', line[length]);
        depth -= closes;
        TEST_ASSERT_EQUAL_size_t_MESSAGE((size_t)depth * 2, indent, line);
        const char last = line[length - 1];
        depth += last == '{' || last == '[';
        line += length + 1;
    }
    TEST_ASSERT_EQUAL_INT(0, depth);
}

static void test_json_has_every_field(void) {
    char why[100];
    for (unsigned c = 0; c < dice_cases(few_or_all(usual_or(60, 15), 400)); c++) {
        drawn_scene_draw(&drawn, &die);
        const image *im = &drawn.im;
        json = derived_written(describe_json, im);
        TEST_ASSERT_TRUE_MESSAGE(json_is_valid(json, why), why);
        check_layout();
        check_head(im);
        check_state(im);
        check_contacts(im);
        check_ledger(im);
        check_lists(im);
        check_tables(im);
        check_matrix(im);
        free(json);
    }
}

/* Characters stay as they are; quotes, what steers, and bytes that are none of UTF-8 become what stands for them. */
static void test_any_text_is_told(void) {
    static const char *const pieces[][2] = {{"a", "a"},
                                            {" ~", " ~"},
                                            {"\xc3\xa9", "\xc3\xa9"},
                                            {"\xe2\x82\xac", "\xe2\x82\xac"},
                                            {"\"", "\\\""},
                                            {"\\", "\\\\"},
                                            {"\x01", "\\u0001"},
                                            {"\x1f", "\\u001f"},
                                            {"\x7f", "\\u007f"},
                                            {"\t", "\\u0009"},
                                            {"\xff", "\\ufffd"},
                                            {"\xc3 ", "\\ufffd "},
                                            {"\x80", "\\ufffd"},
                                            {"\xe2\x82 ", "\\ufffd\\ufffd "}};
    for (unsigned c = 0; c < 100; c++) {
        char text[80] = "";
        char wanted[120] = "";
        char value[200];
        for (unsigned n = dice_one_of(&die, 9); n > 0; n--) {
            const unsigned which = dice_one_of(&die, sizeof pieces / sizeof pieces[0]);
            strcat(text, pieces[which][0]);
            strcat(wanted, pieces[which][1]);
        }
        drawn_scene_draw(&drawn, &die);
        drawn.im.title = text;
        json = derived_written(describe_json, &drawn.im);
        TEST_ASSERT_NOT_NULL(json_value(json, "title", value));
        TEST_ASSERT_EQUAL_STRING(wanted, value);
        free(json);
    }
}

/* JSON has no word for these. */
static void test_what_is_no_number_is_null(void) {
    static const double none[] = {(double)NAN, (double)INFINITY, -(double)INFINITY};
    for (int i = 0; i < 3; i++) {
        char why[100];
        do {
            drawn_scene_draw(&drawn, &die);
        } while (drawn.im.parameters == 0);
        drawn.parameter[0].value = none[i];
        drawn.im.until_s = none[i];
        json = derived_written(describe_json, &drawn.im);
        TEST_ASSERT_TRUE_MESSAGE(json_is_valid(json, why), why);
        expect_text("parameters/0/value", "null");
        expect_text("until_s", "null");
        free(json);
    }
}

void suite_described_drawn(void) {
    die = dice_of("described_drawn", 4140);
    RUN_TEST(test_json_has_every_field);
    RUN_TEST(test_any_text_is_told);
    RUN_TEST(test_what_is_no_number_is_null);
}

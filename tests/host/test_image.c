/* test_image.c: an image must not depend on the objects of the language and the algebra: runs and output must be the
 * same after these are freed. Under the sanitizers, a remaining pointer into them fails here. An image that is
 * remade with other starts must equal one that was derived with them. */
#include "test.h"

#include "core/contact.h"
#include "host/check/energy_residual.h"
#include "host/check/nonfinite.h"
#include "host/check/slow.h"
#include "host/check/summary.h"
#include "host/emit/emit.h"
#include "host/engine/start.h"
#include "host/image/image.h"
#include "host/io/records.h"
#include "host/number/functions.h"

#include "command.h"
#include "derived.h"
#include "drawn_scene.h"
#include "expressions.h"
#include "json_check.h"
#include "mechanism.h"

/* === suite image ============================================================================== */

enum { STEPS = 20 };

static void write_run(FILE *out, const image *im, const engine_kind *kind) {
    diags *errors = diags_new();
    if (start_has_method(im, im->settings.method, errors) && start_is_possible(im, kind, errors)) {
        void *run = kind->start(im);
        books *b = books_open(im);
        records *r = records_open(out, im, kind);
        records_header(r);
        for (int i = 0; i < STEPS; i++) {
            if (b != NULL) {
                books_enter(b, kind, run);
            }
            records_read(r, run, 0.0);
            records_write(r);
            if (kind->step(run) != WH_OK) {
                nonfinite_step(im, kind, run, WH_E_DIVERGED, errors);
                break;
            }
        }
        const energy_residual balance = energy_residual_of(b, kind, run);
        summary_print(out, im, kind, run, b, &balance);
        if (b != NULL && im->ledger.kept) {
            books_print_kept(out, im, kind, run, b);
        }
        slow_say(out, im, kind, run);
        records_close(r);
        books_close(b);
        kind->stop(run);
    }
    diags_flush(errors, out);
    diags_free(errors);
}

/* Writes all messages about undefined values, for a state of NaNs. */
static void write_undefined(FILE *out, const image *im) {
    double angle_rad[IMAGE_COMPONENTS_MAX];
    double real[2 * IMAGE_COMPONENTS_MAX];
    for (int i = 0; i < im->angles; i++) {
        angle_rad[i] = (double)NAN;
    }
    for (int i = 0; i < im->reals; i++) {
        real[i] = (double)NAN;
    }
    const nonfinite_at at = {
        .image = im, .angle_rad = angle_rad, .real = real, .ahead_steps = 1.0, .when = "here"};
    diags *errors = diags_new();
    nonfinite_term(&at, errors);
    nonfinite_set(&at, errors);
    for (int k = 0; k < im->contacts; k++) {
        nonfinite_contact(&at, k, errors);
    }
    diags_flush(errors, out);
    diags_free(errors);
}

static char *everything(const image *im) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    TEST_ASSERT_NOT_NULL(out);
    emit_c(out, im, "x.whirl");
    emit_c_header(out, im, "x.whirl");
    if (im->recovered == 0) {
        emit_octave(out, im, "x.whirl", "");
    }
    describe_json(out, im, "x.whirl");
    describe_text(out, im, "x.whirl");
    write_run(out, im, &engine_double);
    write_run(out, im, &engine_float);
    write_undefined(out, im);
    fclose(out);
    return text;
}

static void check_alone(derived *d, const char *what) {
    derived_expect(d, what);
    char *before = everything(d->image);
    equations_free(d->equations);
    instance_free(d->instance);
    model_free(d->model);
    char *after = everything(d->image);
    TEST_ASSERT_EQUAL_STRING_MESSAGE(before, after, what);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(after, "is not a finite number"), what);
    free(before);
    free(after);
    image_free(d->image);
    free(d->errors);
}

static int check_scene_alone(const scene *s) {
    derived d = derived_builtin(s->name);
    check_alone(&d, s->name);
    return 1;
}

TEST(image, image_outlives_its_derivation) {
    TEST_ASSERT_TRUE(each_builtin_scene(check_scene_alone) > 60);
}

/* Has undefined values in lets, in slopes and in every part of a contact, at various columns. */
static const char undefined_everywhere[] =
    "mechanism m \"a\"\n"
    "    coordinate x [m] \"x\"\n"
    "    coordinate th [deg] \"angle\"\n"
    "    parameter k = 2 [N/m] \"k\"\n"
    "    input P = 1 [N] \"P\"\n"
    "    let far = sqrt(x/1 [m])*1 [m]\n"
    "    T = 1 [kg]*x'^2/2 + 1 [kg*m^2]*th'^2/2\n"
    "    V = k*far^2/2 + k*abs(x/1 [m])^1.5*1 [m^2]\n"
    "    F = 1 [kg/s]*x'^2/2\n"
    "    Q(x) = P*log(x/1 [m])\n"
    "    output o [mm] = 1 [m]*sqrt(-x/1 [m])\n"
    "    stop x >= 1 [m]/sqrt(th) - 10 [m] restitution 0.5\n"
    "    friction th static 0.2 kinetic 0.1 normal 1 [N*m]/th\n";

TEST(image, image_outlives_its_own_text) {
    derived d = derived_text(undefined_everywhere);
    check_alone(&d, d.errors);
}

static char *as_c(const image *im) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    TEST_ASSERT_NOT_NULL(out);
    emit_c(out, im, "x.whirl");
    describe_json(out, im, "x.whirl");
    fclose(out);
    return text;
}

static int check_again(const scene *s) {
    static unsigned scenes;
    if (scenes++ % usual_or(1, 2) != 0) {
        return 0;
    }
    char start[100];
    derived d = derived_builtin(s->name);
    derived_expect(&d, s->name);
    const mechanism *m = d.instance->mechanism;
    snprintf(start, sizeof start, "%s=0.125", m->coordinates[0]->name);
    const char *starts[] = {start};
    const overrides changes = {
        .starts = starts, .start_count = 1, .step = "0.7ms", .until = "1.9s"};
    diags *errors = diags_new();
    instance *other = instance_make(m, d.instance->scene, &changes, errors);
    diags_flush(errors, stdout);
    TEST_ASSERT_NOT_NULL_MESSAGE(other, s->name);
    for (int i = 0; i < m->input_count; i++) {
        other->input[i] += 0.5;
    }
    int compared = 0;
    if (d.image->recovered == 0) {
        /* a recovered coordinate is left out: its momentum, which depends on the start, is in the lists */
        equations *e = equations_derive(other, errors);
        image *fresh = image_make(e, other->conserve, &plainly, IMAGE_TO_RUN, errors);
        image *again = image_again(d.image, other, errors);
        TEST_ASSERT_NOT_NULL_MESSAGE(fresh, s->name);
        char *wanted = as_c(fresh);
        char *got = as_c(again);
        TEST_ASSERT_EQUAL_STRING_MESSAGE(wanted, got, s->name);
        free(wanted);
        free(got);
        image_free(again);
        image_free(fresh);
        equations_free(e);
        compared = 1;
    }
    instance_free(other);
    diags_free(errors);
    derived_free(&d);
    return compared;
}

TEST(image, new_starts_need_no_derivation) {
    TEST_ASSERT_TRUE(each_builtin_scene(check_again) > (int)usual_or(50, 25));
}

/* === suite described_drawn ==================================================================== */
/* `whirl describe --json` of random scenes must have every field of the image, with correct layout. */

static dice die;
static drawn_scene drawn;
static char *page;

static void expect_text(const char *path, const char *wanted) {
    char value[200];
    char escaped[200];
    size_t used = 0;
    for (const char *at = wanted; *at != '\0'; at++) { /* the text as JSON writes it */
        if (*at == '"' || *at == '\\') {
            escaped[used++] = '\\';
        }
        escaped[used++] = *at;
    }
    escaped[used] = '\0';
    TEST_ASSERT_NOT_NULL_MESSAGE(json_value(page, path, value), path);
    TEST_ASSERT_EQUAL_STRING_MESSAGE(escaped, value, path);
}

static void expect_number(const char *path, double wanted) {
    char value[200];
    TEST_ASSERT_NOT_NULL_MESSAGE(json_value(page, path, value), path);
    TEST_ASSERT_TRUE_MESSAGE(strtod(value, NULL) == wanted, path);
}

static void expect_bool(const char *path, bool wanted) {
    expect_text(path, wanted ? "true" : "false");
}

/* The path "LIST/INDEX/KEY", in static memory. */
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
            TEST_ASSERT_NULL(json_value(page, in(list, i, "value"), value));
        }
    }
}

static void expect_range(const char *list, int i, const image_range *range) {
    char path[120];
    TEST_ASSERT_EQUAL_INT(range->declared ? 2 : -1, json_length(page, in(list, i, "range")));
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
    TEST_ASSERT_EQUAL_INT(im->angles, json_length(page, "angles"));
    TEST_ASSERT_EQUAL_INT(im->reals, json_length(page, "reals"));
    TEST_ASSERT_EQUAL_INT(im->inputs, json_length(page, "inputs"));
    TEST_ASSERT_EQUAL_INT(im->outputs, json_length(page, "outputs"));
    TEST_ASSERT_EQUAL_INT(im->parameters, json_length(page, "parameters"));
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
    TEST_ASSERT_EQUAL_INT(im->contacts, json_length(page, "contacts"));
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
    TEST_ASSERT_EQUAL_INT(l->accounts, json_length(page, "ledger/accounts"));
    for (int i = 0; i < l->accounts; i++) {
        const image_unknown *u = i > 0 ? &im->unknown[l->unknown[i]] : NULL;
        expect_number(in("ledger/accounts", i, "index"), i);
        expect_text(in("ledger/accounts", i, "of"), i > 0 ? u->name : "energy");
        expect_text(in("ledger/accounts", i, "si"), i > 0 ? u->momentum_si : "J");
    }
    TEST_ASSERT_EQUAL_INT(l->smooth, json_length(page, "ledger/rows"));
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
            TEST_ASSERT_NULL_MESSAGE(json_value(page, path, value), path);
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
    TEST_ASSERT_EQUAL_INT(of->count, json_length(page, "tables/of"));
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
                          json_length(page, "phi"));
    for (int i = 0; i < states && im->settings.matrix != MATRIX_NONE; i++) {
        const double *row = im->matrix.entry + i * im->matrix.columns;
        snprintf(path, sizeof path, "phi/%d", i);
        TEST_ASSERT_EQUAL_INT(states, json_length(page, path));
        snprintf(path, sizeof path, "gamma/%d", i);
        TEST_ASSERT_EQUAL_INT(im->inputs, json_length(page, path));
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
    TEST_ASSERT_EQUAL_INT(im->effects, json_length(page, "effects"));
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

/* The layout must have two blanks for each open bracket, one value on a line, nothing after a comma, and a line end
 * at the end. */
static void check_layout(void) {
    int depth = 0;
    for (const char *line = page; *line != '\0';) {
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

TEST(described_drawn, json_has_every_field) {
    char why[100];
    for (unsigned c = 0; c < dice_cases(few_or_all(usual_or(60, 15), 400)); c++) {
        drawn_scene_draw(&drawn, &die);
        const image *im = &drawn.im;
        page = derived_written(describe_json, im);
        TEST_ASSERT_TRUE_MESSAGE(json_is_valid(page, why), why);
        check_layout();
        check_head(im);
        check_state(im);
        check_contacts(im);
        check_ledger(im);
        check_lists(im);
        check_tables(im);
        check_matrix(im);
        free(page);
    }
}

/* Characters stay, except that quotes, control characters and invalid UTF-8 become escapes. */
TEST(described_drawn, texts_are_escaped) {
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
        page = derived_written(describe_json, &drawn.im);
        TEST_ASSERT_NOT_NULL(json_value(page, "title", value));
        TEST_ASSERT_EQUAL_STRING(wanted, value);
        free(page);
    }
}

/* NaN and infinity become null, because JSON has no word for them. */
TEST(described_drawn, nan_and_infinity_become_null) {
    static const double none[] = {(double)NAN, (double)INFINITY, -(double)INFINITY};
    for (int i = 0; i < 3; i++) {
        char why[100];
        do {
            drawn_scene_draw(&drawn, &die);
        } while (drawn.im.parameters == 0);
        drawn.parameter[0].value = none[i];
        drawn.im.until_s = none[i];
        page = derived_written(describe_json, &drawn.im);
        TEST_ASSERT_TRUE_MESSAGE(json_is_valid(page, why), why);
        expect_text("parameters/0/value", "null");
        expect_text("until_s", "null");
        free(page);
    }
}

SUITE(described_drawn) { die = dice_of("described_drawn", 4140); }

/* === suite generated_texts ==================================================================== */
/* The writers of random expressions and mechanisms must use every function of host/number/functions.h, so that tests
 * over random mechanisms cover them all. */

enum { SEED = 7 };

static const char *name(int f) { return function_name((function_id)f); }

static bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

/* Marks the functions that the text calls. Returns the number of functions without a mark. */
static int mark_called(const char *text, bool called[FUNCTIONS]) {
    int left = 0;
    for (int f = 0; f < FUNCTIONS; f++) {
        char call[40];
        snprintf(call, sizeof call, "%s(", name(f));
        for (const char *at = strstr(text, call); at != NULL && !called[f];
             at = strstr(at + 1, call)) {
            called[f] = at == text || !is_letter(at[-1]);
        }
        left += !called[f];
    }
    return left;
}

static void expect_all(const bool called[FUNCTIONS], const char *where) {
    char message[400];
    size_t length = (size_t)snprintf(message, sizeof message, "%s never writes", where);
    bool all = true;
    for (int f = 0; f < FUNCTIONS; f++) {
        if (!called[f] && length < sizeof message) {
            length += (size_t)snprintf(message + length, sizeof message - length, " %s()", name(f));
        }
        all = all && called[f];
    }
    TEST_ASSERT_TRUE_MESSAGE(all, message);
}

/* Mechanisms are drawn until each function has occurred. If some functions never occur, the failure names them. */
TEST(generated_texts, generated_texts) {
    static char text[1 << 14];
    static const char *const coordinates[] = {"q"};
    static const char *const constants[] = {"p"};
    const expression_names names = {coordinates, 1, 0, constants, 1};
    uint64_t seed = SEED + 3;
    bool written[FUNCTIONS] = {false};
    int left = FUNCTIONS;
    for (int i = 0; i < 5000 && left > 0; i++) {
        expression_write(&names, 3, 1, &seed, text, sizeof text);
        left = mark_called(text, written);
    }
    expect_all(written, "expression_write() of tests/host/expressions.c");
    bool derived_from[FUNCTIONS] = {false};
    left = FUNCTIONS;
    for (unsigned i = 0; i < 2000 && left > 0; i++) {
        char whole[MECHANISM_SIZE];
        mechanism_write(i, SEED + i, whole);
        left = mark_called(whole, derived_from);
    }
    expect_all(derived_from, "mechanism_write() of tests/host/mechanism.c");
}

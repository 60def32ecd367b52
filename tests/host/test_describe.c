/* test_describe.c: `whirl describe --json`, whose fields docs/describe.md lists, and the rows of images.
 * test_image.c checks every field on random scenes. */
#include "test.h"

#include "host/emit/emit.h"
#include "host/lang/units.h"

#include "derived.h"
#include "json_check.h"

/* === suite describe =========================================================================== */

static char *described(const image *im) { return derived_written(describe_json, im); }

static void expect_valid(const char *text, const char *what) {
    char why[100];
    const bool valid = json_is_valid(text, why);
    if (!valid) {
        printf("  %s: %s\n", what, why);
    }
    TEST_ASSERT_TRUE_MESSAGE(valid, what);
}

static char *page_text(void) {
    FILE *in = fopen("docs/describe.md", "rb");
    TEST_ASSERT_NOT_NULL(in);
    char *text = calloc(1, 1 << 16);
    TEST_ASSERT_NOT_NULL(text);
    TEST_ASSERT_TRUE(fread(text, 1, (1 << 16) - 1, in) > 1000);
    fclose(in);
    return text;
}

/* docs/describe.md must contain each key of the JSON text, which has one key per line. */
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

TEST(describe, every_field_is_documented) {
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
        free(json);
        image_free(kept);
        diags_free(errors);
        derived_free(&d);
    }
    free(page);
}

/* === suite image_rows ========================================================================= */
/* The tables of an image, row by row. Each component, account and input must have exactly one row, in the core's
 * sequence (core/scene.h, core/ledger.h), with the meaning that the file gives. A wrong row would not change the motion of a scene that does not use it. */

/* Dimension of a unit's text. Exponents are in twelfths. */
static dimension dimension_of(const char *unit) {
    unit_scale read = {1.0, 1.0, dim_none(), enclosure_of(1.0)};
    unit_error error = {.offset = 0};
    if (strcmp(unit, "1") != 0) {
        TEST_ASSERT_TRUE_MESSAGE(unit_parse(unit, strlen(unit), &read, &error), unit);
    }
    TEST_ASSERT_TRUE_MESSAGE(read.scale == read.divisor, unit); /* the unit is an SI unit */
    return read.dim;
}

/* A momentum is energy times time, divided by its coordinate's unit. Coordinates are lengths, angles, charges, and
 * square roots of masses. */
TEST(image_rows, units_of_momenta) {
    static const char *const bases[DIM_BASES][5] = {{"", "*m", "/m", "*m^2", "*m^(1/2)"},
                                                    {"", "*kg", "/kg", "*kg^2", "*kg^(1/2)"},
                                                    {"", "*s", "/s", "*s^2", "/s^2"},
                                                    {"", "*A", "/A", "*A^2", "/A^2"},
                                                    {"", "*K", "/K", "*K^2", "/K^2"}};
    uint64_t seed = 20261123;
    for (int round = 0; round < 60; round++) {
        char unit[80] = "rad";
        char text[400];
        for (int b = 0; b < DIM_BASES; b++) {
            const unsigned which = round == 0           ? 0U
                                   : round <= DIM_BASES ? (unsigned)(b + 1 == round)
                                                        : (unsigned)(random_bits(&seed) % 5);
            strcat(unit, bases[b][which]);
        }
        snprintf(text, sizeof text, "mechanism m\ncoordinate q [%s]\nT = 2 [J*s^2/(%s)^2]*q'^2/2\n",
                 unit, unit);
        derived d = derived_text(text);
        derived_expect(&d, text);
        const dimension own = dimension_of(unit);
        const dimension momentum = dimension_of(d.image->unknown[0].momentum_si);
        for (int b = 0; b < DIM_BASES; b++) {
            const int of_action = (b == DIM_LENGTH ? 2
                                   : b == DIM_MASS ? 1
                                   : b == DIM_TIME ? -1
                                                   : 0) *
                                  DIM_DENOMINATOR;
            TEST_ASSERT_EQUAL_INT_MESSAGE(of_action, own.twelfths[b] + momentum.twelfths[b], text);
        }
        derived_free(&d);
    }
}

/* Checks angle[] and real[]. Second order: angles, other positions, then all rates. First order: all states. Each
 * integrated unknown must have one row, an unknown that is recovered from its momentum none. */
static void check_components(const image *im, const char *name) {
    int seen[IMAGE_COMPONENTS_MAX][ORDERS_MAX] = {{0}};
    for (int i = 0; i < im->angles + im->reals; i++) {
        const component c = image_component(im, i);
        TEST_ASSERT_TRUE_MESSAGE(c.unknown >= 0 && c.unknown < im->count, name);
        TEST_ASSERT_TRUE_MESSAGE(c.primes >= 0 && c.primes < im->unknown[c.unknown].order, name);
        seen[c.unknown][c.primes]++;
        TEST_ASSERT_TRUE_MESSAGE(i >= im->angles || c.primes == 0, name);
        TEST_ASSERT_EQUAL_INT_MESSAGE(i, image_find_component(im, c.unknown, c.primes), name);
    }
    int recovered = 0;
    for (int u = 0; u < im->count; u++) {
        const bool integrated = im->form == WH_FIRST_ORDER || im->place[u] >= 0;
        for (int primes = 0; primes < im->unknown[u].order; primes++) {
            TEST_ASSERT_EQUAL_INT_MESSAGE(integrated ? 1 : 0, seen[u][primes], name);
        }
        if (!integrated) {
            TEST_ASSERT_TRUE_MESSAGE(recovered < im->recovered, name);
            TEST_ASSERT_EQUAL_INT_MESSAGE(u, im->from_momentum[recovered], name);
            TEST_ASSERT_TRUE_MESSAGE(im->unknown[u].conserved, name);
            TEST_ASSERT_EQUAL_INT_MESSAGE(-1, image_find_component(im, u, 0), name);
            recovered++;
        } else if (im->form == WH_SECOND_ORDER) {
            const int at = im->place[u];
            const int lines = im->coordinates - im->angles;
            const component position = at < im->angles ? im->angle[at] : im->real[at - im->angles];
            TEST_ASSERT_TRUE_MESSAGE(position.unknown == u && position.primes == 0, name);
            TEST_ASSERT_TRUE_MESSAGE(im->real[lines + at].unknown == u, name);
            TEST_ASSERT_TRUE_MESSAGE(im->real[lines + at].primes == 1, name);
        }
    }
    TEST_ASSERT_EQUAL_INT_MESSAGE(im->recovered, recovered, name);
}

static void check_starts(const derived *d, const char *name) {
    const image *im = d->image;
    for (int i = 0; i < im->angles; i++) {
        TEST_ASSERT_TRUE_MESSAGE(im->start_rad[i] == d->instance->start[im->angle[i].unknown][0],
                                 name);
    }
    for (int i = 0; i < im->reals; i++) {
        const component c = im->real[i];
        TEST_ASSERT_TRUE_MESSAGE(im->start_real[i] == d->instance->start[c.unknown][c.primes],
                                 name);
    }
}

static void check_ledger(const image *im, const char *name) {
    const image_ledger *l = &im->ledger;
    unsigned accounts = 0;
    int input = -1;
    if (!l->kept) {
        return;
    }
    TEST_ASSERT_EQUAL_INT_MESSAGE(1 + im->coordinates, l->accounts, name);
    TEST_ASSERT_EQUAL_INT_MESSAGE(-1, l->unknown[0], name);
    for (int i = 1; i < l->accounts; i++) { /* in the sequence of the coordinates */
        TEST_ASSERT_TRUE_MESSAGE(l->unknown[i] >= 0 && l->unknown[i] < im->count, name);
        TEST_ASSERT_EQUAL_INT_MESSAGE(i - 1, im->place[l->unknown[i]], name);
        accounts++;
    }
    TEST_ASSERT_EQUAL_INT_MESSAGE(im->coordinates, (int)accounts, name);
    for (int i = 0; i < l->inputs; i++) {
        TEST_ASSERT_TRUE_MESSAGE(l->input[i] > input && l->input[i] < im->inputs, name);
        input = l->input[i];
    }
    TEST_ASSERT_EQUAL_INT_MESSAGE(l->smooth + im->contacts * (1 + im->coordinates) + l->inputs,
                                  l->entries, name);
}

static int check_targets(const derived *d, const char *name) {
    const image *im = d->image;
    int at = 0;
    for (int k = 0; k < im->contacts; k++) {
        const contact_statement *from = d->equations->contacts->law[k].from;
        if (from->kind != CONTACT_WHEN || im->contact[k].sets == 0) {
            continue;
        }
        TEST_ASSERT_EQUAL_INT_MESSAGE(from->set_count, im->contact[k].sets, name);
        TEST_ASSERT_EQUAL_INT_MESSAGE(at, im->contact[k].first_set, name);
        for (int i = 0; i < from->set_count; i++) {
            const component c = image_component(im, im->target[at++]);
            TEST_ASSERT_EQUAL_STRING_MESSAGE(from->sets[i].symbol->name,
                                             im->unknown[c.unknown].name, name);
            TEST_ASSERT_EQUAL_INT_MESSAGE(from->sets[i].primes, c.primes, name);
        }
    }
    TEST_ASSERT_EQUAL_INT_MESSAGE(im->set_count, at, name);
    return at;
}

/* Each declared range must belong to one row and have its bounds. Other rows must have no range. */
static int check_ranges(const derived *d, const char *name) {
    const image *im = d->image;
    const instance *inst = d->instance;
    int declared = 0;
    for (int i = 0; i < im->angles + im->reals + im->inputs; i++) {
        const bool angle = i < im->angles;
        const image_range *row = angle ? &im->angle_range[i] : &im->range[i - im->angles];
        const component c =
            i < im->angles + im->reals ? image_component(im, i) : (component){-1, 0};
        const char *quantity = c.unknown >= 0 ? im->unknown[c.unknown].name
                                              : im->input[i - im->angles - im->reals].name;
        bool found = false;
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, strncmp(quantity, row->name, strlen(quantity)), name);
        TEST_ASSERT_EQUAL_INT_MESSAGE((int)(strlen(quantity) + (size_t)c.primes),
                                      (int)strlen(row->name), name);
        for (int k = 0; k < inst->range_count; k++) {
            const range_value *r = &inst->range[k];
            if (strcmp(r->symbol->name, quantity) == 0 && r->primes == c.primes) {
                TEST_ASSERT_TRUE_MESSAGE(row->low == r->low && row->high == r->high, name);
                found = true;
            }
        }
        TEST_ASSERT_TRUE_MESSAGE(found == row->declared, name);
        declared += found;
    }
    return declared;
}

static int targets;
static int ranges;

static int check_scene(const scene *s) {
    derived d = derived_builtin(s->name);
    derived_expect(&d, s->name);
    check_components(d.image, s->name);
    check_starts(&d, s->name);
    check_ledger(d.image, s->name);
    targets += check_targets(&d, s->name);
    ranges += check_ranges(&d, s->name);
    derived_free(&d);
    return 1;
}

TEST(image_rows, rows_of_built_in_scenes) {
    targets = 0;
    ranges = 0;
    TEST_ASSERT_TRUE(each_builtin_scene(check_scene) > 60);
    TEST_ASSERT_TRUE(targets > 0);
}

/* Has angles among lengths, the input of an omitted effect, crossings with several assignments, ranges of each kind,
 * and accounts. */
static const char of_every_kind[] =
    "mechanism m\ncoordinate x [m]\ncoordinate th [rad]\ncoordinate y [m]\n"
    "coordinate ph [rad]\ninput A = 1 [N]\ninput B = 2 [N/m]\n"
    "    T = 1 [kg]*(x'^2 + y'^2)/2 + 1 [kg*m^2]*(th'^2 + ph'^2)/2 + 0.1 [kg*m]*x'*th'*cos(th)\n"
    "V = B*y^2/2 + 1 [J]*cos(ph - th)\nQ(x) = A\n"
    "effect E \"e\" { input C = 3 [N]; Q(y) += C }\neffect G \"g\" { input D = 4 [N]; V += D*x }\n"
    "scene s {\nwith G\nwith ledger\n"
    "start x = 1 [m], y = 2 [m], th = 3 [rad], ph = 4 [rad]\n"
    "start x' = 5 [m/s], y' = 6 [m/s], th' = 7 [rad/s], ph' = 8 [rad/s]\n"
    "    when x crosses 90 [m] { set y' = 1 [m/s]\n set th = 2\n set x = 3 [m] }\n"
    "    when y crosses 80 [m] { set ph' = 1 [rad/s]\n set y = 2 [m] }\n"
    "    range x = -1 .. 2 [m]\n    range y' = -3 .. 4 [m/s]\n    range th' = -5 .. 6 [rad/s]\n"
    "    range A = -7 .. 8 [N]\n    range D = -9 .. 10 [N]\n    range ph = -11 .. 12 [rad]\n"
    "}\n";

TEST(image_rows, rows_of_every_kind) {
    derived d = derived_scene(of_every_kind, "s");
    derived_expect(&d, d.errors);
    check_components(d.image, "s");
    check_starts(&d, "s");
    check_ledger(d.image, "s");
    TEST_ASSERT_TRUE(d.image->ledger.kept);
    TEST_ASSERT_EQUAL_INT(2, d.image->ledger.inputs); /* inputs B and D are in the energies */
    TEST_ASSERT_EQUAL_STRING("B", d.image->input[d.image->ledger.input[0]].name);
    TEST_ASSERT_EQUAL_STRING("D", d.image->input[d.image->ledger.input[1]].name);
    TEST_ASSERT_EQUAL_INT(5, check_targets(&d, "s"));
    TEST_ASSERT_EQUAL_INT(6, check_ranges(&d, "s"));
    derived_free(&d);
}

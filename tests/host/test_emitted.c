/* test_emitted.c: texts of the user in generated comments must neither end a comment nor cause a warning. Also the
 * head of generated C and its settings for size, for random scenes. Scripts compile and run the code:
 * tests/cli/emitted_c.sh compares its bits with the interpreter's, embed_names.sh the headers with the model. */
#include "core/version.h"
#include "derived.h"
#include "drawn_scene.h"
#include "host/base/alloc.h"
#include "host/emit/c_header.h"
#include "host/emit/emit.h"

static dice die;
static drawn_scene drawn;

static char *commented(const char *text) {
    char *written = NULL;
    size_t length = 0;
    FILE *out = alloc_text(&written, &length);
    c_comment(out, text);
    alloc_text_end(out);
    return written;
}

/* The characters that change the writing direction, as codes, because compilers would warn of the characters in this
 * file, too. */
enum { TURNING = 7 };
static const unsigned turning_codes[TURNING] = {0x200e, 0x200f, 0x202a, 0x202e,
                                                0x2066, 0x2069, 0x061c};
static char turning[TURNING][4];

static void make_turning(void) {
    for (int i = 0; i < TURNING; i++) {
        const unsigned code = turning_codes[i];
        char *at = turning[i];
        if (code > 0x7ff) {
            *at++ = (char)(0xe0 | code >> 12);
        }
        *at++ = (char)(code > 0x7ff ? 0x80 | (code >> 6 & 0x3f) : 0xc0 | code >> 6);
        *at++ = (char)(0x80 | (code & 0x3f));
        *at = '\0';
    }
}

/* Texts that are forbidden in a comment, or forbidden after certain characters. Each would change what the compiler
 * reads or what a reader sees. */
static const char *const odd[] = {
    "*/",   "/*",       "?\?/",     "?\?",      "\\",       "\n",       "\t",       "\x7f",
    "\x01", turning[0], turning[1], turning[2], turning[3], turning[4], turning[5], turning[6]};
/* Similar texts that are allowed. */
static const char *const plain[] = {"a",
                                    "b c",
                                    "*",
                                    "/",
                                    "?",
                                    "\xc3\xa9",
                                    "\xe2\x80\x8d",
                                    "\xe2\x80\xaf",
                                    "\xe2\x81\xa5",
                                    "\xe2\x81\xaa",
                                    "\xd8\x9b",
                                    "\xd8\x9d",
                                    "~",
                                    "\xe2\x82\xac",
                                    "\xe3\x80\x8e",
                                    "\xd9\x9c"};

enum { ODD = sizeof odd / sizeof odd[0], PLAIN = sizeof plain / sizeof plain[0] };

static bool turns_writing(const char *text) {
    for (int i = 0; i < TURNING; i++) {
        if (strstr(text, turning[i]) != NULL) {
            return true;
        }
    }
    return false;
}

/* Allowed pieces must stay unchanged. Forbidden pieces must become the expected text. */
TEST(emitted, comments_stay_comments) {
    for (unsigned c = 0; c < dice_cases(400); c++) {
        char text[200] = "";
        char bare[200] = ""; /* what must remain, without blanks */
        for (unsigned n = dice_one_of(&die, 12); n > 0; n--) {
            const bool is_plain = dice_one_of(&die, 2) == 0;
            const unsigned which = dice_one_of(&die, is_plain ? PLAIN : ODD);
            strcat(text, is_plain ? plain[which] : odd[which]);
            if (is_plain || which < 5) {
                strcat(bare, is_plain ? plain[which] : odd[which]);
            }
        }
        char *got = commented(text);
        TEST_ASSERT_NULL_MESSAGE(strstr(got, "*/"), got);
        TEST_ASSERT_NULL_MESSAGE(strstr(got, "/*"), got);
        TEST_ASSERT_NULL_MESSAGE(strstr(got, "?\?"), got);
        TEST_ASSERT_FALSE_MESSAGE(turns_writing(got), got);
        const char *want = bare;
        for (const char *at = got; *at != '\0'; at++) {
            TEST_ASSERT_TRUE_MESSAGE((unsigned char)*at >= ' ' && *at != 0x7f, got);
            TEST_ASSERT_TRUE_MESSAGE(*at != '\\' || at[1] == ' ', got);
            while (*want == ' ') {
                want++;
            }
            if (*at != ' ') {
                TEST_ASSERT_EQUAL_CHAR_MESSAGE(*want, *at, got);
                want++;
            }
        }
        TEST_ASSERT_EQUAL_STRING("", want + strspn(want, " "));
        free(got);
    }
    for (int i = 0; i < PLAIN; i++) { /* a piece by itself must stay unchanged */
        char *got = commented(plain[i]);
        TEST_ASSERT_EQUAL_STRING(plain[i], got);
        free(got);
    }
    for (int i = 5; i < ODD; i++) { /* each forbidden piece must become a blank */
        char *got = commented(odd[i]);
        TEST_ASSERT_EQUAL_STRING(" ", got);
        free(got);
    }
}

static char *text; /* the generated text of the current scene */

__attribute__((format(printf, 2, 3))) static void expect_line(bool wanted, const char *format,
                                                              ...) {
    char line[300] = "\n";
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line + 1, sizeof line - 2, format, arguments);
    va_end(arguments);
    strcat(line, "\n");
    TEST_ASSERT_EQUAL_MESSAGE(wanted, strstr(text, line) != NULL, line);
}

static const op_list *moving(const image *im) {
    return im->list[im->settings.matrix != MATRIX_NONE ? IMAGE_MATRIX : IMAGE_STEP];
}

/* The head must have the number of operations, and a line for each component, input and output. */
static void expect_banner(const image *im) {
    const op_list_cost cost = op_list_count(moving(im));
    char functions[60] = "";
    char tables[60] = "";
    char name[40];
    if (cost.calls > 0) {
        snprintf(functions, sizeof functions, ", %d functions of core/function.h", cost.calls);
    }
    if (cost.look_ups > 0) {
        snprintf(tables, sizeof tables, ", %d looked up in tables", cost.look_ups);
    }
    expect_line(true, " * scene        %s", im->name);
    expect_line(true, " * model hash   0x%016" PRIx64, im->hash);
    if (im->settings.matrix != MATRIX_NONE) {
        expect_line(true, " * a whole step as a matrix: %d additions and products",
                    cost.arithmetic);
    } else {
        expect_line(true,
                    " * a right-hand side: %d additions and products, %d divisions, %d square "
                    "roots,\n *                    %d pairs of sine and cosine%s%s",
                    cost.arithmetic, cost.divisions, cost.roots, cost.waves, functions, tables);
    }
    for (int i = 0; i < im->angles + im->reals; i++) {
        const bool turns = i < im->angles;
        expect_line(true, " *   %s[%d]%s%s", turns ? "angle" : "real", turns ? i : i - im->angles,
                    turns ? "  " : "   ", drawn_scene_name(&drawn, image_component(im, i), name));
    }
    for (int i = 0; i < im->inputs; i++) {
        expect_line(true, " *   input[%d]  %s", i, im->input[i].name);
    }
    for (int i = 0; i < im->own_outputs; i++) {
        expect_line(true, " *   output[%d] %s", i, im->output[i].name);
    }
    for (int k = 0; k < 2 * im->recovered; k++) {
        drawn_scene_name(&drawn, (component){im->from_momentum[k / 2], k % 2}, name);
        expect_line(true, " *   output[%d] %s, from its momentum", im->own_outputs + k, name);
    }
}

/* More than 99 operations must keep their sequence. More than 150 must be in a function that is not inlined. */
static void expect_sizes(const image *im) {
    const int operations = op_list_operations(moving(im));
    const bool is_long = operations > 99;
    const bool bare = im->contacts == 0 && !im->ledger.kept && !im->settings.compensated;
    const char *called = im->settings.matrix != MATRIX_NONE ? "\nstatic void step_matrix("
                         : im->form == WH_SECOND_ORDER      ? "\nstatic void accelerations("
                                                            : "\nstatic void slopes(";
    expect_line(is_long, "#define WH_LONG_LIST 1");
    expect_line(!is_long && bare, "#define WH_SMALL_STEP 1");
    TEST_ASSERT_EQUAL_MESSAGE(operations > 150, strstr(text, called) != NULL, called);
}

TEST(emitted, header_describes_the_scene) {
    for (unsigned c = 0; c < dice_cases(usual_or(400, 200)); c++) {
        drawn_scene_draw(&drawn, &die);
        text = derived_written(emit_c, &drawn.im);
        expect_banner(&drawn.im);
        expect_sizes(&drawn.im);
        free(text);
    }
}

/* Expects a line such as "  angle [0]  theta [rad]     ". If `value` is given, its number follows, then the text
 * `more`. */
static void expect_named(const char *kind, int index, const char *name, const char *si,
                         const double *value, const char *more) {
    char shown[80];
    char number[40] = "";
    snprintf(shown, sizeof shown, "%s [%s]", name, si);
    if (value != NULL) {
        snprintf(number, sizeof number, "%-12.9g ", *value);
    }
    expect_line(true, "  %s[%d]%s %-24s %s%s", kind, index, index < 10 ? " " : "", shown, number,
                more);
}

static void expect_quantities(const char *kind, const image_quantity *q, int count, bool valued) {
    for (int i = 0; i < count; i++) {
        expect_named(kind, i, q[i].name, q[i].unit.si, valued ? &q[i].value : NULL, q[i].text);
    }
}

static void expect_component(const char *kind, int index, component c, const double *value,
                             const char *more) {
    char name[40];
    expect_named(kind, index, drawn_scene_name(&drawn, c, name),
                 drawn.unknown[c.unknown].unit[c.primes].si, value, more);
}

static void expect_names(const image *im) {
    for (int i = 0; i < im->angles; i++) {
        expect_component("angle ", i, im->angle[i], &im->start_rad[i],
                         drawn.unknown[im->angle[i].unknown].text);
    }
    for (int i = 0; i < im->reals; i++) {
        const component c = im->real[i];
        expect_component("real  ", i, c, &im->start_real[i],
                         c.primes == 0 ? drawn.unknown[c.unknown].text : "");
    }
    for (int k = 0; k < 2 * im->recovered; k++) {
        expect_component("output", im->own_outputs + k,
                         (component){im->from_momentum[k / 2], k % 2}, NULL, "from its momentum");
    }
    expect_quantities("input ", im->input, im->inputs, true);
    expect_quantities("output", im->output, im->own_outputs, false);
    expect_quantities("param ", im->parameter, im->parameters, true);
    for (int i = 0; i < im->reals + im->inputs; i++) {
        const image_range *r = &im->range[i];
        expect_line(r->declared, "  %-26s %.9g .. %.9g", r->name, r->low, r->high);
    }
}

static void expect_rows(const image *im) {
    static const char *const kinds[] = {"work", "loss", "energies", "drive", "damping"};
    const image_ledger *l = &im->ledger;
    for (int i = 0; i < im->effects; i++) {
        expect_line(im->effect[i].with, "  with %s: %s", im->effect[i].name, im->effect[i].text);
    }
    for (int k = 0; k < im->contacts; k++) {
        const int line = im->contact[k].at.line;
        expect_line(true, "  %2d %-9s line %-5d %s", k, im->contact[k].word, line,
                    drawn_scene_statement(line));
    }
    expect_line(l->asked, "ledger: %d accounts, %d entries", l->accounts, l->entries);
    for (int i = 0; i < l->smooth; i++) {
        const image_entry *e = &l->entry[i];
        expect_line(l->asked, "  %2d %-9s of %-12s %s", i, kinds[e->kind],
                    e->account > 0 ? im->unknown[l->unknown[e->account]].name : "the energy",
                    drawn_scene_statement(e->at.line));
    }
    for (int role = 0; role < IMAGE_ROLES; role++) {
        if (im->list[role] != NULL) {
            const op_list_cost cost = op_list_count(im->list[role]);
            expect_line(true, "  %-9s %6d  %6d %5d %6d %6d %6d", drawn_scene_roles[role],
                        im->list[role]->results, cost.arithmetic, cost.divisions, cost.roots,
                        cost.waves, cost.calls);
        }
    }
}

/* The description must have every item, in any sequence. The JSON text has the same numbers (test_image.c). */
TEST(emitted, description_has_every_item) {
    for (unsigned c = 0; c < dice_cases(usual_or(200, 50)); c++) {
        drawn_scene_draw(&drawn, &die);
        text = derived_written(describe_text, &drawn.im);
        expect_names(&drawn.im);
        expect_rows(&drawn.im);
        free(text);
    }
}

SUITE(emitted) {
    die = dice_of("emitted", 4130);
    make_turning();
}

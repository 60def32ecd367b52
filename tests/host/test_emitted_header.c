/* test_emitted_header.c: generated headers of random scenes, read line by line: each name with its number, unit and
 * text. The user's texts must neither end a comment nor cause a warning. */
#include "core/version.h"
#include "derived.h"
#include "drawn_scene.h"
#include "host/base/alloc.h"
#include "host/emit/c_header.h"
#include "host/emit/emit.h"

static dice die;
static drawn_scene drawn;

/* --- comments ----------------------------------------------------------------------------------------------- */

static char *commented(const char *text) {
    char *written = NULL;
    size_t length = 0;
    FILE *out = alloc_text(&written, &length);
    c_comment(out, text);
    alloc_text_end(out);
    return written;
}

/* Characters that change the writing direction, by number, since a compiler warns of them here, too. */
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

/* Texts that are forbidden in a comment or after certain characters. Each changes the compiler's reading or the visible
 * order. */
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

/* Allowed pieces stay as they are; of others the expected text. */
TEST(emitted_header, comments_stay_comments) {
    for (unsigned c = 0; c < dice_cases(400); c++) {
        char text[200] = "";
        char bare[200] = ""; /* without blanks and pieces that become one */
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
    for (int i = 0; i < PLAIN; i++) { /* alone, a character of any width is unchanged */
        char *got = commented(plain[i]);
        TEST_ASSERT_EQUAL_STRING(plain[i], got);
        free(got);
    }
    for (int i = 5; i < ODD; i++) { /* forbidden pieces become one blank */
        char *got = commented(odd[i]);
        TEST_ASSERT_EQUAL_STRING(" ", got);
        free(got);
    }
}

/* --- names ---------------------------------------------------------------------------------------------------- */

static const char *said_comment(const char *at, const char *text) {
    char *wanted = commented(text);
    at = said_exactly(at, wanted);
    free(wanted);
    return at;
}

/* " drawn_RATE2_X = 3, /" and its comment. */
static const char *said_item(const char *at, const char *kind, int primes, const char *name,
                             int number, const char *si, const char *text) {
    char words[200];
    char order[12] = "";
    if (primes > 1) {
        snprintf(order, sizeof order, "%d", primes);
    }
    snprintf(words, sizeof words, "    %s_%s%s_%s = %d, /* ", drawn.im.name, kind, order, name,
             number);
    at = said_exactly(at, words);
    at = said_comment(at, si);
    if (text[0] != '\0') {
        at = said_exactly(at, primes > 0 ? ": rate of: " : ": ");
        at = said_comment(at, text);
    }
    return said_exactly(at, " */\n");
}

static const char *said_component(const char *at, component c, const char *value, const char *rate,
                                  int number) {
    const image_unknown *u = &drawn.unknown[c.unknown];
    return said_item(at, c.primes > 0 ? rate : value, c.primes, u->name, number,
                     u->unit[c.primes].si, u->text);
}

static const char *said_quantity(const char *at, const image_quantity *q, const char *kind,
                                 int number) {
    return said_item(at, kind, 0, q->name, number, q->unit.si, q->text);
}

static const char *said_counted(const char *at, const char *what, int count) {
    char words[100];
    snprintf(words, sizeof words, "    %s_%s = %d,\n\n", drawn.im.name, what, count);
    return said_exactly(at, words);
}

static component recovered(int k) { return (component){drawn.from_momentum[k / 2], k % 2}; }

static const char *said_state(const char *at, const char *angles, const char *reals,
                              const char *inputs) {
    const image *im = &drawn.im;
    at = said_exactly(at, angles);
    for (int i = 0; i < im->angles; i++) {
        at = said_component(at, im->angle[i], "ANGLE", "ANGLERATE", i);
    }
    at = said_counted(at, "ANGLES", im->angles);
    at = said_exactly(at, reals);
    for (int i = 0; i < im->reals; i++) {
        at = said_component(at, im->real[i], "REAL", "RATE", i);
    }
    at = said_counted(at, "REALS", im->reals);
    at = said_exactly(at, inputs);
    for (int i = 0; i < im->inputs; i++) {
        at = said_quantity(at, &im->input[i], "INPUT", i);
    }
    return said_counted(at, "INPUTS", im->inputs);
}

/* `#define drawn_NAMES_OF_REALS {"X", "X'"}`, and the units. */
static const char *said_strings(const char *at, const char *of, int count,
                                void (*item)(int i, char *name, const char **si)) {
    for (int what = 0; what < 2 && count > 0; what++) {
        char words[100];
        snprintf(words, sizeof words, "#define %s_%s_OF_%s {", drawn.im.name,
                 what == 0 ? "NAMES" : "UNITS", of);
        at = said_exactly(at, words);
        for (int i = 0; i < count; i++) {
            char name[40];
            const char *si;
            item(i, name, &si);
            at = said_exactly(at, i > 0 ? ", \"" : "\"");
            at = said_exactly(at, what == 0 ? name : si);
            at = said_exactly(at, "\"");
        }
        at = said_exactly(at, "}\n");
    }
    return at;
}

static void of_component(component c, char *name, const char **si) {
    drawn_scene_name(&drawn, c, name);
    *si = drawn.unknown[c.unknown].unit[c.primes].si;
}

static void angle_item(int i, char *name, const char **si) {
    of_component(drawn.angle[i], name, si);
}
static void real_item(int i, char *name, const char **si) { of_component(drawn.real[i], name, si); }

static void input_item(int i, char *name, const char **si) {
    snprintf(name, 40, "%s", drawn.input[i].name);
    *si = drawn.input[i].unit.si;
}

static void output_item(int i, char *name, const char **si) {
    if (i >= drawn.im.own_outputs) {
        of_component(recovered(i - drawn.im.own_outputs), name, si);
        return;
    }
    snprintf(name, 40, "%s", drawn.output[i].name);
    *si = drawn.output[i].unit.si;
}

static const char *said_bounds(const char *at) {
    const image *im = &drawn.im;
    const char *name = im->name;
    char words[600];
    snprintf(
        words, sizeof words,
        "    /* state.contacts->mode[]; levels that wh_ledger_error() takes; the ledger's entries */\n"
        "    %s_CONTACTS = %d,\n    %s_ACCOUNTS = %d,\n    %s_ENTRIES = %d,\n\n"
        "    /* the most that a step evaluates: accelerations, what tells contacts' modes */\n"
        "    %s_EVALUATIONS = %d,\n    %s_SIGNALS = %d\n};\n\n",
        name, im->contacts, name, im->ledger.accounts, name, im->ledger.entries, name,
        drawn_scene_evaluations(im), name, drawn_scene_signals(im));
    at = said_exactly(at, words);
    snprintf(words, sizeof words,
             "/* For arrays: static const char *const unit[] = %s_UNITS_OF_%s; */\n", name,
             im->outputs > 0 ? "OUTPUTS" : "REALS");
    return said_exactly(at, words);
}

/* "#define NAME_KIND_WHAT WH_R(number)" of this value, as a compiler reads it for the core's number type. */
static const char *said_number_of(const char *at, const char *kind, const char *what,
                                  double value) {
    char words[200];
    double number = 0.0;
    snprintf(words, sizeof words, "#define %s_%s%s WH_R(", drawn.im.name, kind, what);
    at = said_exactly(at, words);
    const size_t length = strcspn(at, ")");
    TEST_ASSERT_TRUE(strcspn(at, ".e") < length);
    at = said_number(at, &number);
    TEST_ASSERT_TRUE(number == value);
    return said_exactly(at, ")");
}

static const char *said_values(const char *at) {
    const image *im = &drawn.im;
    char words[300];
    snprintf(words, sizeof words,
             "\n/* What it was generated by and of, its step in s, its parameters and inputs. */\n"
             "#define %s_VERSION \"" WH_VERSION "\"\n#define %s_MODEL_HASH UINT64_C(0x%016" PRIx64
             ")\n",
             im->name, im->name, im->hash);
    at = said_exactly(said_exactly(at, words), "");
    at = said_exactly(said_number_of(at, "STEP_S", "", im->step_s), "\n");
    for (int i = 0; i < im->parameters + im->inputs; i++) {
        const image_quantity *q =
            i < im->parameters ? &im->parameter[i] : &im->input[i - im->parameters];
        at = said_number_of(at, i < im->parameters ? "PARAMETER_" : "START_", q->name, q->value);
        at = said_comment(said_exactly(at, " /* "), q->unit.si);
        at = said_comment(said_exactly(at, q->text[0] != '\0' ? ": " : ""), q->text);
        at = said_exactly(at, " */\n");
    }
    for (int i = 0; i < im->contacts; i++) {
        int number = 1;
        for (int k = 0; k < i; k++) {
            number += strcmp(im->contact[k].word, im->contact[i].word) == 0;
        }
        snprintf(words, sizeof words, "#define %s_CONTACT_%s%d %d /* in line %d */\n", im->name,
                 im->contact[i].word, number, i, im->contact[i].at.line);
        at = said_exactly(at, words);
    }
    for (int i = 0; i < im->reals + im->inputs; i++) {
        const image_range *r = &im->range[i];
        for (int end = 0; end < 2 && r->declared; end++) {
            char kind[40];
            const char *name = i >= im->reals ? im->input[i - im->reals].name
                                              : im->unknown[im->real[i].unknown].name;
            const int primes = i >= im->reals ? 0 : im->real[i].primes;
            char order[12] = "";
            if (primes > 1) {
                snprintf(order, sizeof order, "%d", primes);
            }
            snprintf(kind, sizeof kind, "%s_%s%s_", end == 0 ? "LEAST" : "MOST",
                     i >= im->reals ? "INPUT"
                     : primes > 0   ? "RATE"
                                    : "REAL",
                     order);
            at = said_exactly(said_number_of(at, kind, name, end == 0 ? r->low : r->high), "\n");
        }
    }
    return at;
}

static const char *said_head(const char *at) {
    const image *im = &drawn.im;
    const char *name = im->name;
    char words[1400];
    at = said_exactly(at, "/* Generated by whirl " WH_VERSION
                          " from x.whirl: do not edit.\n *\n * scene        ");
    at = said_exactly(at, name);
    at = said_exactly(at, im->title[0] != '\0' ? ": " : "");
    at = said_comment(at, im->title);
    snprintf(
        words, sizeof words,
        "\n * model hash   0x%016" PRIx64 "\n *\n"
        " * Values are SI, whatever the model shows them in.\n"
        " * The model belongs to its author. The text that whirl adds has the licence of core/.\n"
        " * SPDX-License-Identifier: MIT\n */\n"
        "#ifndef WHIRL_SCENE_%s_H\n#define WHIRL_SCENE_%s_H\n\n#include \"core/scene.h\"\n"
        "#include \"core/version.h\"\n\n#if WH_VERSION_NUMBER != 300\n"
        "#error \"This scene was generated by whirl " WH_VERSION
        ": take core/ of the same version, or "
        "generate it anew.\"\n#endif\n\n"
        "#ifdef __cplusplus\nextern \"C\" {\n#endif\n\n"
        "/* If the linker misses this symbol, header and .c are of two runs of whirl: write both "
        "anew. */\n#ifndef WHIRL_SCENE_%s_C\nextern const wh_scene %s WH_LINKS_TO(%s_HEADER_",
        im->hash, name, name, name, name, name);
    at = said_exactly(at, words);
    TEST_ASSERT_EQUAL(8, strspn(at, "0123456789abcdef")); /* of its text: embed_headers.sh */
    snprintf(
        words, sizeof words,
        ");\n#endif\n\n"
        "/* What wh_scene_start() takes, of either number: bytes; words for an array of uint64_t. */\n"
        "#define %s_MEMORY_BYTES WH_MEMORY_BYTES(%d, %d, %d)\n"
        "#define %s_MEMORY_WORDS ((%s_MEMORY_BYTES + 7U) / 8U)\n\nenum {\n",
        name, im->angles, drawn_scene_numbers(im), im->contacts, name, name);
    return said_exactly(at + 8, words);
}

static const char *said_outputs(const char *at, const char *head) {
    const image *im = &drawn.im;
    at = said_exactly(at, head);
    for (int i = 0; i < im->own_outputs; i++) {
        at = said_quantity(at, &im->output[i], "OUTPUT", i);
    }
    for (int i = im->own_outputs; i < im->outputs; i++) {
        at = said_component(at, recovered(i - im->own_outputs), "OUTPUT", "OUTPUTRATE", i);
    }
    return said_counted(at, "OUTPUTS", im->outputs);
}

TEST(emitted_header, a_header_has_every_name) {
    for (unsigned c = 0; c < dice_cases(usual_or(200, 50)); c++) {
        drawn_scene_draw(&drawn, &die);
        const image *im = &drawn.im;
        char *text = derived_written(emit_c_header, im);
        const char *at = said_head(text);
        at = said_state(at, "    /* state.angle[], read with wh_angle_to_rad(): unwrapped */\n",
                        "    /* state.real[] */\n",
                        "    /* state.input[], may change between steps */\n");
        at = said_outputs(at, "    /* what the scene's observe() fills */\n");
        at = said_bounds(at);
        at = said_strings(at, "ANGLES", im->angles, angle_item);
        at = said_strings(at, "REALS", im->reals, real_item);
        at = said_strings(at, "INPUTS", im->inputs, input_item);
        at = said_strings(at, "OUTPUTS", im->outputs, output_item);
        at = said_values(at);
        TEST_ASSERT_EQUAL_STRING("\n#ifdef __cplusplus\n}\n#endif\n\n#endif\n", at);
        free(text);
    }
}

/* The same for a scene in fixed point. */
TEST(emitted_header, a_fixed_state_has_every_name) {
    for (unsigned c = 0; c < dice_cases(usual_or(100, 30)); c++) {
        drawn_scene_draw(&drawn, &die);
        char *text = NULL;
        size_t length = 0;
        FILE *out = alloc_text(&text, &length);
        c_header_fixed_state(out, &drawn.im);
        alloc_text_end(out);
        const char *at = said_state(text, "    /* wh_fixed_angle(): unwrapped */\n",
                                    "    /* wh_fixed_real(), wh_fixed_set_real() */\n",
                                    "    /* wh_fixed_set_input(), between steps */\n");
        at =
            said_outputs(at, "    /* fixed-point code computes no outputs: these number a table of "
                             "your own */\n");
        TEST_ASSERT_EQUAL_STRING("", at);
        free(text);
    }
}

SUITE(emitted_header) {
    die = dice_of("emitted_header", 4130);
    make_turning();
}

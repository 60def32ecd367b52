/* c_header.c: a scene's header for C11 and C++11. The header's names are SCENE_KIND_NAME. No KIND may begin with
 * another KIND and an underscore. One enum has all enumerators, because C++20 deprecates sums of two enums. */
#include "c_header.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "emit.h"
#include "host/base/alloc.h"
#include "host/base/hashing.h"
#include "host/image/core_rows.h"

/* Length in bytes of a character that changes the writing direction; 0 for any other character. */
static size_t turns_direction(const char *text) {
    const unsigned char *c = (const unsigned char *)text;
    if (c[0] == 0xe2 && ((c[1] == 0x80 && c[2] >= 0x8e && c[2] <= 0xae) ||
                         (c[1] == 0x81 && c[2] >= 0xa6 && c[2] <= 0xa9))) {
        return 3;
    }
    return c[0] == 0xd8 && c[1] == 0x9c ? 2 : 0;
}

void c_comment(FILE *out, const char *text) {
    for (size_t i = 0; text[i] != '\0'; i++) {
        const size_t turning = turns_direction(text + i);
        if (turning > 0) {
            i += turning - 1;
            fputc(' ', out);
            continue;
        }
        fputc((unsigned char)text[i] < ' ' || text[i] == 0x7f ? ' ' : text[i], out);
        if ((text[i] == '*' && text[i + 1] == '/') || (text[i] == '/' && text[i + 1] == '*') ||
            (text[i] == '?' && text[i + 1] == '?') || text[i] == '\\') {
            fputc(' ', out);
        }
    }
}

/* --- arrays of the state, and the results of observe() ------------------------------------------ */

typedef enum list { LIST_ANGLES, LIST_REALS, LIST_INPUTS, LIST_OUTPUTS, LISTS } list;

static const struct {
    const char *counted; /* last word of such names as SCENE_ANGLES and SCENE_NAMES_OF_ANGLES */
    const char *value;   /* middle word of such names as SCENE_ANGLE_phi */
    const char *rate;    /* middle word of such names as SCENE_ANGLERATE_phi */
    const char *where;
} lists[LISTS] = {
    [LIST_ANGLES] = {"ANGLES", "ANGLE", "ANGLERATE",
                     "state.angle[], read with wh_angle_to_rad(): unwrapped"},
    [LIST_REALS] = {"REALS", "REAL", "RATE", "state.real[]"},
    [LIST_INPUTS] = {"INPUTS", "INPUT", "INPUTRATE", "state.input[], may change between steps"},
    [LIST_OUTPUTS] = {"OUTPUTS", "OUTPUT", "OUTPUTRATE", "filled by the scene's observe()"},
};

typedef struct item {
    const char *name;
    const char *text;
    const char *si;
    int primes;
} item;

static int count_of(const image *im, list of) {
    const int count[LISTS] = {im->angles, im->reals, im->inputs, im->outputs};
    return count[of];
}

static item of_unknown(const image *im, component c) {
    const image_unknown *u = &im->unknown[c.unknown];
    return (item){u->name, u->text, u->unit[c.primes].si, c.primes};
}

static item item_of(const image *im, list of, int i) {
    const int k = i - im->own_outputs; /* if >= 0: index among the outputs recovered from momenta */
    if (of == LIST_ANGLES || of == LIST_REALS) {
        return of_unknown(im, of == LIST_ANGLES ? im->angle[i] : im->real[i]);
    }
    if (of == LIST_OUTPUTS && k >= 0) {
        return of_unknown(im, (component){im->from_momentum[k / 2], k % 2});
    }
    const image_quantity *q = of == LIST_INPUTS ? &im->input[i] : &im->output[i];
    return (item){q->name, q->text, q->unit.si, 0};
}

static const char primes[] = "''''''''''";

void c_header_names(FILE *out, const image *im) {
    static const char *const array[LISTS] = {"angle", "real", "input", "output"};
    fprintf(out, " * Components of the state, SI units, angles in turns (2^32 steps each):\n");
    for (int of = 0; of < LISTS; of++) {
        for (int i = 0; i < count_of(im, (list)of); i++) {
            const item it = item_of(im, (list)of, i);
            fprintf(out, " *   %s[%d]%*s%s%.*s%s\n", array[of], i, 7 - (int)strlen(array[of]), "",
                    it.name, it.primes, primes,
                    of == LIST_OUTPUTS && i >= im->own_outputs ? ", from its momentum" : "");
        }
    }
}

static void write_items(FILE *out, const image *im, list of, const char *where) {
    const char *prefix = im->name;
    fprintf(out, "    /* %s */\n", where);
    for (int i = 0; i < count_of(im, of); i++) {
        const item it = item_of(im, of, i);
        fprintf(out, "    %s_%s", prefix, it.primes > 0 ? lists[of].rate : lists[of].value);
        if (it.primes > 1) {
            fprintf(out, "%d", it.primes);
        }
        fprintf(out, "_%s = %d, /* ", it.name, i);
        c_comment(out, it.si);
        if (it.text[0] != '\0') {
            fputs(it.primes > 0 ? ": rate of: " : ": ", out);
            c_comment(out, it.text);
        }
        fputs(" */\n", out);
    }
    fprintf(out, "    %s_%s = %d,\n\n", prefix, lists[of].counted, count_of(im, of));
}

/* Writes the initializer of an array of strings. */
static void write_strings(FILE *out, const image *im, list of) {
    if (count_of(im, of) == 0) {
        return;
    }
    fprintf(out, "#define %s_NAMES_OF_%s {", im->name, lists[of].counted);
    for (int i = 0; i < count_of(im, of); i++) {
        const item it = item_of(im, of, i);
        fprintf(out, "%s\"%s%.*s\"", i > 0 ? ", " : "", it.name, it.primes, primes);
    }
    fprintf(out, "}\n#define %s_UNITS_OF_%s {", im->name, lists[of].counted);
    for (int i = 0; i < count_of(im, of); i++) {
        const item it = item_of(im, of, i);
        fprintf(out, "%s\"%s\"", i > 0 ? ", " : "", it.si);
    }
    fputs("}\n", out);
}

/* Defines a number. WH_R() appends a suffix to its text, which must therefore have a point or an exponent. */
static void define_number(FILE *out, const image *im, const char *kind, const char *name,
                          double value) {
    char text[40];
    snprintf(text, sizeof text, "%.17g", value);
    fprintf(out, "#define %s_%s%s WH_R(%s%s)", im->name, kind, name, text,
            strpbrk(text, ".e") == NULL ? ".0" : "");
}

void c_header_values(FILE *out, const image *im) {
    fprintf(out,
            "\n/* Whirl's version, the model's hash, the step in s, parameters and inputs. */\n"
            "#define %s_VERSION \"%s\"\n#define %s_MODEL_HASH UINT64_C(0x%016" PRIx64 ")\n",
            im->name, WH_VERSION, im->name, im->hash);
    define_number(out, im, "STEP_S", "", im->step_s);
    fputc('\n', out);
    for (int i = 0; i < im->parameters + im->inputs; i++) {
        const bool constant = i < im->parameters;
        const image_quantity *q = constant ? &im->parameter[i] : &im->input[i - im->parameters];
        define_number(out, im, constant ? "PARAMETER_" : "START_", q->name, q->value);
        fputs(" /* ", out);
        c_comment(out, q->unit.si);
        fputs(q->text[0] != '\0' ? ": " : "", out);
        c_comment(out, q->text);
        fputs(" */\n", out);
    }
    for (int i = 0; i < im->contacts; i++) {
        int number = 1;
        for (int k = 0; k < i; k++) {
            number += im->contact[k].kind == im->contact[i].kind ? 1 : 0;
        }
        fprintf(out, "#define %s_CONTACT_%s%d %d /* in line %d */\n", im->name, im->contact[i].word,
                number, i, im->contact[i].at.line);
    }
}

void c_header_range(FILE *out, const image *im, int i, double low, double high) {
    const bool is_input = i >= im->reals;
    const item it = item_of(im, is_input ? LIST_INPUTS : LIST_REALS, is_input ? i - im->reals : i);
    for (int end = 0; end < 2; end++) {
        const char *kind = is_input ? "INPUT" : it.primes > 0 ? "RATE" : "REAL";
        char of[40];
        snprintf(of, sizeof of, it.primes > 1 ? "%s_%s%d_" : "%s_%s_",
                 end == 0 ? "LEAST" : "MOST", // NOLINT
                 kind, it.primes);
        define_number(out, im, of, it.name, end == 0 ? low : high);
        fputc('\n', out);
    }
}

void c_header_strings(FILE *out, const image *im) {
    fprintf(out, "/* For arrays: static const char *const unit[] = %s_UNITS_OF_%s; */\n", im->name,
            im->outputs > 0 ? "OUTPUTS" : "REALS");
    for (int of = 0; of < LISTS; of++) {
        write_strings(out, im, (list)of);
    }
}

void c_header_fixed_state(FILE *out, const image *im) {
    write_items(out, im, LIST_ANGLES, "wh_fixed_angle(): unwrapped");
    write_items(out, im, LIST_REALS, "wh_fixed_real(), wh_fixed_set_real()");
    write_items(out, im, LIST_INPUTS, "wh_fixed_set_input(), between steps");
    write_items(out, im, LIST_OUTPUTS,
                "fixed-point code computes no outputs: these number a table of your own");
}

/* Returns "SCENE_HEADER_1a2b3c4d", to be freed. The number is a hash of the body without its comments. */
static char *linked_name(const char *scene, c_header_body *body, const void *of) {
    char *text;
    size_t length;
    FILE *out = alloc_text(&text, &length);
    body(out, of);
    alloc_text_end(out);
    size_t kept = 0;
    for (size_t i = 0; i < length; i++) {
        if (strncmp(text + i, "/*", 2) == 0) {
            i = (size_t)(strstr(text + i, "*/") + 1 - text);
        } else {
            text[kept++] = text[i];
        }
    }
    char *name = alloc_words("%s_HEADER_%08" PRIx32, scene, hash_text(text, kept));
    free(text);
    return name;
}

void c_header_link(FILE *out, const char *type, const char *scene, c_header_body *body,
                   const void *of) {
    char *name = linked_name(scene, body, of);
    fprintf(out,
            "#ifndef WHIRL_SCENE_%s_H\n#define WHIRL_SCENE_%s_C\n#include \"core/version.h\"\n"
            "extern const wh_%s %s;\nWH_LINKED_AS(%s, %s);\n#endif\n",
            scene, scene, type, scene, scene, name);
    free(name);
}

void c_header_of_image(FILE *out, const void *of) {
    const image *im = of;
    fprintf(
        out,
        "/* Memory of wh_scene_start(), in float or double: in bytes, and in words of a uint64_t array. */\n"
        "#define %s_MEMORY_BYTES WH_MEMORY_BYTES(%d, %d, %d)\n"
        "#define %s_MEMORY_WORDS ((%s_MEMORY_BYTES + 7U) / 8U)\n\nenum {\n",
        im->name, im->angles, core_memory_reals(im), im->contacts, im->name, im->name);
    for (int k = 0; k < LISTS; k++) {
        write_items(out, im, (list)k, lists[k].where);
    }
    fprintf(
        out,
        "    /* state.contacts->mode[]; levels that wh_ledger_error() takes; the ledger's entries */\n"
        "    %s_CONTACTS = %d,\n    %s_ACCOUNTS = %d,\n    %s_ENTRIES = %d,\n\n"
        "    /* most evaluations in a step: of the accelerations, of the contacts' signals */\n"
        "    %s_EVALUATIONS = %d,\n    %s_SIGNALS = %d\n};\n\n",
        im->name, im->contacts, im->name, im->ledger.accounts, im->name, im->ledger.entries,
        im->name, core_evaluations(im), im->name, core_signals(im));
    c_header_strings(out, im);
    c_header_values(out, im);
    for (int i = 0; i < im->reals + im->inputs; i++) {
        if (im->range[i].declared) {
            c_header_range(out, im, i, im->range[i].low, im->range[i].high);
        }
    }
    fputs("\n#ifdef __cplusplus\n}\n#endif\n\n#endif\n", out);
}

void c_header_write(FILE *out, const image *im, const char *file, const char *form,
                    const char *type, c_header_body *body, const void *of) {
    char *name = linked_name(im->name, body, of);
    fputs("/* " EMIT_BANNER " from ", out);
    c_comment(out, file);
    fprintf(out, ": do not edit.\n *\n * scene        %s%s%s", im->name, form,
            im->title[0] != '\0' ? ": " : "");
    c_comment(out, im->title);
    fprintf(
        out,
        "\n * model hash   0x%016" PRIx64 "\n *\n"
        " * Values are SI, also if the model declares other units.\n"
        " * The model belongs to its author. The text that whirl adds has the licence of core/.\n"
        " * SPDX-License-Identifier: MIT\n"
        " */\n#ifndef WHIRL_SCENE_%s_H\n#define WHIRL_SCENE_%s_H\n\n"
        "#include \"core/%s.h\"\n#include \"core/version.h\"\n\n",
        im->hash, im->name, im->name, type);
    fprintf(
        out,
        "#if WH_VERSION_NUMBER != %d\n"
        "#error \"This scene was generated by whirl %s: take core/ of the same version, or generate it again.\"\n#endif\n\n",
        WH_VERSION_NUMBER, WH_VERSION);
    fprintf(
        out,
        "#ifdef __cplusplus\nextern \"C\" {\n#endif\n\n"
        "/* If the linker does not find this symbol, header and .c differ: generate both again. */\n"
        "#ifndef WHIRL_SCENE_%s_C\nextern const wh_%s %s WH_LINKS_TO(%s);\n#endif\n\n",
        im->name, type, im->name, name);
    free(name);
    body(out, of);
}

void emit_c_header(FILE *out, const image *im, const char *file) {
    c_header_write(out, im, file, "", "scene", c_header_of_image, im);
}

/* derive.c: `whirl derive`: the equations of motion, the first-order form, the code. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "commands.h"
#include "host/cli/load.h"
#include "host/emit/emit.h"
#include "host/engine/start.h"
#include "host/fixed/c_fixed.h"
#include "host/fixed/engine_fixed.h"
#include "host/fixed/fixed_plan.h"
#include "host/lang/lexer.h"
#include "host/os/atomic_file.h"
#include "host/show/show.h"
#include "options.h"

/* Properties of a form. SHOWS: prints equations, not code; --steps prints their derivation. */
enum {
    SHOWS = 1,
    FOLDS = 2,  /* prints values instead of names (--folded) */
    NAMED = 4,  /* the code contains the scene's name (--name) */
    HEADED = 8, /* has a header (--header) */
    RUNS = 16   /* code that steps the scene, with a method and a number type */
};

typedef struct form_row {
    const char *word;
    unsigned is; /* sum of the properties above */
} form_row;

enum { TEXT, LATEX, OCTAVE, C, FORMS };
static const form_row forms[FORMS] = {
    {.word = "text", .is = SHOWS},
    {.word = "latex", .is = SHOWS},
    {.word = "octave", .is = FOLDS | NAMED},
    {.word = "c", .is = RUNS | NAMED | HEADED},
};

static const command_usage usage = {
    .head =
        "usage: whirl derive FILE[:NAME]|SCENE|MECHANISM[:SCENE] [--as FORM] [options]\n"
        "\n"
        "Prints the equations of motion of a mechanism, or of a scene with its effects, or the scene's code.\n"
        "\n"
        "  --as text    one equation per coordinate, its events, and the first-order form (default)\n"
        "  --as latex   the same equations in LaTeX, for a paper (needs amsmath)\n"
        "  --as octave  a function file for Octave and Matlab; events only as comments\n"
        "  --as c       the scene as C for the core (docs/howto/firmware.md)\n"
        "  --steps, with --as text or latex: the derivation: the Lagrangian, and for each coordinate dL/dq',\n"
        "               its time derivative, dL/dq, dF/dq' and Q\n"
        "  --folded, with --as octave: values instead of parameter names, one operation per line\n"
        "  --header FILE, with --as c: the header for C and C++: names, units, memory (docs/embedding.md)\n"
        "  --name NAME, with --as octave or c: the scene's name in the code, so that a program can contain\n"
        "               it twice\n",
    .groups = OPTIONS_CHANGE | OPTIONS_STEP | OPTIONS_ENGINE | OPTIONS_NUMBER,
    .tail =
        "Formulas are in SI. The method and --number fixed change only --as c.\n"
        "All other code is the same for float and double. With --matrix all forms show the matrix, and\n"
        "--as octave only the matrix.\n"};

typedef struct derive_options {
    common_options common;
    const char *target;
    const char *header;
    const char *form;
    const form_row *as;
    bool steps;
    bool folded;
} derive_options;

/* Prints the chosen form. It is not called for C in fixed point, which c_fixed() prints. */
static void print(const derive_options *o, const loaded *made, const char *file) {
    const image *im = made->image;
    const bool matrix = im->settings.matrix != MATRIX_NONE;
    const bool latex = o->as == &forms[LATEX];
    if (o->as == &forms[C]) {
        emit_c(stdout, im, file);
    } else if (o->as == &forms[OCTAVE] && matrix) {
        matrix_octave(stdout, im, file);
    } else if (o->as == &forms[OCTAVE]) {
        char *contacts = contacts_in_octave(made->equations);
        if (o->folded) {
            emit_octave(stdout, im, file, contacts);
        } else {
            emit_octave_head(stdout, im, file, contacts);
            show_octave(stdout, made->equations, emit_octave_variable_is_free);
            emit_octave_end(stdout, im);
        }
        free(contacts);
    } else {
        if (latex) {
            printf("%% " EMIT_BANNER " from %s\n", file);
        }
        if (o->steps) {
            show_steps(stdout, made->equations, latex ? SHOW_LATEX : SHOW_TEXT);
        } else {
            (latex ? show_latex : show_text)(stdout, made->equations);
        }
        if (matrix && !o->steps) {
            (latex ? matrix_latex : matrix_text)(stdout, im);
        }
    }
}

/* If the option is given, but the form lacks the property `of`: returns false and reports the forms that have it. */
static bool goes_with(bool given, const char *option, const char *value, unsigned of,
                      const char *with, const form_row *as) {
    const bool goes = !given || (as->is & of) != 0;
    return goes || options_fail("derive", "%s needs --as %s\nhint: --as %.*s %s%s", option, with,
                                (int)strcspn(with, " "), with, option, value);
}

/* --header must not be standard output, which gets the code. */
static bool header_is_apart(const char *header) {
    if (strcmp(header, "-") == 0 || header[0] == '\0') {
        return options_fail("derive",
                            "--header needs the name of a file, because standard output is "
                            "for the C code");
    }
    if (files_same("/dev/stdout", header)) {
        return options_fail("derive",
                            "--header and standard output cannot share a file\nhint: give the "
                            "header another name");
    }
    return true;
}

static bool write_header(const image *im, const fixed_plan *plan, const char *file,
                         const char *header) {
    FILE *out = atomic_file_open(header);
    if (out != NULL && plan != NULL) {
        c_fixed_header(out, plan, file);
    } else if (out != NULL) {
        emit_c_header(out, im, file);
    }
    return out != NULL && atomic_file_close(out, header, true);
}

/* Can code of that form have the scene's name? If not, reports the reason. */
static bool has_name(const image *im, const source_model *from, place at, const form_row *as,
                     bool header) {
    const char *taken_by = NULL;
    if (as == &forms[OCTAVE]) {
        taken_by = emit_octave_name_is_free(im->name) ? NULL : "a word of Octave or Matlab";
    } else if (!emit_c_name_is_free(im->name)) {
        taken_by = "a word of C, of its library or of Whirl's core";
    } else if (header && !emit_c_name_is_free_in_cpp(im->name)) {
        taken_by = "a word of C++";
    }
    if (taken_by != NULL) {
        fprintf(stderr,
                "%s:%d:%d: error: '%s' is %s: the generated scene cannot have that name\n"
                "hint: rename the scene, or choose a name for the code only: --name NAME\n",
                from->file, at.line, at.column, im->name, taken_by);
    }
    return taken_by == NULL;
}

/* Returns the step in fixed point, or NULL for another number type. *good is false after an error (reported). */
static fixed_plan *plan_of(const image *im, const source_model *from, const engine_kind *number,
                           bool *good) {
    fixed_plan *plan = number == &engine_fixed ? fixed_plan_make(im, false, from->errors) : NULL;
    *good = number != &engine_fixed ||
            (plan != NULL && fixed_inputs_declared(im, plan->range, from->errors));
    diags_flush(from->errors, stderr);
    if (plan != NULL && *good) {
        fixed_plan_say(plan, stderr, "whirl derive: note: ");
    }
    return plan;
}

/* Can the image be written as C for the core? If not, reports the reason. */
static bool has_c_form(const image *im, source_model *from) {
    const bool has = start_angles_are_held(im, from->errors) &&
                     start_has_method(im, im->settings.method, from->errors);
    diags_flush(from->errors, stderr);
    return has;
}

static int derive_one(source_model *from, const mechanism *of, const scene *in,
                      const overrides *changes, const derive_options *o, const char *header) {
    const form_row *as = o->as;
    const bool runs = (as->is & RUNS) != 0;
    load_request request = {.settings = o->common.integration,
                            .use = IMAGE_TO_WRITE,
                            .hints = true,
                            .conserve = runs || o->common.integration.matrix != MATRIX_NONE};
    if (!runs) { /* only the form `c` can have tables */
        request.settings.tables = TABLES_NONE;
        request.settings.cells = 0;
    }
    const place at = in != NULL ? in->at : of->at;
    loaded made;
    int code = load(&made, from, of, in, changes, &request);
    bool good = true;
    fixed_plan *plan = NULL;
    if (code == EXIT_DONE && o->steps && of->is_system) {
        fprintf(stderr,
                "%s: error: --steps shows how energies lead to equations, but '%s' has no "
                "energies\n",
                from->file, of->name);
        code = EXIT_BAD_INPUT;
    }
    if (code == EXIT_DONE) {
        plan = plan_of(made.image, from, o->common.number, &good);
    }
    if (code == EXIT_DONE &&
        (!good || ((as->is & NAMED) != 0 && !has_name(made.image, from, at, as, header != NULL)) ||
         (runs && !has_c_form(made.image, from)) ||
         (header != NULL && !write_header(made.image, plan, from->file, header)))) {
        code = EXIT_BAD_INPUT;
    }
    if (code == EXIT_DONE) {
        if (plan != NULL) {
            c_fixed(stdout, plan, from->file);
        } else {
            if (runs) {
                say_float_range(made.image);
            }
            print(o, &made, from->file);
        }
    }
    fixed_plan_free(plan);
    unload(&made);
    return code;
}

static bool options_fit(derive_options *o) {
    /* Matlab runs the same function file as Octave */
    const char *form = strcasecmp("matlab", o->form) == 0 ? "octave" : o->form;
    const int chosen = options_choose("derive", "form", form, forms, sizeof forms[0], FORMS);
    const char *name = o->common.changes.name; /* must be a name as in a .whirl file */
    if (chosen < 0 || (name != NULL && !options_is_name("derive", name, NAME_LENGTH_MAX))) {
        return false;
    }
    o->as = &forms[chosen];
    return goes_with(o->header != NULL, "--header", " FILE", HEADED, "c", o->as) &&
           goes_with(o->steps, "--steps", "", SHOWS, "text or latex", o->as) &&
           goes_with(o->folded, "--folded", "", FOLDS, "octave", o->as) &&
           goes_with(name != NULL, "--name", " NAME", NAMED, "octave or c", o->as) &&
           goes_with(o->common.number == &engine_fixed, "--number fixed", "", RUNS, "c", o->as);
}

static int derive_source(source_model *from, void *options) {
    derive_options *o = options;
    const overrides *changes = &o->common.changes;
    const mechanism *of;
    const scene *in;
    if (!options_fit(o)) {
        return EXIT_BAD_INPUT;
    }
    int code = EXIT_DONE;
    if (from->name[0] == '\0' && (o->as->is & SHOWS) != 0) {
        for (int i = 0; i < from->model->mechanism_count && code == EXIT_DONE; i++) {
            fputs(i > 0 ? "\n" : "", stdout);
            code = derive_one(from, from->model->mechanisms[i], NULL, changes, o, NULL);
        }
        return code;
    }
    code = source_pick(from, true, &of, &in);
    if (code == EXIT_DONE && o->header != NULL && !header_is_apart(o->header)) {
        code = EXIT_BAD_INPUT;
    }
    return code == EXIT_DONE ? derive_one(from, of, in, changes, o, o->header) : code;
}

int command_derive(int count, char **words) {
    derive_options o = {.common = options_defaults(), .form = forms[TEXT].word};
    const own_option own[] = {{.word = "--as", .text = &o.form},
                              {.word = "--name", .text = &o.common.changes.name},
                              {.word = "--header", .text = &o.header, .file = FILE_WRITTEN},
                              {.word = "--steps", .flag = &o.steps},
                              {.word = "--folded", .flag = &o.folded},
                              {.word = NULL}};
    const target_reader reader = {.command = "derive",
                                  .usage = &usage,
                                  .table = own,
                                  .one = "scene or mechanism",
                                  .work_on = derive_source};
    return target_command(&reader, count, words, &o.common, &o, &o.target);
}

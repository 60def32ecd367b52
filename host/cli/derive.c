/* derive.c: `whirl derive`: the equations of motion, the first-order form, the code. */
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "commands.h"
#include "host/cli/load.h"
#include "host/emit/emit.h"
#include "host/emit/matrix.h"
#include "host/engine/start.h"
#include "host/fixed/c_fixed.h"
#include "host/fixed/engine_fixed.h"
#include "host/fixed/fixed_plan.h"
#include "host/lang/lexer.h"
#include "host/os/atomic_file.h"
#include "host/show/show_equations.h"
#include "target.h"

static void text(const loaded *made, const char *file) {
    (void)file;
    show_text(stdout, made->equations);
    if (made->image->settings.matrix != MATRIX_NONE) {
        matrix_text(stdout, made->image);
    }
}

static void latex(const loaded *made, const char *file) {
    printf("%% " EMIT_BANNER " from %s\n", file);
    show_latex(stdout, made->equations);
    if (made->image->settings.matrix != MATRIX_NONE) {
        matrix_latex(stdout, made->image);
    }
}

static void steps(const loaded *made, const char *file) {
    (void)file;
    show_steps(stdout, made->equations, SHOW_TEXT);
}

static void latex_steps(const loaded *made, const char *file) {
    printf("%% " EMIT_BANNER " from %s\n", file);
    show_steps(stdout, made->equations, SHOW_LATEX);
}

static void folded_octave(const loaded *made, const char *file) {
    if (made->image->settings.matrix != MATRIX_NONE) {
        matrix_octave(stdout, made->image, file);
    } else {
        emit_octave(stdout, made->image, file, made->contacts);
    }
}

static void octave(const loaded *made, const char *file) {
    if (made->image->settings.matrix != MATRIX_NONE) {
        matrix_octave(stdout, made->image, file);
    } else {
        emit_octave_head(stdout, made->image, file, made->contacts);
        show_octave(stdout, made->equations, emit_octave_variable_is_free);
        emit_octave_end(stdout, made->image);
    }
}

static void c(const loaded *made, const char *file) { emit_c(stdout, made->image, file); }

static const char *taken_in_octave(const char *name, bool with_header) {
    (void)with_header;
    return emit_octave_name_is_free(name) ? NULL : "a word of Octave or Matlab";
}

static const char *taken_in_c(const char *name, bool with_header) {
    if (!emit_c_name_is_free(name)) {
        return "a word of C, of its library or of the core";
    }
    return with_header && !emit_c_name_is_free_in_cpp(name) ? "a word of C++" : NULL;
}

/* The properties of a form. A form that shows prints the equations of each mechanism of a file in turn, and their derivation
 * (--steps); another form prints code. */
enum {
    SHOWS = 1,
    FOLDS = 2,  /* prints values instead of names (--folded) */
    NAMED = 4,  /* its code contains the scene's name (--name) */
    HEADED = 8, /* has a header (--header) */
    RUNS = 16   /* steps the scene: momenta, method and number type matter */
};

typedef struct form_row {
    const char *word;
    unsigned is; /* sum of the properties above */
    void (*print)(const loaded *made, const char *file);
    void (*print_steps)(const loaded *made, const char *file);
    void (*print_folded)(const loaded *made, const char *file);
    /* For --name: what the name already is in that language, such as "a word of C++"; NULL: the name is free. */
    const char *(*name_taken_by)(const char *name, bool with_header);
    /* For code with a header (--header). */
    void (*print_header)(FILE *out, const image *im, const char *file);
    /* For code that omits contacts: begins each line of the comment that lists them. */
    const char *comment;
    const char *text;
} form_row;

/* The first is the default. */
static const form_row forms[] = {
    {.word = "text",
     .print = text,
     .print_steps = steps,
     .is = SHOWS,
     .text = "one equation per coordinate, its events, and the first-order form (default)"},
    {.word = "latex",
     .print = latex,
     .print_steps = latex_steps,
     .is = SHOWS,
     .text = "the same for a paper (with amsmath)"},
    {.word = "octave",
     .print = octave,
     .print_folded = folded_octave,
     .is = FOLDS | NAMED,
     .name_taken_by = taken_in_octave,
     .comment = EMIT_OCTAVE_COMMENT,
     .text = "a function file for Octave and Matlab; events are listed only"},
    {.word = "c",
     .print = c,
     .is = RUNS | NAMED | HEADED,
     .name_taken_by = taken_in_c,
     .print_header = emit_c_header,
     .text = "the scene as C for the core (docs/howto/firmware.md)"},
};
enum { FORMS = sizeof forms / sizeof forms[0], FORMS_TEXT_SIZE = 16 + 16 * FORMS };

/* Writes the forms with this property into `said`, such as "--as octave or c", and returns `said`. */
static const char *forms_with(unsigned bit, char said[FORMS_TEXT_SIZE]) {
    size_t length = (size_t)snprintf(said, FORMS_TEXT_SIZE, "--as");
    int left = 0;
    for (int i = 0; i < FORMS; i++) {
        left += (forms[i].is & bit) != 0;
    }
    const int all = left;
    for (int i = 0; i < FORMS && length < FORMS_TEXT_SIZE; i++) {
        if ((forms[i].is & bit) != 0) {
            const char *before = left == all ? " " : left > 1 ? ", " : " or ";
            length += (size_t)snprintf(said + length, FORMS_TEXT_SIZE - length, "%s%s", before,
                                       forms[i].word);
            left--;
        }
    }
    return said;
}

static const command_usage usage = {
    .head =
        "usage: whirl derive FILE[:NAME]|SCENE|MECHANISM[:SCENE] [--as FORM] [options]\n"
        "\n"
        "Prints the equations of motion of a mechanism, or of a scene with its effects, or the scene's code.\n"
        "\n",
    .tail = ""};
static const command_usage options_of_derive = {.head = "",
                                                .groups = OPTIONS_CHANGE | OPTIONS_STEP |
                                                          OPTIONS_ENGINE | OPTIONS_NUMBER,
                                                .tail = "Formulas are in SI. "};

static void print_option(FILE *out, const char *option, unsigned of, const char *what) {
    char said[FORMS_TEXT_SIZE];
    const int column = fprintf(out, "  %s, with %s: ", option, forms_with(of, said));
    options_text(out, what, column, 15, 99);
}

static void print_usage(FILE *out) {
    char said[FORMS_TEXT_SIZE];
    options_usage(out, &usage);
    for (int i = 0; i < FORMS; i++) {
        fprintf(out, "  --as %-8s%s\n", forms[i].word, forms[i].text);
    }
    print_option(
        out, "--steps", SHOWS,
        "the derivation: the Lagrangian, and for each coordinate dL/dq', its time derivative, "
        "dL/dq, dF/dq' and Q");
    print_option(out, "--folded", FOLDS,
                 "values instead of parameter names, one operation per line");
    print_option(out, "--header FILE", HEADED,
                 "its header, for C and C++: names, units, memory (docs/embedding.md)");
    print_option(out, "--name NAME", NAMED,
                 "the scene's name in the code, so that a program can contain it twice");
    options_usage(out, &options_of_derive);
    fprintf(
        out,
        "The method and --number fixed change only %s.\n"
        "All other code is the same for float and double. With --matrix all forms show the matrix, and\n"
        "--as octave only the matrix.\n",
        forms_with(RUNS, said));
}

/* Returns true if the option, such as "--header", is valid for this form; else reports the forms that accept it. */
static bool goes_with(const char *option, const char *value, unsigned of, const form_row *as) {
    char said[FORMS_TEXT_SIZE];
    int first = 0;
    while (first + 1 < FORMS && (forms[first].is & of) == 0) {
        first++;
    }
    if ((as->is & of) == 0) {
        fprintf(stderr, "whirl derive: error: %s goes with %s\nhint: --as %s %s%s%s\n", option,
                forms_with(of, said), forms[first].word, option, value[0] != '\0' ? " " : "",
                value);
    }
    return (as->is & of) != 0;
}

/* --header must not be a file that is read or written at the same time. */
static bool header_is_apart(const source_model *from, const char *header) {
    struct stat about_output;
    struct stat about_header;
    if (strcmp(header, "-") == 0 || header[0] == '\0') {
        fputs("whirl derive: error: --header needs a file: standard output is for the C code\n",
              stderr);
        return false;
    }
    if (source_would_be_lost(from, "--header", header, "")) {
        return false;
    }
    if (fstat(STDOUT_FILENO, &about_output) == 0 && S_ISREG(about_output.st_mode) &&
        stat(header, &about_header) == 0 &&
        files_are_one(&about_output, NULL, &about_header, header)) {
        fprintf(stderr,
                "%s: error: --header and standard output cannot share a file\n"
                "hint: give it another name\n",
                header);
        return false;
    }
    return true;
}

static bool write_header(const form_row *as, const image *im, const fixed_plan *plan,
                         const char *file, const char *header) {
    FILE *out = atomic_file_open(header);
    if (out != NULL) {
        if (plan != NULL) {
            c_fixed_header(out, plan, file);
        } else {
            as->print_header(out, im, file);
        }
    }
    return out != NULL && atomic_file_close(out, header, true);
}

/* Can code of that form have the scene's name? Otherwise reports the reason. */
static bool has_name(const image *im, const source_model *from, const form_row *as,
                     const char *header) {
    const char *taken_by = as->name_taken_by(im->name, header != NULL);
    if (taken_by != NULL) {
        fprintf(stderr,
                "%s: error: '%s' is %s: the generated scene cannot have that name\n"
                "hint: rename it, or give it another for this: --name NAME\n",
                from->file, im->name, taken_by);
    }
    return taken_by == NULL;
}

/* The step in fixed point, if requested; *good is false after an error. */
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

/* Can this be C for the core? Otherwise reports the reason. */
static bool has_c_form(const image *im, source_model *from) {
    const bool has = start_angles_are_held(im, from->errors) &&
                     start_has_method(im, im->settings.method, from->errors);
    if (!has) {
        diags_flush(from->errors, stderr);
    }
    return has;
}

typedef struct derive_options {
    common_options common;
    const char *target;
    const char *header;
    const form_row *as;
    bool steps;
    bool folded;
} derive_options;

static int derive_one(source_model *from, const mechanism *of, const scene *in,
                      const overrides *changes, const derive_options *o, const char *header) {
    const form_row *as = o->as;
    const common_options *options = &o->common;
    const bool runs = (as->is & RUNS) != 0;
    const bool from_equations = (as->is & SHOWS) != 0 || ((as->is & FOLDS) != 0 && !o->folded);
    const image_settings *settings = &options->integration;
    image_settings taken = *settings;
    if (!runs) { /* equations, and code for other programs, have no tables */
        taken.tables = TABLES_NONE;
        taken.cells = 0;
    }
    const load_wish wish = {.settings = taken,
                            .use = IMAGE_TO_WRITE,
                            .keep = from_equations ? KEEP_EQUATIONS : KEEP_IMAGE,
                            .conserve = runs || settings->matrix != MATRIX_NONE,
                            .comment = as->comment};
    loaded made;
    int code = load(&made, from, of, in, changes, &wish);
    if (!from_equations) {
        source_forget(from);
    }
    bool good = true;
    fixed_plan *plan = NULL;
    if (code == EXIT_DONE && o->steps && of->is_system) {
        fprintf(stderr, "%s: error: %s is given by equations: --steps derives them from energies\n",
                from->file, of->name);
        code = EXIT_BAD_INPUT;
    }
    if (code == EXIT_DONE) {
        plan = plan_of(made.image, from, options->number, &good);
    }
    if (code == EXIT_DONE &&
        (!good || ((as->is & NAMED) != 0 && !has_name(made.image, from, as, header)) ||
         (runs && !has_c_form(made.image, from)) ||
         (header != NULL && !write_header(as, made.image, plan, from->file, header)))) {
        code = EXIT_BAD_INPUT;
    }
    if (code == EXIT_DONE) {
        say_hints(&made);
        if (plan != NULL) {
            c_fixed(stdout, plan, from->file);
        } else {
            if (runs) {
                say_float_range(made.image);
            }
            (o->steps    ? as->print_steps
             : o->folded ? as->print_folded
                         : as->print)(&made, from->file);
        }
    }
    fixed_plan_free(plan);
    unload(&made);
    return code;
}

static bool take_one(int count, char **words, int *at, void *options, bool *bad) {
    derive_options *o = options;
    const char *value = options_value(count, words, at, "--as", bad);
    if (value != NULL) {
        if (options_same("matlab", value)) { /* Matlab runs the same function file */
            value = "octave";
        }
        const int chosen = options_choose("derive", "form", value, forms, sizeof forms[0], FORMS);
        *bad = chosen < 0;
        o->as = chosen < 0 ? o->as : &forms[chosen];
    } else if (!*bad && (value = options_value(count, words, at, "--name", bad)) != NULL) {
        o->common.change.name = value; /* with the rules of names in a .whirl file */
        *bad = !options_is_name("derive", value, NAME_LENGTH_MAX);
    }
    return value != NULL;
}

static bool read_options(int count, char **words, derive_options *o) {
    static const char *const other[] = {"--as", "--name", NULL};
    const own_option own[] = {{.word = "--header", .text = &o->header},
                              {.word = "--steps", .flag = &o->steps},
                              {.word = "--folded", .flag = &o->folded},
                              {.word = NULL}};
    const target_reader reader = {.command = "derive",
                                  .usage = &options_of_derive,
                                  .table = own,
                                  .own = other,
                                  .take = take_one,
                                  .derives = true};
    if (!target_read(&reader, count, words, &o->common, o, &o->target) ||
        (o->header != NULL && !goes_with("--header", "FILE", HEADED, o->as)) ||
        (o->steps && !goes_with("--steps", "", SHOWS, o->as)) ||
        (o->folded && !goes_with("--folded", "", FOLDS, o->as)) ||
        (o->common.change.name != NULL && !goes_with("--name", "NAME", NAMED, o->as))) {
        return false;
    }
    if (o->common.number == &engine_fixed && (o->as->is & RUNS) == 0) {
        char said[FORMS_TEXT_SIZE];
        fprintf(stderr, "whirl derive: error: --number fixed goes with %s\n",
                forms_with(RUNS, said));
        return false;
    }
    if (o->target == NULL) {
        print_usage(stderr);
    }
    return o->target != NULL;
}

/* Derives all mechanisms of a file, if the form shows them and no name is given; otherwise the named one. */
static int derive_opened(source_model *from, const derive_options *o) {
    const overrides changes = options_overrides(&o->common.change);
    const mechanism *of;
    const scene *in;
    int code = EXIT_DONE;
    if (from->name[0] == '\0' && (o->as->is & SHOWS) != 0) {
        for (int i = 0; i < from->model->mechanism_count && code == EXIT_DONE; i++) {
            fputs(i > 0 ? "\n" : "", stdout);
            code = derive_one(from, from->model->mechanisms[i], NULL, &changes, o, NULL);
        }
        return code;
    }
    /* the file's only scene; if there are several scenes, its mechanism */
    code = source_pick(from, from->model->scene_count == 1, &of, &in);
    if (code == EXIT_DONE && o->header != NULL && !header_is_apart(from, o->header)) {
        code = EXIT_BAD_INPUT;
    }
    return code == EXIT_DONE ? derive_one(from, of, in, &changes, o, o->header) : code;
}

int command_derive(int count, char **words) {
    derive_options o = {.common = options_defaults(), .as = &forms[0]};
    if (options_wants_help(count, words)) {
        print_usage(stdout);
        return EXIT_DONE;
    }
    int code = EXIT_BAD_INPUT;
    if (read_options(count, words, &o)) {
        source_model from;
        code = source_open(&from, o.target);
        if (code == EXIT_DONE) {
            code = derive_opened(&from, &o);
        }
        source_close(&from);
    }
    options_forget(&o.common);
    return code;
}

/* derive.c: `whirl derive`: the equations of motion, the first-order form, the code. */
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "commands.h"
#include "files.h"
#include "host/emit/emit.h"
#include "host/lang/lexer.h"
#include "host/run/start.h"
#include "host/show/show_equations.h"
#include "load.h"
#include "options.h"

static void text(const loaded *made, const char *file) {
    (void)file;
    show_text(stdout, made->equations);
}

static void latex(const loaded *made, const char *file) {
    (void)file;
    show_latex(stdout, made->equations);
}

static void octave(const loaded *made, const char *file) {
    emit_octave(stdout, made->image, file, made->contacts);
}

static void c(const loaded *made, const char *file) { emit_c(stdout, made->image, file); }

typedef struct form_row {
    const char *word;
    void (*print)(const loaded *made, const char *file);
    bool shows; /* equations, of each mechanism of a file one after another; else it is code */
    bool named; /* holds the scene's name: --name */
    bool runs;  /* steps the scene: momenta, method and number matter, and it has a header */
    bool tells_contacts; /* in words, since it has no steps of its own for them */
    const char *text;
} form_row;

/* The first stands for itself. */
static const form_row forms[] = {
    {.word = "text",
     .print = text,
     .shows = true,
     .text = "one equation a coordinate, as in a textbook, and the first-order form (default)"},
    {.word = "latex", .print = latex, .shows = true, .text = "the same for a paper (with amsmath)"},
    {.word = "octave",
     .print = octave,
     .named = true,
     .tells_contacts = true,
     .text = "a function file that Octave and Matlab integrate as it stands"},
    {.word = "c", .print = c, .named = true, .runs = true, .text = "the scene as C for the core"},
};
enum { FORMS = sizeof forms / sizeof forms[0] };

static const command_usage usage = {
    .head =
        "usage: whirl derive FILE[:NAME]|SCENE|MECHANISM[:SCENE] [--as FORM] [options]\n"
        "\n"
        "Prints the equations of motion of a mechanism (or of a scene, with its effects), of a FILE or\n"
        "built in (`whirl list`):\n",
    .tail = ""};
static const command_usage options_of_derive = {
    .head =
        "  --header FILE, with --as c: its header, for C and C++: names of components, inputs and outputs,\n"
        "               their units, the memory that it takes\n"
        "  --name NAME, with --as c or octave: what the scene is called there, so that one program can hold\n"
        "               it twice: with and without an effect, compensated and not\n",
    .groups = OPTIONS_CHANGE | OPTIONS_ENGINE,
    .tail = "Numbers in formulas are SI. The method matters to the C form only.\n"};

static void print_usage(FILE *out) {
    options_usage(out, &usage);
    for (int i = 0; i < FORMS; i++) {
        fprintf(out, "  --as %-8s%s\n", forms[i].word, forms[i].text);
    }
    options_usage(out, &options_of_derive);
}

/* The files that --header must not be, which are read and written at the same time. */
static bool header_is_apart(const source_model *from, const char *header) {
    struct stat about_output;
    struct stat about_header;
    if (strcmp(header, "-") == 0 || header[0] == '\0') {
        fputs("whirl derive: error: --header takes a file: standard output has the C\n", stderr);
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

static bool write_header(const image *im, const char *file, const char *header) {
    FILE *out = fopen(header, "w");
    bool written = out != NULL;
    if (written) {
        emit_c_header(out, im, file);
        written = fflush(out) == 0 && ferror(out) == 0;
    }
    if (!written) {
        fprintf(stderr, "%s: error: cannot be written: %s\n", header, strerror(errno));
    }
    if (out != NULL) {
        fclose(out);
    }
    return written;
}

/* Can code of that form have the scene's name? Else it is said why. */
static bool has_name(const image *im, const source_model *from, const form_row *as,
                     const char *header) {
    const char *taken_by = NULL;
    if (!as->runs) {
        taken_by = emit_octave_name_is_free(im->name) ? NULL : "a word of Octave or Matlab";
    } else if (!emit_c_name_is_free(im->name)) {
        taken_by = "a word of C, of its library or of the core";
    } else if (header != NULL && !emit_c_name_is_free_in_cpp(im->name)) {
        taken_by = "a word of C++";
    }
    if (taken_by != NULL) {
        fprintf(stderr,
                "%s: error: '%s' is %s: the generated scene cannot have that name\n"
                "hint: rename it, or give it another for this: --name NAME\n",
                from->file, im->name, taken_by);
    }
    return taken_by == NULL;
}

/* Can this be C for the core? Else it is said why. */
static bool has_c_form(const image *im, source_model *from) {
    const bool has = start_angles_are_held(im, from->errors) &&
                     start_has_method(im, im->settings.method, from->errors);
    if (!has) {
        diags_flush(from->errors, stderr);
    }
    return has;
}

static int derive_one(source_model *from, const mechanism *of, const scene *in,
                      const overrides *changes, const form_row *as, const image_settings *settings,
                      const char *header) {
    const load_wish wish = {.settings = *settings,
                            .use = IMAGE_TO_WRITE,
                            .keep = as->shows ? KEEP_EQUATIONS : KEEP_IMAGE,
                            .conserve = as->runs,
                            .contacts = as->tells_contacts};
    loaded made;
    int code = load(&made, from, of, in, changes, &wish);
    if (!as->shows) {
        source_forget(from);
    }
    if (code == EXIT_DONE && ((as->named && !has_name(made.image, from, as, header)) ||
                              (as->runs && !has_c_form(made.image, from)) ||
                              (header != NULL && !write_header(made.image, from->file, header)))) {
        code = EXIT_BAD_INPUT;
    }
    if (code == EXIT_DONE) {
        say_hints(&made);
        if (as->runs) {
            say_float_range(made.image);
        }
        as->print(&made, from->file);
    }
    unload(&made);
    return code;
}

/* The scene's name in generated code: as a name in a .whirl file. */
static bool take_name(change_options *options, const char *name) {
    static const char letters[] = "_ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789";
    const size_t length = strlen(name);
    if (options->name != NULL) {
        fputs("whirl derive: error: --name is given twice\n", stderr);
        return false;
    }
    if (length == 0 || length > NAME_LENGTH_MAX || strspn(name, letters) != length ||
        (name[0] >= '0' && name[0] <= '9')) {
        fprintf(stderr,
                "whirl derive: error: --name '%.70s' is no name\n"
                "hint: letters, digits and _, no digit first, at most %d of them\n",
                name, NAME_LENGTH_MAX);
        return false;
    }
    options->name = name;
    return true;
}

int command_derive(int count, char **words) {
    const char *target = NULL;
    const char *header = NULL;
    const form_row *as = &forms[0];
    change_options options = {0};
    image_settings settings = {WH_METHOD_DEFAULT, false};
    bool bad = false;
    if (options_wants_help(count, words)) {
        print_usage(stdout);
        return EXIT_DONE;
    }
    for (int at = 0; at < count && !bad;) {
        const char *value = options_value(count, words, &at, "--as", &bad);
        if (value != NULL) {
            const int chosen =
                options_choose("derive", "form", value, forms, sizeof forms[0], FORMS);
            bad = chosen < 0;
            as = bad ? as : &forms[chosen];
        } else if (!bad && (value = options_value(count, words, &at, "--header", &bad)) != NULL) {
            if (header != NULL) {
                fputs("whirl derive: error: --header is given twice\n", stderr);
                bad = true;
            }
            header = value;
        } else if (!bad && (value = options_value(count, words, &at, "--name", &bad)) != NULL) {
            bad = !take_name(&options, value);
        } else if (!bad && !options_change(count, words, &at, &options, &bad) && !bad &&
                   !options_engine("derive", count, words, &at, &settings, &bad) && !bad) {
            if (words[at][0] == '-' && words[at][1] != '\0') {
                options_unknown("derive", words[at], options_of_derive.groups,
                                (const char *const[]){"--as", "--header", "--name", NULL});
                bad = true;
            } else if (target != NULL) {
                fprintf(stderr, "whirl derive: error: more than one thing to derive: %s\n",
                        words[at]);
                bad = true;
            } else {
                target = words[at++];
            }
        }
    }
    if (!bad && header != NULL && !as->runs) {
        fputs("whirl derive: error: --header goes with the C form\nhint: --as c --header FILE\n",
              stderr);
        bad = true;
    }
    if (!bad && options.name != NULL && !as->named) {
        fputs("whirl derive: error: --name goes with the C form and Octave's\n", stderr);
        bad = true;
    }
    if (bad || target == NULL) {
        if (!bad) {
            print_usage(stderr);
        }
        change_options_free(&options);
        return EXIT_BAD_INPUT;
    }
    source_model from;
    int code = source_open(&from, target);
    const overrides changes = change_options_overrides(&options);
    if (code == EXIT_DONE && from.name[0] == '\0' && as->shows) {
        for (int i = 0; i < from.model->mechanism_count && code == EXIT_DONE; i++) {
            if (i > 0) {
                putchar('\n');
            }
            code =
                derive_one(&from, from.model->mechanisms[i], NULL, &changes, as, &settings, NULL);
        }
    } else if (code == EXIT_DONE) {
        const mechanism *of;
        const scene *in;
        /* the file's only scene; of several, none is meant: the mechanism */
        code = source_pick(&from, from.model->scene_count == 1, &of, &in);
        if (code == EXIT_DONE) {
            code = header != NULL && !header_is_apart(&from, header)
                       ? EXIT_BAD_INPUT
                       : derive_one(&from, of, in, &changes, as, &settings, header);
        }
    }
    source_close(&from);
    change_options_free(&options);
    return code;
}

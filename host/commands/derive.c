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
#include "host/show/text.h"
#include "load.h"
#include "options.h"

static const char usage[] =
    "usage: whirl derive FILE[:NAME]|SCENE|MECHANISM[:SCENE] [--as text|latex|octave|c]\n"
    "                    [--with E,...] [--without E,...] [--set NAME=EXPR] [--start NAME=EXPR]\n"
    "                    [--step 1ms] [--until 9s] [--method M] [--compensated]\n"
    "                    [--name NAME] [--header FILE]\n"
    "\n"
    "Prints the equations of motion of a mechanism (or of a scene, with its effects), of a FILE or\n"
    "built in (`whirl list`):\n"
    "  --as text    one equation a coordinate, as in a textbook, and the first-order form (default)\n"
    "  --as latex   the same for a paper (with amsmath)\n"
    "  --as octave  a function file that Octave and Matlab integrate as it stands\n"
    "  --as c       the scene as C for the core\n"
    "  --header FILE, with --as c: its header, for C and C++: names of components, inputs and outputs,\n"
    "               their units, the memory that it takes\n"
    "  --name NAME, with --as c or octave: what the scene is called there, so that one program can hold\n"
    "               it twice: with and without an effect, compensated and not\n"
    "Numbers in formulas are SI. The other options are those of `whirl run`; the method matters to the C form only.\n";

typedef enum form { FORM_TEXT, FORM_LATEX, FORM_OCTAVE, FORM_C, FORMS } form;
static const char *const form_names[FORMS] = {"text", "latex", "octave", "c"};

static void print(form as, const loaded *made, const char *file) {
    switch (as) {
    case FORM_TEXT: show_text(stdout, made->equations); break;
    case FORM_LATEX: show_latex(stdout, made->equations); break;
    case FORM_OCTAVE: emit_octave(stdout, made->image, file, made->contacts); break;
    case FORM_C: emit_c(stdout, made->image, file); break;
    case FORMS: break;
    }
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

/* Can this be C for the core? Else it is said why. */
static bool has_c_form(const image *im, source_model *from, const char *header) {
    if (!start_angles_are_held(im, from->errors)) {
        diags_flush(from->errors, stderr);
        return false;
    }
    if (!emit_c_name_is_free(im->name) ||
        (header != NULL && !emit_c_name_is_free_in_cpp(im->name))) {
        fprintf(stderr,
                "%s: error: '%s' is a word of C%s or of the core: the generated scene cannot "
                "have that name\nhint: rename it, or give it another for this: --name NAME\n",
                from->file, im->name, emit_c_name_is_free(im->name) ? "++" : "");
        return false;
    }
    if (!start_has_method(im, im->settings.method, from->errors)) {
        diags_flush(from->errors, stderr);
        return false;
    }
    return true;
}

static int derive_one(source_model *from, const mechanism *of, const scene *in,
                      const overrides *changes, form as, const image_settings *settings,
                      const char *header) {
    const bool by_equations = as == FORM_TEXT || as == FORM_LATEX;
    const load_wish wish = {.settings = *settings,
                            .use = IMAGE_TO_WRITE,
                            .keep = by_equations ? KEEP_EQUATIONS : KEEP_IMAGE,
                            .conserve = as == FORM_C,
                            .contacts = as == FORM_OCTAVE};
    loaded made;
    int code = load(&made, from, of, in, changes, &wish);
    if (!by_equations) {
        source_forget(from);
    }
    if (code == EXIT_DONE && as == FORM_C &&
        (!has_c_form(made.image, from, header) ||
         (header != NULL && !write_header(made.image, from->file, header)))) {
        code = EXIT_BAD_INPUT;
    }
    if (code == EXIT_DONE) {
        say_hints(&made);
        if (as == FORM_C) {
            say_float_range(made.image);
        }
        print(as, &made, from->file);
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
    form as = FORM_TEXT;
    change_options options = {0};
    image_settings settings = {WH_RK4, false};
    bool bad = false;
    if (options_help(count, words, usage)) {
        return EXIT_DONE;
    }
    for (int at = 0; at < count && !bad;) {
        const char *value = options_value(count, words, &at, "--as", &bad);
        if (value != NULL) {
            as = FORM_TEXT;
            while (as < FORMS && strcmp(form_names[as], value) != 0) {
                as++;
            }
            if (as == FORMS) {
                fprintf(stderr,
                        "whirl derive: error: there is no form '%s'\n"
                        "hint: text, latex, octave or c\n",
                        value);
                bad = true;
            }
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
                options_unknown("derive", words[at],
                                (const char *const[]){"--as", "--header", "--name", CHANGE_OPTIONS,
                                                      ENGINE_OPTIONS, "--help", NULL});
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
    if (!bad && header != NULL && as != FORM_C) {
        fputs("whirl derive: error: --header goes with the C form\nhint: --as c --header FILE\n",
              stderr);
        bad = true;
    }
    if (!bad && options.name != NULL && as != FORM_C && as != FORM_OCTAVE) {
        fputs("whirl derive: error: --name goes with the C form and Octave's\n", stderr);
        bad = true;
    }
    if (bad || target == NULL) {
        if (!bad) {
            fputs(usage, stderr);
        }
        change_options_free(&options);
        return EXIT_BAD_INPUT;
    }
    source_model from;
    int code = source_open(&from, target);
    const overrides changes = change_options_overrides(&options);
    if (code == EXIT_DONE && from.name[0] == '\0' && (as == FORM_TEXT || as == FORM_LATEX)) {
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

/* describe.c: `whirl describe`, `whirl check` and `whirl accel`: answers about a model, without a run. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/check/nonfinite.h"
#include "host/check/step_doubling.h"
#include "host/cli/commands.h"
#include "host/cli/load.h"
#include "host/cli/options.h"
#include "host/emit/emit.h"
#include "host/engine/engine.h"
#include "host/number/functions.h"

typedef struct words_of {
    char **word; /* [count] */
    int count;
} words_of;

static int words_command(const char *command, const command_usage *usage, int count, char **words,
                         int (*work)(void *all)) {
    words_of all = {.word = words};
    const char *last;
    const target_reader reader = {
        .command = command, .usage = usage, .many = words, .many_count = &all.count, .work = work};
    return target_command(&reader, count, words, NULL, &all, &last);
}

/* === whirl accel ============================================================================== */

static const command_usage accel_usage = {
    .head =
        "usage: whirl accel FILE[:NAME]|SCENE|MECHANISM[:SCENE] [NAME=VALUE ...]\n"
        "\n"
        "Prints the accelerations at one state, one per line, in SI with 17 significant digits.\n"
        "\n"
        "  whirl accel core/models/epicyclic.whirl theta=0.3 \"theta'=1.2\" M=1.5\n"
        "\n"
        "Coordinates, rates, inputs and parameters may be set, each once. A value is SI, or has a unit:\n"
        "\"theta'=330 [rpm]\". A bare number is refused if the declared unit is not SI. Without a value, a\n"
        "state is 0, and an input or parameter has its declared value. A scene includes its effects and\n"
        "their parameters.\n",
    .why = {"", "an acceleration is not finite, or may be wrong; the message says which", ""}};

/* Reports the expression that is not finite at this state. */
static void tell_undefined(const image *im, const char *file) {
    diags *errors = diags_new();
    const nonfinite_at at = {
        .image = im, .angle_rad = im->start_rad, .real = im->start_real, .when = "at this state"};
    if (!nonfinite_term(&at, errors)) {
        fprintf(stderr,
                "%s: error: at this state the accelerations of '%s' are not finite numbers\n"
                "hint: check for a singular position, where an inertia vanishes\n",
                file, im->name);
    }
    diags_flush(errors, stderr);
    diags_free(errors);
}

static int print_image(const image *im, const char *file) {
    const state_list books = state_list_open(im, IMAGE_BOOKS);
    const double *result = state_list_at(&books, im->start_rad, im->start_real);
    bool finite = true;
    for (int i = 0; i < im->count; i++) {
        finite = finite && isfinite(result[i]);
    }
    for (int i = 0; i < im->count && finite; i++) {
        printf("%s%.*s = %.17g\n", im->unknown[i].name, im->unknown[i].order, "''''''''''",
               number_shown(result[i]));
    }
    int worst;
    const double doubt = accelerations_doubt(im, im->start_rad, im->start_real, &worst);
    if (!finite) {
        tell_undefined(im, file);
    } else if (doubt > ACCELERATIONS_DOUBT) {
        fprintf(
            stderr,
            "%s: warning: %s%.*s may be wrong by %.2g of its value, because the equations add numbers of "
            "very different sizes\n" ACCELERATIONS_HINT,
            file, im->unknown[worst].name, im->unknown[worst].order, "''''''''''", doubt);
    }
    state_list_close(&books);
    return finite && !(doubt > ACCELERATIONS_DOUBT) ? EXIT_DONE : EXIT_RUN_FAILED;
}

static int accel_work(void *all) {
    const words_of *words = all;
    source_model from;
    const mechanism *of;
    const scene *in;
    int code = source_open(&from, words->word[0]);
    if (code == EXIT_DONE) {
        code = source_pick(&from, false, &of, &in);
    }
    if (code == EXIT_DONE) {
        const overrides changes = {.values = (const char *const *)(words->word + 1),
                                   .value_count = words->count - 1};
        loaded made;
        const load_request request = {.settings = IMAGE_SETTINGS_DEFAULT, .use = IMAGE_TO_RUN};
        code = load(&made, &from, of, in, &changes, &request);
        if (code == EXIT_DONE) {
            code = print_image(made.image, from.file);
        }
        unload(&made);
    }
    source_close(&from);
    return code;
}

int command_accel(int count, char **words) {
    return words_command("accel", &accel_usage, count, words, accel_work);
}

/* === whirl check ============================================================================== */

static const command_usage check_usage = {
    .head =
        "usage: whirl check FILE|MECHANISM ...\n"
        "\n"
        "Reads each FILE, derives its mechanisms and scenes, and checks that each scene can start. Errors\n"
        "go to standard error as FILE:LINE:COLUMN: error: TEXT, which editors understand.\n",
    .why = {"no error was found", NULL, "a file has an error, or cannot be read"}};

static int derive_one(source_model *from, const mechanism *of, const scene *in) {
    const load_request request = {IMAGE_SETTINGS_DEFAULT, IMAGE_TO_RUN, .hints = in == NULL,
                                  .conserve = true};
    loaded made;
    const int code = load(&made, from, of, in, NULL, &request);
    const bool can = code != EXIT_DONE || in == NULL ||
                     image_can_start(made.image, &engine_double, from->errors);
    unload(&made);
    return can ? code : EXIT_BAD_INPUT;
}

static int derive_all(source_model *from) {
    const whirl_model *m = from->model;
    int code = EXIT_DONE;
    for (int i = 0; i < m->mechanism_count; i++) {
        const int of = derive_one(from, m->mechanisms[i], NULL);
        /* the scenes of a mechanism with an error would repeat the error */
        for (int k = 0; k < m->scene_count && of == EXIT_DONE; k++) {
            if (m->scenes[k]->mechanism == m->mechanisms[i]) {
                const int one = derive_one(from, m->mechanisms[i], m->scenes[k]);
                code = one > code ? one : code;
            }
        }
        code = of > code ? of : code;
    }
    return code;
}

static int check_one(const char *file) {
    source_model from;
    int code = source_open(&from, file);
    if (code == EXIT_DONE && from.name[0] != '\0' && from.path != NULL) {
        fprintf(stderr,
                "whirl check: error: %s is a part of a file, but whirl check reads whole "
                "files\nhint: whirl check %s\n",
                file, from.path);
        code = EXIT_BAD_INPUT;
    } else if (code == EXIT_DONE) {
        code = derive_all(&from);
    }
    if (code == EXIT_DONE) {
        printf("%s: no errors; mechanisms: %d, scenes: %d\n", from.file,
               from.model->mechanism_count, from.model->scene_count);
    }
    source_close(&from);
    return code;
}

static int check_work(void *all) {
    const words_of *files = all;
    int code = EXIT_DONE;
    for (int i = 0; i < files->count; i++) {
        const int one = check_one(files->word[i]);
        code = one > code ? one : code;
    }
    return code;
}

int command_check(int count, char **words) {
    return words_command("check", &check_usage, count, words, check_work);
}

/* === whirl describe =========================================================================== */

static const command_usage usage = {
    .head =
        "usage: whirl describe FILE[:NAME]|SCENE|MECHANISM[:SCENE] [--json] [options]\n"
        "\n"
        "Prints what a scene contains: names, units, indices, start values, step, method, contacts, ledger,\n"
        "memory, costs and the hash of the model. Values are SI.\n"
        "\n"
        "  --json               one JSON object instead, for programs (docs/describe.md)\n",
    .groups = OPTIONS_CHANGE | OPTIONS_STEP | OPTIONS_ENGINE};

typedef struct describe_options {
    common_options common;
    const char *target;
    bool as_json;
} describe_options;

static int describe_source(source_model *from, void *options) {
    const describe_options *o = options;
    loaded made;
    const int code =
        target_load(&made, from, &o->common,
                    (load_request){.use = IMAGE_TO_WRITE, .scene = true, .conserve = true});
    if (code == EXIT_DONE && o->as_json) {
        describe_json(stdout, made.image, from->file);
    } else if (code == EXIT_DONE) {
        describe_text(stdout, made.image, from->file);
    }
    unload(&made);
    return code;
}

int command_describe(int count, char **words) {
    describe_options o = {.common = options_defaults()};
    const own_option own[] = {{.word = "--json", .flag = &o.as_json}, {.word = NULL}};
    const target_reader reader = {.command = "describe",
                                  .usage = &usage,
                                  .table = own,
                                  .one = "scene or mechanism",
                                  .work_on = describe_source};
    return target_command(&reader, count, words, &o.common, &o, &o.target);
}

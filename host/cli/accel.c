/* accel.c: `whirl accel`: the highest derivatives at one state, with all digits. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "commands.h"
#include "host/base/alloc.h"
#include "host/check/nonfinite.h"
#include "host/cli/load.h"
#include "host/engine/engine.h"
#include "host/number/functions.h"
#include "options.h"

static const command_usage usage = {
    .head =
        "usage: whirl accel FILE[:NAME]|SCENE|MECHANISM[:SCENE] [NAME=VALUE ...]\n"
        "\n"
        "Prints the accelerations at one state, a line each, 17 significant digits:\n"
        "    whirl accel core/models/epicyclic.whirl theta=0.3 \"theta'=1.2\" M=1.5\n"
        "Coordinates, their rates, inputs and parameters can be set, each once; values are SI, or carry\n"
        "a unit: \"theta'=330 [rpm]\". What is left out is 0, or has its declared value. The results are SI.\n"
        "SCENE and MECHANISM are built in (`whirl list`). A scene brings its effects, whose parameters can\n"
        "be set then.\n",
    .tail = "",
    .why = {[EXIT_ROW_OF(EXIT_DONE)] = "",
            [EXIT_ROW_OF(EXIT_RUN_FAILED)] =
                "they are not finite numbers there; it says which expression is not",
            [EXIT_ROW_OF(EXIT_BAD_INPUT)] = ""}};

static bool is_finite(const image *im, const double *result) {
    for (int i = 0; i < im->count; i++) {
        if (!isfinite(result[i])) {
            return false;
        }
    }
    return true;
}

static void print(const image *im, const double *result) {
    for (int i = 0; i < im->count; i++) {
        printf("%s", im->unknown[i].name);
        for (int k = 0; k < im->unknown[i].order; k++) {
            putchar('\'');
        }
        printf(" = %.17g\n", number_shown(result[i]));
    }
}

/* Report the expression that is not finite at this state. */
static void tell_undefined(const image *im, const char *file) {
    diags *errors = diags_new();
    const nonfinite_at at = {
        .image = im, .angle_rad = im->start_rad, .real = im->start_real, .when = "at this state"};
    if (!nonfinite_angle(&at, errors) && !nonfinite_term(&at, errors)) {
        fprintf(stderr,
                "%s: error: at this state the accelerations of '%s' are not finite numbers\n"
                "hint: look for a singular position: an inertia that vanishes there\n",
                file, im->name);
    }
    diags_flush(errors, stderr);
    diags_free(errors);
}

static int print_image(const image *im, const char *file) {
    const op_list *books = im->list[IMAGE_BOOKS];
    double *result = alloc(books->results, sizeof *result);
    double *input = alloc(im->inputs, sizeof *input);
    image_inputs(im, input);
    evaluator *ev = evaluator_new(books);
    evaluator_run(ev, 0.0, im->start_rad, im->start_real,
                  im->start_real + (im->coordinates - im->angles), input, result);
    evaluator_free(ev);
    const bool finite = is_finite(im, result);
    if (finite) {
        print(im, result);
    } else {
        tell_undefined(im, file);
    }
    free(result);
    free(input);
    return finite ? EXIT_DONE : EXIT_RUN_FAILED;
}

int command_accel(int count, char **words) {
    if (options_help(count, words, &usage)) {
        return EXIT_DONE;
    }
    if (count < 1) {
        options_usage(stderr, &usage);
        return EXIT_BAD_INPUT;
    }
    for (int i = 0; i < count; i++) {
        if (words[i][0] == '-' && words[i][1] != '\0') {
            options_unknown("accel", words[i], 0, (const char *const[]){NULL});
            return EXIT_BAD_INPUT;
        }
    }
    source_model from;
    const mechanism *of;
    const scene *in;
    int code = source_open(&from, words[0]);
    if (code == EXIT_DONE) {
        code = source_pick(&from, false, &of, &in);
    }
    if (code == EXIT_DONE) {
        const overrides changes = {.values = (const char *const *)(words + 1),
                                   .value_count = count - 1};
        loaded made;
        const load_wish wish = {.settings = IMAGE_SETTINGS_DEFAULT, .use = IMAGE_TO_RUN};
        code = load(&made, &from, of, in, &changes, &wish);
        source_forget(&from);
        if (code == EXIT_DONE) {
            code = print_image(made.image, from.file);
        }
        unload(&made);
    }
    source_close(&from);
    return code;
}

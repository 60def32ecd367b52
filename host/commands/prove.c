/* prove.c: `whirl prove`: until when a run is proved to be within a tolerance of the exact motion. */
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "commands.h"
#include "host/base/arena.h"
#include "host/base/room.h"
#include "host/lang/override.h"
#include "host/lang/value.h"
#include "host/number/decimal.h"
#include "host/prove/held_text.h"
#include "host/run/start.h"
#include "load.h"
#include "options.h"

static const command_usage usage = {
    .head =
        "usage: whirl prove SCENE|MECHANISM[:SCENE]|FILE[:SCENE] [options]\n"
        "\n"
        "Until when each coordinate and rate of a run is within a tolerance of the exact motion, proved:\n"
        "a tube in which the exact motion lies is computed from the energies, with parameters as the\n"
        "decimals that are written, in intervals that are rounded outwards, and every step's end of the\n"
        "run is held against it. For smooth scenes: no stops, holds, dry friction or whens. The options\n"
        "are those of `whirl run`, and tell the run that is asked about.\n"
        "\n",
    .groups = OPTIONS_CHANGE | OPTIONS_STEP | OPTIONS_ENGINE | OPTIONS_NUMBER,
    .tail =
        "  --within X=1mm       what a coordinate or rate is to be within (repeatable, each name once)\n"
        "  --tolerance 1e-3     of the others: part of the range that each has in the run (default: 1e-3)\n",
    .why = {[EXIT_ROW_OF(EXIT_DONE)] = "",
            [EXIT_ROW_OF(EXIT_RUN_FAILED)] = "the run diverged: what is proved before that is told",
            [EXIT_ROW_OF(EXIT_BAD_INPUT)] = "",
            [EXIT_ROW_OF(EXIT_INTERRUPTED)] = ""}};

static volatile sig_atomic_t interrupted;

static void on_interrupt(int signal_number) {
    (void)signal_number;
    interrupted = 1;
}

enum { WITHIN_MOST = 64 };

typedef struct prove_options {
    common_options common;
    const char *target;
    const char *within[WITHIN_MOST];
    int within_count;
    double tolerance;
} prove_options;

static bool read_tolerance(const char *text, double *number) {
    const char *end = text;
    *number = decimal_read(text, &end);
    const bool good = end != text && *end == '\0' && *number >= 1e-15 && *number <= 1.0;
    if (!good) {
        fprintf(stderr,
                "whirl prove: error: --tolerance takes a number from 1e-15 to 1, not '%.40s'\n"
                "hint: a part of the range that a coordinate has: --tolerance 1e-3\n",
                text);
    }
    return good;
}

static bool read_options(int count, char **words, prove_options *o) {
    bool bad = false;
    for (int at = 0; at < count && !bad;) {
        const char *value;
        if (options_take("prove", usage.groups, count, words, &at, &o->common, &bad) || bad) {
            continue;
        }
        if (strcmp(words[at], "--within") == 0 && at + 1 < count && o->within_count < WITHIN_MOST) {
            o->within[o->within_count++] = words[at + 1];
            at += 2;
        } else if ((value = options_value(count, words, &at, "--tolerance", &bad)) != NULL || bad) {
            bad = bad || !read_tolerance(value, &o->tolerance);
        } else if (words[at][0] == '-' && words[at][1] != '\0') {
            options_unknown("prove", words[at], usage.groups,
                            (const char *const[]){"--within", "--tolerance", NULL});
            return false;
        } else if (o->target != NULL) {
            fprintf(stderr, "whirl prove: error: one scene at a time, not also '%s'\n", words[at]);
            return false;
        } else {
            o->target = words[at++];
        }
    }
    if (!bad && o->target == NULL) {
        options_usage(stderr, &usage);
        return false;
    }
    return !bad;
}

/* within[states]: SI, 0 where nothing was said. False: reported. */
static bool read_within(const prove_options *o, const mechanism *of, const exact_motion *m,
                        double *within, diags *errors) {
    struct arena *memory = arena_new();
    const size_t before = diags_calls(errors);
    for (int i = 0; i < o->within_count; i++) {
        assignment a;
        if (!override_parse(of, OVERRIDE_START, o->within[i], memory, errors, &a)) {
            continue;
        }
        const double value = expr_value(a.value, NULL);
        if (!isfinite(value) || !(value > 0.0)) {
            diag_error(errors, a.at, "--within X=1mm", "a number above zero is wanted");
        }
        for (int s = 0; s < m->states; s++) {
            if (m->state[s].unknown == a.symbol->index && m->state[s].primes == a.primes) {
                if (within[s] > 0.0) {
                    diag_error(errors, a.at, "once is enough: leave one of them out",
                               "'%s%.*s' is given twice on the command line", a.symbol->name,
                               a.primes, "'''''''''");
                }
                within[s] = value;
            }
        }
    }
    arena_free(memory);
    return diags_calls(errors) == before;
}

static int answer(const prove_options *o, const image *im, const exact_motion *m,
                  const double *within) {
    struct sigaction action = {.sa_handler = on_interrupt,
                               .sa_flags = SA_RESTART | (int)SA_RESETHAND};
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    const held_wish wish = {.motion = m,
                            .image = im,
                            .kind = o->common.number,
                            .tolerance = o->tolerance,
                            .within = within,
                            .stop = &interrupted};
    held h = held_run(&wish);
    int code = EXIT_DONE;
    if (h.stopped) {
        fprintf(stderr, "whirl prove: interrupted, the tube being at t = %.9g s\n", h.tube_s);
        code = EXIT_INTERRUPTED;
    } else {
        held_print(stdout, &h, &wish);
        if (h.status != WH_OK) {
            fprintf(stderr,
                    "whirl prove: error: the run diverged in the step after t = %.9g s\n"
                    "hint: a smaller --step may carry it further\n",
                    ratio_times(h.run_steps, im->step));
            code = EXIT_RUN_FAILED;
        }
    }
    held_free(&h);
    return code;
}

static int prove_loaded(const prove_options *o, const loaded *made, const mechanism *of,
                        diags *errors) {
    const image *im = made->image;
    exact_motion *m = NULL;
    if (start_has_method(im, im->settings.method, errors) &&
        start_is_possible(im, o->common.number, errors)) {
        m = exact_motion_make(made->instance, errors);
    }
    int code = EXIT_BAD_INPUT;
    if (m != NULL) {
        double *within = room(m->states, sizeof *within);
        const bool good = read_within(o, of, m, within, errors);
        diags_flush(errors, stderr);
        code = good ? answer(o, im, m, within) : EXIT_BAD_INPUT;
        free(within);
    }
    diags_flush(errors, stderr);
    exact_motion_free(m);
    return code;
}

static int prove_source(const prove_options *o, source_model *from) {
    const mechanism *of;
    const scene *in;
    int code = source_open(from, o->target);
    code = code == EXIT_DONE ? source_pick(from, true, &of, &in) : code;
    if (code != EXIT_DONE) {
        return code;
    }
    const overrides changes = options_overrides(&o->common.change);
    const load_wish wish = {.settings = o->common.integration,
                            .use = IMAGE_TO_RUN,
                            .keep = KEEP_INSTANCE,
                            .conserve = true};
    loaded made;
    code = load(&made, from, of, in, &changes, &wish);
    code = code == EXIT_DONE ? prove_loaded(o, &made, of, from->errors) : code;
    unload(&made);
    return code;
}

int command_prove(int count, char **words) {
    prove_options o = {.common = options_defaults(), .tolerance = HELD_TOLERANCE};
    source_model from = {0};
    if (options_help(count, words, &usage)) {
        return EXIT_DONE;
    }
    int code = EXIT_BAD_INPUT;
    if (read_options(count, words, &o)) {
        code = prove_source(&o, &from);
        source_close(&from);
    }
    options_forget(&o.common);
    return code;
}

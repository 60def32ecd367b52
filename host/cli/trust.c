/* trust.c: `whirl trust`: the time until which each coordinate of a run is within a tolerance. */
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "commands.h"
#include "host/check/apart.h"
#include "host/check/nonfinite.h"
#include "host/check/run_checks.h"
#include "host/check/run_json.h"
#include "host/cli/load.h"
#include "host/fixed/engine_fixed.h"
#include "host/fixed/fixed_plan.h"
#include "host/io/plot.h"
#include "host/number/functions.h"
#include "host/os/atomic_file.h"
#include "host/os/system.h"
#include "options.h"
#include "trusting.h"

/* Limit of operations without --effort. */
#define EFFORT 1.5e10

static const command_usage usage = {
    .head =
        "usage: whirl trust SCENE|MECHANISM[:SCENE]|FILE[:SCENE] [options]\n"
        "\n"
        "Prints the time until which each coordinate and rate of a run is accurate within a tolerance\n"
        "(docs/stability.md). It compares the run with a run of half the step, in double with compensated\n"
        "sums, and takes the first time at which they differ by more. In a chaotic motion this time comes\n"
        "soon, however small the step. After it, only energy and momenta are meaningful.\n"
        "\n",
    .groups = OPTIONS_SCENE,
    .tail =
        "  --proved             run `whirl prove` instead, with its options\n"
        "  --tolerance 1e-3     the allowed error, as a part of the range of each coordinate over the run\n"
        "                       (default: 1e-3)\n"
        "  --csv FILE           a row for each coordinate and rate: name, unit, verdict, trusted time,\n"
        "                       range, largest error. Verdicts: end, until, still (a constant "
        "value),\n                       rounding (only round-off changes it), unknown"
        " (double has too few\n"
        "                       digits). - is standard output; the report then goes to standard "
        "error.\n"
        "  --json               one JSON object on standard output instead of the report "
        "(docs/warnings.md)\n"
        "  --effort 1.5e10      operations that it may evaluate: 1.5e10 take about a minute. Whirl refuses\n"
        "                       longer work.\n"
        "  --quiet              no progress; with --csv no report\n",
    .why = {"", "the run diverged; the output has the time of divergence and the trusted time", "",
            ""}};

typedef struct trust_options {
    common_options common;
    const char *target;
    const char *csv;
    double tolerance;
    double effort;
    bool json;
    bool quiet;
} trust_options;

static bool shows_progress(const trust_options *o) { return !o->quiet && isatty(STDERR_FILENO); }

static void show_progress(double share, void *context) {
    (void)context;
    fprintf(stderr, "\r%5.1f %%", 100.0 * share);
}

static void say_failure(const image *im, const engine_kind *kind, const step_doubling *t) {
    diags *errors = diags_new();
    const bool known = nonfinite_step(im, kind, t->run, t->status, errors);
    diags_flush(errors, stderr);
    diags_free(errors);
    if (!known) {
        const int fault = kind->fault(t->run);
        const component c = image_component(im, fault < 0 ? 0 : fault);
        fprintf(stderr,
                "whirl trust: error: the run diverged in the step after t = %.9g s: %s%.*s grew "
                "without bound\nhint: try a smaller --step\n",
                t->end_s, im->unknown[c.unknown].name, c.primes, "''''''''''");
    }
}

static int write_rows(const trust_options *o, const horizon *h) {
    FILE *rows = o->csv != NULL ? atomic_file_open(o->csv) : NULL;
    if (rows != NULL) {
        horizon_write(rows, h);
    }
    return o->csv == NULL || (rows != NULL &&
                              plot_run_csv_end(rows, o->csv, true, "trust", h->of->finer.name))
               ? EXIT_DONE
               : EXIT_RUN_FAILED;
}

static int answer(const trust_options *o, const image *im) {
    const engine_kind *kind = o->common.number;
    run_checks *v = run_checks_whole(im, kind, shows_progress(o) ? show_progress : NULL, NULL);
    const step_doubling *t = v->doubling;
    if (shows_progress(o)) {
        fprintf(stderr, "\r        \r");
    }
    int code = EXIT_INTERRUPTED;
    if (v->interrupted) {
        fprintf(
            stderr,
            "whirl trust: interrupted at t = %.9g s of %.9g s: no result, because the ranges of "
            "the coordinates need the whole run\n",
            t->end_s, ratio_times(im->steps, im->step));
    } else {
        horizon h = horizon_of(t, o->tolerance);
        code = write_rows(o, &h);
        if (!o->json && (!o->quiet || o->csv == NULL)) {
            horizon_print(options_is_standard(o->csv) ? stderr : stdout, &h, v->books, &v->balance);
        }
        if (t->status != WH_OK) {
            say_failure(im, kind, t);
            code = code == EXIT_DONE ? EXIT_RUN_FAILED : code;
        }
        if (o->json) {
            horizon_json(stdout, &h, code);
        }
        horizon_free(&h);
    }
    run_checks_close(v);
    return code;
}

static int trust_loaded(const trust_options *o, image *im, diags *errors) {
    fixed_plan *plan = NULL;
    if (!effort_suffices("trust", o->effort, step_doubling_operations(im),
                         "use an earlier --until, or a longer --step: a chaotic motion loses its "
                         "accuracy early anyway",
                         "two runs of %.3g and %.3g steps", (double)im->steps,
                         2.0 * (double)im->steps) ||
        !image_can_start(im, o->common.number, errors)) {
        return EXIT_BAD_INPUT;
    }
    apart_say(stderr, "whirl trust", im);
    interrupts_catch();
    int code = EXIT_DONE;
    if (o->common.number == &engine_fixed) {
        code = trusting_plan("trust", im, shows_progress(o), errors, &plan);
    }
    if (code == EXIT_DONE) {
        code = answer(o, im);
    }
    fixed_plan_free(plan);
    return code;
}

static int trust_source(source_model *from, void *options) {
    trust_options *o = options;
    loaded made;
    if (!options_json_is_alone("trust", o->json, o->csv)) {
        return EXIT_BAD_INPUT;
    }
    o->common.changes.balance = true;
    int code = target_load(&made, from, &o->common,
                           (load_request){.use = IMAGE_TO_CHECK, .scene = true, .conserve = true});
    if (code == EXIT_DONE && o->common.number == &engine_float) {
        say_float_range(made.image);
    }
    if (code == EXIT_DONE) {
        code = trust_loaded(o, made.image, from->errors);
    }
    unload(&made);
    return code;
}

/* Removes the word --proved. Returns false if there is none. */
static bool take_proved(int *count, char **words) {
    for (int i = 0; i < *count; i++) {
        if (strcmp(words[i], "--proved") == 0) {
            --*count;
            memmove(&words[i], &words[i + 1], (size_t)(*count - i) * sizeof *words);
            return true;
        }
    }
    return false;
}

int command_trust(int count, char **words) {
    if (take_proved(&count, words)) {
        return command_prove(count, words);
    }
    trust_options o = {
        .common = options_defaults(), .tolerance = HORIZON_TOLERANCE, .effort = EFFORT};
    bool proved; /* never read: its row is for the hint "did you mean --proved?" */
    const own_option own[] = {OWN_TOLERANCE(o.tolerance),
                              OWN_EFFORT(o.effort, "1.5e11"),
                              {.word = "--csv", .text = &o.csv, .file = FILE_WRITTEN_LATE},
                              {.word = "--json", .flag = &o.json},
                              {.word = "--proved", .flag = &proved},
                              {.word = "--quiet", .flag = &o.quiet},
                              {.word = NULL}};
    const target_reader reader = {
        .command = "trust", .usage = &usage, .table = own, .work_on = trust_source};
    return target_command(&reader, count, words, &o.common, &o, &o.target);
}

/* prove.c: `whirl prove`: the time until which a run is proved to be within a tolerance of the exact motion. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "commands.h"
#include "host/base/alloc.h"
#include "host/cli/load.h"
#include "host/io/plot.h"
#include "host/lang/override.h"
#include "host/lang/value.h"
#include "host/number/functions.h"
#include "host/os/atomic_file.h"
#include "host/os/system.h"
#include "host/prove/containment.h"
#include "options.h"
#include "trusting.h"

/* EFFORT: limit of operations without --effort. PRODUCTS_1S: products of enclosures per second. */
#define EFFORT 1.5e10
#define PRODUCTS_1S 1e8

static const command_usage usage = {
    .head =
        "usage: whirl prove SCENE|MECHANISM[:SCENE]|FILE[:SCENE] [options]\n"
        "\n"
        "Proves the time until which each coordinate and rate of a run is within a tolerance of the exact\n"
        "motion (docs/stability.md). It encloses the exact motion in a flowpipe, computed from the energies\n"
        "in intervals that are rounded outwards. Parameters have the exact decimal values of the file. It\n"
        "compares the end of every step with this enclosure. The scene must be smooth, without stops, holds,\n"
        "dry friction or crossings. --number fixed is not possible.\n"
        "\n",
    .groups = OPTIONS_SCENE,
    .tail =
        "  --within X=1mm       allowed distance of X from the exact motion (repeatable, each name once)\n"
        "  --tolerance 1e-3     allowed distance of the others, as a part of the range of each over the run\n"
        "                       (default: 1e-3)\n"
        "  --csv FILE           a row for each step, in SI: the time, and for each coordinate and rate\n"
        "                       bounds below and above the exact motion, then the run's value. "
        "- is\n                       standard output; the report then goes to standard error.\n"
        "  --effort 1.5e10      operations that it may evaluate: 1.5e10 take about a minute. After that it\n"
        "                       prints the proof so far.\n"
        "  --quiet              no progress; with --csv no report\n",
    .why = {"the run did not fail, but the proof may end before it",
            "the run diverged; Whirl printed the proof so far", "", "the proof so far is printed"}};

typedef struct prove_options {
    common_options common;
    const char *target;
    const char **within; /* [within_count] */
    int within_count;
    const char *csv;
    double tolerance;
    double effort;
    bool quiet;
} prove_options;

/* Fills within[states], SI; 0 for a state without --within. Returns false after an error (reported). */
static bool read_within(const prove_options *o, const mechanism *of, const exact_motion *m,
                        double *within, diags *errors) {
    struct arena *memory = arena_new();
    const size_t before = diags_calls(errors);
    for (int i = 0; i < o->within_count; i++) {
        assignment a;
        if (!override_parse(of, OVERRIDE_START, o->within[i], NULL, memory, errors, &a)) {
            continue;
        }
        const double value = expr_value(a.value, NULL);
        if (!isfinite(value) || !(value > 0.0)) {
            diag_error(errors, a.at, "--within X=1mm", "give a number above zero");
        }
        for (int s = 0; s < m->states; s++) {
            if (m->state[s].unknown == a.symbol->index && m->state[s].primes == a.primes) {
                if (within[s] > 0.0) {
                    diag_error(errors, a.at, "leave one of them out",
                               "'%s%.*s' is given twice on the command line", a.symbol->name,
                               a.primes, "'''''''''");
                }
                within[s] = enclosure_below(value); /* `value` may be rounded up */
            }
        }
    }
    arena_free(memory);
    return diags_calls(errors) == before;
}

static void show_progress(double share) { fprintf(stderr, "\r%5.1f %%", 100.0 * share); }

typedef struct rows {
    FILE *file; /* NULL: no rows */
    const containment_request *request;
} rows;

static void write_row(void *context, uint64_t step, const enclosure *exact, const double *run) {
    const rows *r = context;
    containment_row(r->file, r->request, step, exact, run);
}

/* Prints why the tube ended early. */
static void say_end(const containment_found *h, double end_s) {
    switch (h->end) {
    case CONTAINMENT_AT_END:
    case CONTAINMENT_RUN_ENDS: break;
    case CONTAINMENT_NO_STEP:
        fprintf(stderr,
                "whirl prove: the proof ends at t = %.15g s: Whirl cannot enclose the exact motion "
                "after that\n",
                h->tube_s);
        break;
    case CONTAINMENT_SPENT:
        fprintf(
            stderr,
            "whirl prove: the effort is used up at t = %.15g s of %.15g s\nhint: use a larger --effort\n",
            h->tube_s, end_s);
        break;
    case CONTAINMENT_STOPPED:
        if (h->ranged) {
            fprintf(stderr, "whirl prove: interrupted at t = %.15g s of %.15g s\n", h->tube_s,
                    end_s);
        } else {
            fputs("whirl prove: interrupted in the first run, which measures the range of each "
                  "coordinate: nothing is proved yet\n",
                  stderr);
        }
        break;
    }
}

static int held_out(const prove_options *o, const containment_request *w, const rows *r) {
    containment_found h = containment_run(w);
    if (w->progress != NULL) {
        fprintf(stderr, "\r        \r");
    }
    if (h.ranged && (!o->quiet || o->csv == NULL)) {
        containment_print(options_is_standard(o->csv) ? stderr : stdout, &h, w);
    }
    say_end(&h, ratio_times(w->image->steps, w->image->step));
    if (h.status != WH_OK) {
        fprintf(
            stderr,
            "whirl prove: error: the run diverged in the step after t = %.15g s\nhint: try a smaller --step\n",
            ratio_times(h.run_steps, w->image->step));
    }
    const int code = h.end == CONTAINMENT_STOPPED ? EXIT_INTERRUPTED
                     : h.status == WH_OK          ? EXIT_DONE
                                                  : EXIT_RUN_FAILED;
    const bool good = plot_run_csv_end(r->file, o->csv, h.ranged, "prove", w->image->name);
    containment_free(&h);
    return good || code == EXIT_INTERRUPTED ? code : EXIT_RUN_FAILED;
}

static int answer(const prove_options *o, const image *im, const exact_motion *m,
                  const double *within) {
    rows r = {.file = o->csv == NULL ? NULL : atomic_file_open(o->csv)};
    if (o->csv != NULL && r.file == NULL) {
        return EXIT_BAD_INPUT;
    }
    const containment_request request = {
        .motion = m,
        .image = im,
        .kind = o->common.number,
        .tolerance = o->tolerance,
        .within = within,
        .products_most = o->effort / BUDGET_LEAST * PRODUCTS_1S,
        .see = r.file != NULL ? write_row : NULL,
        .context = &r,
        .progress = !o->quiet && isatty(STDERR_FILENO) ? show_progress : NULL};
    r.request = &request;
    if (r.file != NULL) {
        containment_rows_head(r.file, &request);
    }
    interrupts_catch();
    return held_out(o, &request, &r);
}

static int prove_loaded(const prove_options *o, const loaded *made, diags *errors) {
    const image *im = made->image;
    exact_motion *m = NULL;
    /* This limits the two runs before the proof. products_most limits the proof. */
    if (effort_suffices("prove", o->effort, step_doubling_operations(im),
                        "use an earlier --until, or a longer --step",
                        "two runs of %.3g steps, before the proof", (double)im->steps) &&
        image_can_start(im, o->common.number, errors)) {
        m = exact_motion_make(made->instance, errors);
    }
    double *within = alloc(m != NULL ? m->states : 0, sizeof *within);
    const bool good = m != NULL && read_within(o, made->instance->mechanism, m, within, errors);
    diags_flush(errors, stderr);
    const int code = good ? answer(o, im, m, within) : EXIT_BAD_INPUT;
    free(within);
    exact_motion_free(m);
    return code;
}

static int prove_source(source_model *from, void *options) {
    const prove_options *o = options;
    loaded made;
    int code = target_load(&made, from, &o->common,
                           (load_request){.use = IMAGE_TO_RUN, .scene = true, .conserve = true});
    code = code == EXIT_DONE ? prove_loaded(o, &made, from->errors) : code;
    unload(&made);
    return code;
}

int command_prove(int count, char **words) {
    prove_options o = {.common = options_defaults(),
                       .within = alloc(count, sizeof *o.within),
                       .tolerance = CONTAINMENT_TOLERANCE,
                       .effort = EFFORT};
    const own_option own[] = {{.word = "--within", .text = o.within, .count = &o.within_count},
                              OWN_TOLERANCE(o.tolerance),
                              OWN_EFFORT(o.effort, "1.5e11"),
                              {.word = "--csv", .text = &o.csv, .file = FILE_WRITTEN},
                              {.word = "--quiet", .flag = &o.quiet},
                              {.word = NULL}};
    const target_reader reader = {
        .command = "prove", .usage = &usage, .table = own, .work_on = prove_source};
    const int code = target_command(&reader, count, words, &o.common, &o, &o.target);
    free(o.within);
    return code;
}

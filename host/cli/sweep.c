/* sweep.c: `whirl sweep` and `whirl map`. A sweep runs each point of a grid, and writes a row of measures for each run.
 * A map sweeps two axes, and shows if a run stays bounded, keeps its energy and meets a tolerance. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "commands.h"
#include "host/base/alloc.h"
#include "host/check/horizon.h"
#include "host/cli/load.h"
#include "host/engine/start.h"
#include "host/io/plot.h"
#include "host/number/decimal.h"
#include "host/number/functions.h"
#include "host/os/atomic_file.h"
#include "host/os/jobs.h"
#include "host/os/system.h"
#include "host/study/grid.h"
#include "host/study/session.h"
#include "host/study/stability_map.h"
#include "options.h"
#include "trusting.h"

/* A map sweeps AXES quantities, with at most PAIRS_MOST pairs of values. */
enum { AXES = 2 };
#define PAIRS_MOST 250000
/* Limit of the operations of a map without --effort. */
#define EFFORT 1.5e11
/* Estimated operations of a step in addition to the image's lists. */
#define OPERATIONS_A_STEP 200.0

static const command_usage sweep_usage = {
    .head =
        "usage: whirl sweep SCENE|MECHANISM[:SCENE]|FILE[:SCENE] --over NAME=FROM..TO:COUNT[,log] ...\n"
        "                   [options]\n"
        "\n"
        "Runs a scene at every point of a grid, and writes a row of measures for each "
        "(docs/sweeps.md).\n"
        "\n"
        "  --over RANGE         COUNT values of a parameter, an input, a start value or the step: \"r=10..60\n"
        "                       [mm]:11\", \"theta'=1..4 [rpm]:7\", \"step=0.1..10 [ms]:9,log\". A bare number is\n"
        "                       SI. Repeatable: the grid has all combinations, the last range changes\n"
        "                       fastest.\n"
        "  --measure EXPR       the value at the end; or max(EXPR), min(EXPR), amplitude(EXPR), mean(EXPR),\n"
        "                       period(EXPR) over the run. Repeatable. Default: the final state and the\n"
        "                       outputs. A name is in its declared unit, an expression in SI.\n"
        "  --from TIME          evaluate the measures over the run from this time on\n"
        "  --csv FILE           the rows, in the order of the grid; - is standard output (default). The same\n"
        "                       command continues the FILE of an interrupted sweep.\n"
        "  --fresh              start FILE again from the first row\n"
        "  --jobs N             parallel processes (default: one per processor). The rows do not depend on\n"
        "                       N.\n"
        "  --shard K/N          run only part K of N. The files of all parts, joined in order, are the whole\n"
        "                       file.\n" OPTIONS_STRICT_HELP
        "  --json               one JSON object on standard output instead of the rows (docs/warnings.md)\n"
        "  --quiet              no progress, no summary\n"
        "\n",
    .groups = OPTIONS_SCENE,
    .why = {"",
            "a point failed (its measures are empty), a warning applies (see --strict), or the\n"
            "       file could not be written",
            "wrong options, or a FILE from another sweep", ""}};

static const command_usage map_usage = {
    .head =
        "usage: whirl map SCENE|MECHANISM[:SCENE]|FILE[:SCENE] --over NAME=FROM..TO:COUNT[,log]\n"
        "                 --over NAME=FROM..TO:COUNT[,log] [options]\n"
        "\n"
        "Draws a stability map: runs the scene for each pair of values from two ranges, one of which may be\n"
        "the step. A mark shows the result: within the tolerance, a larger error, an unbalanced energy, or\n"
        "diverged (docs/stability.md).\n"
        "\n"
        "  whirl map two_mass_relative --over step=5ms..0.5s:21,log --over 'm1=1..100 [kg]:5,log'\n"
        "\n"
        "  --over RANGE         two ranges, each as in `whirl sweep`. No other option may set a "
        "swept name.\n",
    .groups = OPTIONS_SCENE,
    .tail =
        "  --tolerance 1e-3     the allowed error, as a part of the range of each coordinate over the run\n"
        "                       (default: 1e-3)\n"
        "  --csv FILE           a row for each pair: both values, the verdict, the times until which the run\n"
        "                       is accurate and finite, the energy residual. - is standard output; the map\n"
        "                       then goes to standard error.\n"
        "  --json               one JSON object on standard output instead of the map (docs/warnings.md)\n"
        "  --plot FILE.svg|.png a picture with a rectangle for each pair\n"
        "  --effort 1.5e11      operations that it may evaluate: 1.5e10 take about a minute\n"
        "  --quiet              no progress; no map if there is --csv or --plot\n",
    .why = {"even if some runs diverged", "no pair could be run", "", ""}};

/* --- options -----------------------------------------------------------------------------------*/

typedef struct sweep_options {
    common_options common;
    const char *target;
    const char **over; /* [over_count] */
    int over_count;
    const char **measure; /* [measure_count] */
    int measure_count;
    /* as typed, or NULL */
    const char *from, *csv, *shard_text, *plot;
    shard part;
    double jobs;
    double strict;
    double tolerance;
    double effort;
    bool maps, fresh, quiet, json;
} sweep_options;

/* Reads "K/N", the K-th of N parts of the sweep. */
static bool read_shard(const char *text, sweep_options *o) {
    const char *slash;
    const char *end;
    const double number = decimal_read(text, &slash);
    const double of = *slash == '/' ? decimal_read(slash + 1, &end) : 0.0;
    if (!(number >= 1.0 && number <= of && of <= 1e6) || *end != '\0' ||
        number_floor(number) < number || number_floor(of) < of) {
        return options_fail("sweep", "--shard takes K/N with 1 <= K <= N <= 1000000");
    }
    o->part = (shard){(uint64_t)number, (uint64_t)of};
    return true;
}

static bool is_whole_sweep(sweep_options *o) {
    if (o->shard_text != NULL && !read_shard(o->shard_text, o)) {
        return false;
    }
    if (o->json && o->csv != NULL && !options_is_standard(o->csv)) {
        return options_fail("sweep", "--json prints the rows, and --csv FILE writes them\n"
                                     "hint: leave one of them out");
    }
    o->csv = o->json ? "/dev/null" : o->csv != NULL ? o->csv : "-";
    return o->over_count > 0 ||
           options_fail("sweep", "--over is missing: whirl sweep needs a range of values\n"
                                 "hint: write a range such as --over \"r=10..60 [mm]:11\"");
}

static bool is_whole_map(sweep_options *o) {
    if (o->over_count > AXES) {
        return options_fail("map",
                            "a map needs exactly two --over, but '%.60s' is a third "
                            "one",
                            o->over[AXES]);
    }
    if (o->over_count < AXES) {
        return options_fail("map",
                            "a map needs two --over: %s\nhint: write ranges such as --over "
                            "step=1ms..0.1s:20,log --over 'k=1..100 [N/m]:20,log'",
                            o->over_count == 0 ? "there is none" : "there is one");
    }
    return options_json_is_alone("map", o->json, o->csv);
}

/* --- the sweep ---------------------------------------------------------------------------------*/

static int sweep_loaded(const sweep_options *o, const source_model *from, const loaded *base,
                        sweep *s) {
    s->shared = sweep_can_share(s->grid, base->image) ? base->image : NULL;
    uint64_t first;
    uint64_t end;
    grid_shard(s->grid, o->part.number, o->part.of, &first, &end);
    char *fingerprint = fingerprint_make(s, from->text, base->instance, base->image, o->part);
    const session_settings settings = {.csv = o->csv,
                                       .fingerprint = fingerprint,
                                       .first = first,
                                       .end = end,
                                       .header = o->part.number == 1,
                                       .jobs = (int)o->jobs,
                                       .fresh = o->fresh,
                                       .quiet = o->quiet,
                                       .json = o->json};
    interrupts_catch();
    const int code = session_run(s, &settings);
    free(fingerprint);
    return code;
}

/* Reads --from into s->from_s. Returns the measures of --measure, which the caller frees; NULL after an error. */
static measures *take_measures(const sweep_options *o, sweep *s, diags *errors) {
    const mechanism *of = s->mechanism;
    if (o->from != NULL &&
        !instance_duration(of, s->scene, s->changes, "from", o->from, errors, &s->from_s)) {
        return NULL;
    }
    measures *wanted = measures_new(of, o->measure, o->measure_count, errors);
    s->measures = wanted;
    s->mechanism = wanted != NULL ? &wanted->mechanism : of;
    return wanted;
}

/* --- the map -----------------------------------------------------------------------------------*/

static bool write_map(const sweep_options *o, const stability_map *m, const char *name) {
    FILE *out = atomic_file_open(o->csv);
    if (out != NULL) {
        map_csv(out, m);
    }
    return out != NULL && plot_run_csv_end(out, o->csv, true, "map", name);
}

static int show_map(const sweep_options *o, const stability_map *m, const char *words,
                    const char *name) {
    if (!o->json && (!o->quiet || (o->csv == NULL && o->plot == NULL))) {
        map_print(options_is_standard(o->csv) ? stderr : stdout, m, words);
    }
    int code = o->csv == NULL || write_map(o, m, name) ? EXIT_DONE : EXIT_RUN_FAILED;
    if (o->plot != NULL && !map_plot(o->plot, m, words)) {
        code = EXIT_RUN_FAILED;
    }
    if (m->done < m->grid->points) {
        fprintf(stderr, "whirl map: interrupted after %llu of %llu runs\n",
                (unsigned long long)m->done, (unsigned long long)m->grid->points);
        return code == EXIT_DONE ? EXIT_INTERRUPTED : code;
    }
    if (map_count(m, MAP_NONE) == m->grid->points) {
        fputs(
            "whirl map: error: no pair of values can be run\nhint: try one pair with `whirl run`, "
            "which prints the reason\n",
            stderr);
        return code == EXIT_DONE ? EXIT_RUN_FAILED : code;
    }
    return code;
}

static void show_progress(double runs, void *context) {
    const grid *g = context;
    fprintf(stderr, "\r%.1f of %llu runs ", runs, (unsigned long long)g->points);
}

static double operations_of(const grid *g, const image *base) {
    double runs = 0.0;
    for (int i = 0; i < AXES; i++) {
        for (uint64_t k = 0; g->axes[i].symbol == NULL && k < g->axes[i].count; k++) {
            double value[AXES];
            grid_values(g, i == 0 ? k * g->axes[1].count : k, value);
            runs += base->step_s / value[i] * (double)g->axes[1 - i].count;
        }
    }
    runs = runs > 0.0 ? runs : (double)g->points;
    const double operations =
        step_doubling_operations(base) + OPERATIONS_A_STEP * (double)base->steps;
    return runs * operations;
}

static int map_loaded(const sweep_options *o, const sweep *s, const image *base) {
    const unsigned long long pairs = s->grid->points;
    if (pairs > PAIRS_MOST) {
        (void)options_fail(
            "map", "%llu pairs exceed the limit of %d\nhint: use a smaller COUNT in each --over",
            pairs, PAIRS_MOST);
        return EXIT_BAD_INPUT;
    }
    if (!effort_suffices("map", o->effort, operations_of(s->grid, base),
                         "use fewer pairs, longer steps or an earlier --until",
                         "%llu pairs with two runs each", pairs)) {
        return EXIT_BAD_INPUT;
    }
    const map_request request = {.of = *s,
                                 .tolerance = o->tolerance,
                                 .context = (void *)(uintptr_t)s->grid,
                                 .progress =
                                     !o->quiet && isatty(STDERR_FILENO) ? show_progress : NULL};
    char *words =
        alloc_words("%s: %s%s, %s, tolerance %g", base->title[0] != '\0' ? base->title : base->name,
                    image_stepper(base), image_sums(base), s->kind->name, o->tolerance);
    interrupts_catch();
    stability_map m = map_make(&request);
    if (request.progress != NULL) {
        fputs("\r                                        \r", stderr);
    }
    const int code = show_map(o, &m, words, base->name);
    if (o->json) {
        map_json(stdout, &m, base, &request, code);
    }
    map_free(&m);
    free(words);
    return code;
}

/* --- the commands ------------------------------------------------------------------------------*/

/* Reports errors of the unchanged scene, which all points would share. Returns false after an error. */
static bool begins(const sweep_options *o, const sweep *s, const loaded *base, diags *errors) {
    const double until_s = base->instance->until_s;
    if (s->from_s > until_s) {
        return options_fail("sweep", "--from %.9g s is after the end, %.9g s", s->from_s, until_s);
    }
    if (!o->maps && !sweep_ends_are_alike(s, until_s)) {
        return false;
    }
    if (s->kind == &engine_float) {
        say_float_range(base->image);
    }
    return changes_take_part(s->grid, base->instance) &&
           start_has_method(base->image, s->engine.method, errors);
}

static int sweep_picked(const sweep_options *o, source_model *from, sweep *s) {
    const load_request request = {.settings = o->common.integration,
                                  .use = IMAGE_TO_RUN,
                                  .hints = !o->maps && !o->quiet,
                                  .conserve = true};
    loaded base;
    int code = load(&base, from, s->mechanism, s->scene, s->changes, &request);
    const bool good = code == EXIT_DONE && begins(o, s, &base, from->errors);
    diags_flush(from->errors, stderr);
    code = !good     ? EXIT_BAD_INPUT
           : o->maps ? map_loaded(o, s, base.image)
                     : sweep_loaded(o, from, &base, s);
    unload(&base);
    return code;
}

static int sweep_source(source_model *from, void *options) {
    sweep_options *o = options;
    overrides changes = o->common.changes;
    grid g = {.command = o->maps ? "map" : "sweep"};
    sweep s = {.grid = &g,
               .changes = &changes,
               .kind = o->common.number,
               .engine = o->common.integration,
               .strict = o->strict};
    changes.balance = true;
    bool good = (o->maps ? is_whole_map : is_whole_sweep)(o) &&
                source_pick(from, true, &s.mechanism, &s.scene) == EXIT_DONE;
    for (int i = 0; i < o->over_count && good; i++) {
        good = grid_add(&g, s.mechanism, o->over[i], from->errors);
    }
    diags_flush(from->errors, stderr);
    good = good && changes_are_apart(&g, &changes);
    measures *wanted = good && !o->maps ? take_measures(o, &s, from->errors) : NULL;
    good = good && (o->maps || wanted != NULL);
    diags_flush(from->errors, stderr);
    const int code = good ? sweep_picked(o, from, &s) : EXIT_BAD_INPUT;
    measures_free(wanted);
    grid_free(&g);
    return code;
}

int command_sweep(int count, char **words) {
    sweep_options o = {.common = options_defaults(),
                       .over = alloc(count, sizeof(const char *)),
                       .measure = alloc(count, sizeof(const char *)),
                       .part = {1, 1},
                       .jobs = jobs_workers()};
    const own_option own[] = {{.word = "--over", .text = o.over, .count = &o.over_count},
                              {.word = "--measure", .text = o.measure, .count = &o.measure_count},
                              {.word = "--from", .text = &o.from},
                              {.word = "--csv", .text = &o.csv, .file = FILE_WRITTEN},
                              {.word = "--fresh", .flag = &o.fresh},
                              OWN_WHOLE("--jobs", o.jobs, 1.0, JOBS_WORKERS_MAX, "--jobs 4"),
                              {.word = "--shard", .text = &o.shard_text},
                              {.word = "--json", .flag = &o.json},
                              {.word = "--strict", .strict = &o.strict},
                              {.word = "--quiet", .flag = &o.quiet},
                              {.word = NULL}};
    const target_reader reader = {
        .command = "sweep", .usage = &sweep_usage, .table = own, .work_on = sweep_source};
    const int code = target_command(&reader, count, words, &o.common, &o, &o.target);
    free(o.over);
    free(o.measure);
    return code;
}

int command_map(int count, char **words) {
    sweep_options o = {.maps = true,
                       .common = options_defaults(),
                       .over = alloc(count, sizeof(const char *)),
                       .tolerance = HORIZON_TOLERANCE,
                       .effort = EFFORT};
    const own_option own[] = {{.word = "--over", .text = o.over, .count = &o.over_count},
                              OWN_TOLERANCE(o.tolerance),
                              OWN_EFFORT(o.effort, "1e12"),
                              {.word = "--csv", .text = &o.csv, .file = FILE_WRITTEN_LATE},
                              {.word = "--plot", .text = &o.plot, .file = FILE_DRAWN},
                              {.word = "--json", .flag = &o.json},
                              {.word = "--quiet", .flag = &o.quiet},
                              {.word = NULL}};
    const target_reader reader = {
        .command = "map", .usage = &map_usage, .table = own, .work_on = sweep_source};
    const int code = target_command(&reader, count, words, &o.common, &o, &o.target);
    free(o.over);
    return code;
}

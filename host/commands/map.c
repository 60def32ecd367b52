/* map.c: `whirl map`: for which pairs of two swept values a run stays bounded, keeps its energy and a tolerance. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "commands.h"
#include "files.h"
#include "host/base/room.h"
#include "host/base/written.h"
#include "host/map/map_plot.h"
#include "host/map/map_text.h"
#include "host/number/functions.h"
#include "host/plot/gnuplot.h"
#include "host/run/start.h"
#include "host/sweep/changes.h"
#include "interrupts.h"
#include "target.h"
#include "trusting.h"

enum { AXES = 2 };
/* Of a map that can be looked at. */
#define PAIRS_MOST 250000
/* Operations that it may evaluate without --effort. */
#define EFFORT 1.5e11
/* What looking, books and comparing take of operations, about, beside those of the step's lists. */
#define OPERATIONS_A_STEP 200.0

static const command_usage usage = {
    .head =
        "usage: whirl map SCENE|MECHANISM[:SCENE]|FILE[:SCENE] --over NAME=FROM..TO:COUNT[,log]\n"
        "                 --over NAME=FROM..TO:COUNT[,log] [options]\n"
        "\n"
        "A stability map: the scene is run for each pair of two swept values, one of which may be the\n"
        "step, and a mark tells what became of it: right to the tolerance, off by more, its energy not\n"
        "kept, or out of all bounds.\n"
        "\n"
        "  whirl map two_mass_relative --over step=5ms..0.5s:21,log --over 'm1=1..100 [kg]:5,log'\n"
        "\n"
        "  --over RANGE         twice: COUNT values of a parameter, an input, a start value or the\n"
        "                       step, even or even in the logarithm; a bare number is SI\n",
    .groups = OPTIONS_SCENE,
    .tail =
        "  --tolerance 1e-3     part of the range that a coordinate has in a run (default: 1e-3)\n"
        "  --csv FILE           a row for each pair; - is standard output, and the map then goes to\n"
        "                       standard error\n"
        "  --json               one JSON object on standard output in place of the map (docs/warnings.md)\n"
        "  --plot FILE.svg|.png a square for each pair\n"
        "  --effort 1.5e11      operations that it may evaluate: 1.5e10 take about a minute\n"
        "  --quiet              no progress, and no map beside --csv or --plot\n",
    .why = {[EXIT_ROW_OF(EXIT_DONE)] = "whatever became of the runs",
            [EXIT_ROW_OF(EXIT_RUN_FAILED)] = "no pair has a run",
            [EXIT_ROW_OF(EXIT_BAD_INPUT)] = "",
            [EXIT_ROW_OF(EXIT_INTERRUPTED)] = ""}};

typedef struct map_options {
    common_options common;
    const char *target;
    const char *over[AXES];
    int over_count;
    const char *csv;
    const char *plot;
    double tolerance;
    double effort;
    bool json;
    bool quiet;
} map_options;

static bool take_over(const char *text, map_options *o) {
    const bool room_left = o->over_count < AXES;
    if (!room_left) {
        fprintf(stderr, "whirl map: error: two --over, not also '%.60s'\n", text);
    } else {
        o->over[o->over_count++] = text;
    }
    return room_left;
}

static bool take_one(int count, char **words, int *at, void *options, bool *bad) {
    map_options *o = options;
    const char *value = NULL;
    if (!*bad && (value = options_value(count, words, at, "--over", bad)) != NULL) {
        *bad = !take_over(value, o);
    } else if (!*bad && (value = options_value(count, words, at, "--tolerance", bad)) != NULL) {
        *bad = !options_number("map", "--tolerance", value, 1e-15, 1.0,
                               "a part of the range that a coordinate has: --tolerance 1e-3",
                               &o->tolerance);
    } else if (!*bad && (value = options_value(count, words, at, "--effort", bad)) != NULL) {
        *bad = !options_number("map", "--effort", value, EFFORT_LEAST, EFFORT_MOST,
                               "operations: --effort 1e12", &o->effort);
    } else if (!*bad && (value = options_value(count, words, at, "--csv", bad)) != NULL) {
        o->csv = value;
    } else if (!*bad && (value = options_value(count, words, at, "--plot", bad)) != NULL) {
        o->plot = value;
    } else if (!*bad && (strcmp(words[*at], "--quiet") == 0 || strcmp(words[*at], "--json") == 0)) {
        *(words[*at][2] == 'q' ? &o->quiet : &o->json) = true;
        ++*at;
        return true;
    }
    return value != NULL;
}

static bool is_standard(const map_options *o) { return o->csv != NULL && strcmp(o->csv, "-") == 0; }

/* Nothing is missing, and nothing contradicts. */
static bool is_whole(const map_options *o) {
    if (o->over_count < AXES) {
        fprintf(stderr,
                "whirl map: error: two --over are wanted, %s\nhint: such as --over "
                "step=1ms..0.1s:20,log --over 'k=1..100 [N/m]:20,log'\n",
                o->over_count == 0 ? "there is none" : "there is one");
        return false;
    }
    if (o->plot != NULL && !gnuplot_can_draw_for("map", "--plot", o->plot)) {
        return false;
    }
    if (o->json && is_standard(o)) {
        fputs("whirl map: error: --json and rows cannot share standard output\n"
              "hint: --csv rows.csv\n",
              stderr);
        return false;
    }
    if (o->csv != NULL && o->plot != NULL && files_same(o->csv, o->plot)) {
        fputs("whirl map: error: --csv and --plot cannot share a file\n", stderr);
        return false;
    }
    return true;
}

static bool read_options(int count, char **words, map_options *o) {
    static const char *const own[] = {"--over", "--tolerance", "--effort", "--csv",
                                      "--plot", "--json",      "--quiet",  NULL};
    const target_reader reader = {
        .command = "map", .groups = usage.groups, .own = own, .take = take_one};
    return target_read(&reader, count, words, &o->common, o, &o->target) &&
           target_is_there(o->target, &usage) && is_whole(o);
}

/* --- the answer -----------------------------------------------------------------------------------------*/

static bool write_rows(const map_options *o, const stability_map *m) {
    FILE *out = written_open(o->csv);
    if (out != NULL) {
        map_csv(out, m);
    }
    return out != NULL && written_close(out, o->csv, true);
}

static int show(const map_options *o, const stability_map *m, const char *words) {
    if (!o->json && (!o->quiet || (o->csv == NULL && o->plot == NULL))) {
        map_print(is_standard(o) ? stderr : stdout, m, words);
    }
    int code = o->csv == NULL || write_rows(o, m) ? EXIT_DONE : EXIT_BAD_INPUT;
    if (o->plot != NULL && !map_plot(o->plot, m, words)) {
        code = EXIT_BAD_INPUT;
    }
    if (m->done < m->grid->points) {
        fprintf(stderr, "whirl map: interrupted after %llu of %llu runs\n",
                (unsigned long long)m->done, (unsigned long long)m->grid->points);
        return code == EXIT_DONE ? EXIT_INTERRUPTED : code;
    }
    if (map_count(m, MAP_NONE) == m->grid->points) {
        fputs("whirl map: error: no pair has a run\nhint: `whirl run` with the values of one tells "
              "why\n",
              stderr);
        return code == EXIT_DONE ? EXIT_RUN_FAILED : code;
    }
    return code;
}

/* --- the runs -------------------------------------------------------------------------------------------*/

static void show_progress(double runs, void *told) {
    const grid *g = told;
    fprintf(stderr, "\r%.1f of %llu runs ", runs, (unsigned long long)g->points);
}

/* Operations of all runs, about: as many steps as each step's length makes of the scene as it stands. */
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
        twins_operations(base, base) + OPERATIONS_A_STEP * (double)base->steps;
    return runs * operations;
}

static bool is_affordable(const map_options *o, const grid *g, const image *base) {
    if (g->points > PAIRS_MOST) {
        fprintf(stderr, "whirl map: error: %llu pairs, at most %d\nhint: fewer in each --over\n",
                (unsigned long long)g->points, PAIRS_MOST);
        return false;
    }
    const double wanted = operations_of(g, base);
    if (wanted <= o->effort) {
        return true;
    }
    fprintf(
        stderr,
        "whirl map: error: this would take about %.0f minutes: %llu pairs, two runs beside each "
        "other for each\nhint: fewer pairs, longer steps, a nearer --until",
        number_ceiling(wanted / TWINS_OPERATIONS_1S / 60.0), (unsigned long long)g->points);
    if (wanted <= EFFORT_MOST) {
        fprintf(stderr, "; or --effort %.2g", 1.1 * wanted);
    }
    fputc('\n', stderr);
    return false;
}

static int map_loaded(const map_options *o, const map_wish *plan, const image *base) {
    if (!is_affordable(o, plan->grid, base)) {
        return EXIT_BAD_INPUT;
    }
    map_wish wish = *plan;
    wish.told = (void *)(uintptr_t)plan->grid;
    wish.progress = !o->quiet && isatty(STDERR_FILENO) ? show_progress : NULL;
    wish.stop = &interrupted;
    char *words =
        room_words("%s: %s%s, %s, tolerance %g", base->title[0] != '\0' ? base->title : base->name,
                   image_stepper(base), image_sums(base), wish.kind->name, o->tolerance);
    interrupts_catch();
    stability_map m = map_make(&wish);
    if (wish.progress != NULL) {
        fputs("\r                                        \r", stderr);
    }
    const int code = show(o, &m, words);
    if (o->json) {
        map_json(stdout, &m, base, &wish, code);
    }
    map_free(&m);
    free(words);
    return code;
}

/* What is wrong with every pair is told of the scene as it stands. */
static int map_scene(const map_options *o, source_model *from, const mechanism *of, const scene *in,
                     const grid *g) {
    overrides changes = options_overrides(&o->common.change);
    changes.balance = true;
    const load_wish wish = {.settings = o->common.integration,
                            .use = IMAGE_TO_RUN,
                            .keep = KEEP_INSTANCE,
                            .conserve = true};
    const map_wish plan = {.grid = g,
                           .mechanism = of,
                           .scene = in,
                           .changes = &changes,
                           .kind = o->common.number,
                           .settings = o->common.integration,
                           .tolerance = o->tolerance};
    if (!changes_are_apart(g, &changes)) {
        return EXIT_BAD_INPUT;
    }
    loaded base;
    int code = load(&base, from, of, in, &changes, &wish);
    if (code == EXIT_DONE && o->common.number == &engine_float) {
        say_float_range(base.image);
    }
    if (code == EXIT_DONE && (!changes_take_part(g, base.instance) ||
                              !start_has_method(base.image, plan.settings.method, from->errors))) {
        diags_flush(from->errors, stderr);
        code = EXIT_BAD_INPUT;
    }
    if (code == EXIT_DONE) {
        code = map_loaded(o, &plan, base.image);
    }
    unload(&base);
    return code;
}

/* Before the work, which else would be in vain. */
static bool can_write(const map_options *o, const source_model *from) {
    return !source_would_be_lost(from, "--csv", o->csv, "") &&
           !source_would_be_lost(from, "--plot", o->plot, "") && written_can(o->csv) &&
           written_can(o->plot) && (o->plot == NULL || gnuplot_is_there());
}

static int map_source(const map_options *o, source_model *from) {
    const mechanism *of;
    const scene *in;
    int code = source_open(from, o->target);
    code = code == EXIT_DONE ? source_pick(from, true, &of, &in) : code;
    if (code != EXIT_DONE || !can_write(o, from)) {
        return code != EXIT_DONE ? code : EXIT_BAD_INPUT;
    }
    grid g = {.command = "map"};
    bool good = true;
    for (int i = 0; i < AXES && good; i++) {
        good = grid_add(&g, of, o->over[i], from->errors);
    }
    diags_flush(from->errors, stderr);
    code = good ? map_scene(o, from, of, in, &g) : EXIT_BAD_INPUT;
    grid_free(&g);
    return code;
}

int command_map(int count, char **words) {
    map_options o = {
        .common = options_defaults(), .tolerance = HORIZON_TOLERANCE, .effort = EFFORT};
    source_model from = {0};
    if (options_help(count, words, &usage)) {
        return EXIT_DONE;
    }
    int code = EXIT_BAD_INPUT;
    if (read_options(count, words, &o)) {
        code = map_source(&o, &from);
        source_close(&from);
    }
    options_forget(&o.common);
    return code;
}

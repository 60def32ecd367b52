/* run.c: `whirl run`: simulation, records, and the energy balance. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "commands.h"
#include "host/base/alloc.h"
#include "host/check/apart.h"
#include "host/check/finding.h"
#include "host/cli/load.h"
#include "host/fixed/engine_fixed.h"
#include "host/fixed/fixed_plan.h"
#include "host/os/system.h"
#include "host/study/simulate.h"
#include "options.h"
#include "pricing.h"
#include "pricing_scene.h"
#include "rating.h"
#include "run.h"
#include "trusting.h"

static const command_usage usage = {
    .head =
        "usage: whirl run SCENE|MECHANISM[:SCENE]|FILE[:SCENE] [options]\n"
        "\n"
        "Runs a scene and prints a summary: final state, energy and momentum balance, hash of the state.\n"
        "Without a scene, a mechanism starts at zero, at rest. If a FILE has several scenes, name one.\n"
        "\n",
    .groups = OPTIONS_SCENE,
    .described = true,
    .tail =
        "  --csv FILE           records, and FILE.toml, which describes the run (docs/howto/data.md); - is\n"
        "                       standard output (the summary then goes to standard error)\n"
        "  --columns FILE       the same records with spaces between the columns, for Octave's load; - as\n"
        "                       for --csv\n"
        "  --vcd FILE           the same records with the contacts, for waveform viewers; - as for --csv\n"
        "  --every 2ms          spacing of the records, a whole number of steps (default: every step). The\n"
        "                       last state is always recorded.\n"
        "  --plot FILE          a picture, .svg, .pdf or .png, drawn by gnuplot (docs/plot.md), with these\n"
        "                       options:\n" RUN_CHOICE_HELP
        "  --error X=0.1mm      use the largest step that keeps a coordinate, rate or output within the\n"
        "                       error, instead of the scene's step\n"
        "  --board B            the board of the cost rows: an emulated board of docs/boards.md, or host\n"
        "                       (default: mps2-an386, a Cortex-M4F)\n" OPTIONS_STRICT_HELP
        "  --json               one JSON object on standard output instead of the summary (docs/warnings.md)\n"
        "  --quiet              no summary, no progress\n"
        "\n"
        "The summary ends with the error and the cost on a board at twice the step, the step and half the\n"
        "step, in float unless --number says otherwise (docs/price.md). If these rows take more than a\n"
        "second, Whirl leaves them out.\n"
        "\n"
        "Warnings go to standard error. They come from a finer run, the energy balance and other checks,\n"
        "and name options that Whirl tried and that cure the fault (docs/warnings.md). After a "
        "warning\nthe exit status is 1, and all outputs are complete.\n"
        "\n"
        "Summary, records and plot use the declared units. A column whose name has no unit is SI: theta\n"
        "[deg] is in degrees, theta in radians. No output file may be the model file.\n",
    .why = {"",
            "the run diverged, or a number was not finite (the message has time, place and\n"
            "       remedy; records so far are kept), or a warning applies (see --strict)",
            "", ""}};

typedef struct run_options {
    common_options common;
    const char *target;
    const char *every;
    const char *error;
    const char *board_word;
    const cost_board *board;
    const engine_kind *number; /* --number, or NULL */
    simulation_settings settings;
} run_options;

static bool read_options(int count, char **words, run_options *o) {
    simulation_settings *to = &o->settings;
    const own_option own[] = {RUN_CHOICE_ROWS(to->choice),
                              {.word = "--csv", .text = &to->csv, .file = FILE_WRITTEN},
                              {.word = "--columns", .text = &to->columns, .file = FILE_WRITTEN},
                              {.word = "--vcd", .text = &to->vcd, .file = FILE_WRITTEN},
                              {.word = "--every", .text = &o->every},
                              {.word = "--plot", .text = &to->plot, .file = FILE_DRAWN},
                              {.word = "--error", .text = &o->error},
                              {.word = "--board", .text = &o->board_word},
                              {.word = "--strict", .strict = &to->strict},
                              {.word = "--json", .flag = &to->json},
                              {.word = "--quiet", .flag = &to->quiet},
                              {.word = NULL}};
    const target_reader reader = {.command = "run", .usage = &usage, .table = own};
    o->common.number = NULL;
    if (!target_read(&reader, count, words, &o->common, &o->target)) {
        return false;
    }
    if (o->target == NULL) {
        options_usage(stderr, &usage);
        return false;
    }
    o->board = pricing_board("run", o->board_word != NULL ? o->board_word : COST_BOARD_DEFAULT);
    if (o->board == NULL) {
        return false;
    }
    o->number = o->common.number;
    o->common.number = o->number != NULL ? o->number : &engine_double;
    o->settings.kind = o->common.number;
    if (o->settings.plot == NULL && o->settings.taken == NULL &&
        memcmp(&o->settings.choice, &(plot_choice){0}, sizeof(plot_choice)) != 0) {
        return options_fail("run", "--x, --y and other plot options need --plot\n"
                                   "hint: --plot picture.svg");
    }
    if (o->settings.json && simulation_summary(&o->settings) != stdout) {
        return options_fail("run", "--json and records cannot share standard output\n"
                                   "hint: --csv records.csv");
    }
    return true;
}

/* The interval of --every in steps. Returns false after an error (reported). */
static bool count_every(const run_options *o, const loaded *made, uint64_t *steps) {
    const image *im = made->image;
    double spacing_s;
    *steps = 1;
    if (o->every == NULL) {
        return true;
    }
    if (!options_time("run", "every", o->every, made->instance->mechanism, (double)INFINITY,
                      &spacing_s)) {
        return false;
    }
    if (!ratio_count_each(spacing_s, im->step, steps)) {
        return options_fail(
            "run", "--every %s is not a multiple of the step\nhint: use a multiple of %.9g s",
            o->every, im->step_s);
    }
    if (o->settings.csv == NULL && o->settings.columns == NULL && o->settings.vcd == NULL) {
        return options_fail("run", "--every needs records\nhint: --csv FILE");
    }
    return true;
}

static bool shows_progress(const simulation_settings *s) {
    return !s->quiet && isatty(STDERR_FILENO);
}

static int run_image(run_options *o, const rating_request *rated) {
    const image *im = rated->image;
    if (!image_can_start(im, o->settings.kind, rated->errors)) {
        return EXIT_BAD_INPUT;
    }
    apart_say(stderr, "whirl run", im);
    interrupts_catch();
    o->settings.progress = shows_progress(&o->settings);
    simulation_trust trust;
    const simulation_result result = simulate(im, &o->settings, &trust);
    if (result == SIMULATION_DONE && !o->settings.quiet && !o->settings.json) {
        rating_say(simulation_summary(&o->settings), rated, &trust);
    }
    if (result == SIMULATION_DONE && trust.fails != 0) {
        finding_say_status(stderr, "run", trust.fails);
    }
    return simulation_status(result, &trust);
}

/* Opens the model. With --error, chooses *step, and describes it in *chosen; both to be freed. */
static int open_source(run_options *o, source_model *from, char **step, char **chosen) {
    if (o->error == NULL) {
        return source_open(from, o->target);
    }
    interrupts_catch();
    const int code = rating_choose(&o->common, o->target, o->error, from, step, chosen);
    o->common.changes.step = *step;
    o->settings.chosen = *chosen;
    return code;
}

static int run_target(run_options *o) {
    source_model from = {0};
    loaded made = {0};
    fixed_plan *plan = NULL;
    char *step = NULL;
    char *chosen = NULL;
    int code = open_source(o, &from, &step, &chosen);
    o->common.changes.balance = true;
    if (code == EXIT_DONE) {
        code = target_load(&made, &from, &o->common,
                           (load_request){.use = IMAGE_TO_CHECK,
                                          .scene = true,
                                          .hints = !o->settings.quiet,
                                          .conserve = true});
    }
    if (code == EXIT_DONE && !count_every(o, &made, &o->settings.every)) {
        code = EXIT_BAD_INPUT;
    }
    if (code == EXIT_DONE && o->settings.kind == &engine_float) {
        say_float_range(made.image);
    }
    if (code == EXIT_DONE && o->settings.kind == &engine_fixed) {
        code = trusting_plan("run", made.image, shows_progress(&o->settings), from.errors, &plan);
        if (plan != NULL && !o->settings.quiet) {
            fixed_plan_say(plan, stderr, "whirl run: note: ");
        }
    }
    if (code == EXIT_DONE) {
        const rating_request rated = {.target = o->target,
                                      .board = o->board,
                                      .board_word = o->board_word,
                                      .number = o->number,
                                      .settings = &o->common.integration,
                                      .changes = &o->common.changes,
                                      .of = made.instance->mechanism,
                                      .in = made.instance->scene,
                                      .errors = from.errors,
                                      .image = made.image};
        o->settings.no_scene = rated.in == NULL;
        code = run_image(o, &rated);
    }
    fixed_plan_free(plan);
    unload(&made);
    source_close(&from);
    free(step);
    free(chosen);
    return code;
}

static int run_words(int count, char **words, run_options *o) {
    int code = EXIT_BAD_INPUT;
    if (read_options(count, words, o)) {
        char *changes = pricing_words(&o->common.changes, true);
        o->settings.changes = changes;
        code = run_target(o);
        free(changes);
    }
    options_forget(&o->common);
    return code;
}

int run_to_take(int count, char **words, const plot_choice *choice, plot_run *taken) {
    run_options o = {.common = options_defaults()};
    *taken = (plot_run){0};
    o.settings.taken = taken;
    o.settings.choice = *choice;
    o.settings.quiet = true;
    o.settings.strict = STRICT_OFF; /* runs with findings are drawn, too */
    return run_words(count, words, &o);
}

int command_run(int count, char **words) {
    run_options o = {.common = options_defaults()};
    return options_help(count, words, &usage) ? EXIT_DONE : run_words(count, words, &o);
}

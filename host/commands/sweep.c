/* sweep.c: `whirl sweep`: a run for every point of a grid, with a row of measures each. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "commands.h"
#include "host/base/room.h"
#include "host/commands/load.h"
#include "host/lang/builtin.h"
#include "host/run/start.h"
#include "host/sweep/changes.h"
#include "host/sweep/jobs.h"
#include "host/sweep/session.h"
#include "interrupts.h"
#include "target.h"

static const command_usage usage = {
    .head =
        "usage: whirl sweep SCENE|MECHANISM[:SCENE]|FILE[:SCENE] --over NAME=FROM..TO:COUNT[,log] ...\n"
        "                   [options]\n"
        "\n"
        "Runs a scene at every point of a grid and writes a row of measures for each.\n"
        "What is run is named as for `whirl run`.\n"
        "\n"
        "  --over RANGE         COUNT values of a parameter, an input, a start value or the step;\n"
        "                       a bare number is SI: \"r=10..60 [mm]:11\", \"theta'=1..4 [rpm]:7\",\n"
        "                       \"step=0.1..10 [ms]:9,log\". Repeatable: the full grid, the last one\n"
        "                       fastest\n"
        "  --measure EXPR       the value at the end; or max(EXPR), min(EXPR), amplitude(EXPR),\n"
        "                       mean(EXPR), period(EXPR) over the run. Repeatable; without it the\n"
        "                       final state and the outputs. A quantity stands in its declared\n"
        "                       unit, an expression in SI\n"
        "  --from TIME          measure only from then on (final values stay those of the end)\n"
        "  --csv FILE           rows by rising point; - is standard output (default). The same\n"
        "                       command goes on with the FILE of a sweep that was broken off\n"
        "  --fresh              start FILE anew instead\n"
        "  --jobs N             processes (default: one a processor); the rows do not depend on it\n"
        "  --shard K/N          the K-th of N parts: their files, in order, are the whole file\n" OPTIONS_STRICT_HELP
        "  --json               one JSON object on standard output in place of rows (docs/warnings.md)\n"
        "  --quiet              no progress, no summary\n"
        "\n",
    .groups = OPTIONS_SCENE,
    .tail = "",
    .why = {
        [EXIT_ROW_OF(EXIT_DONE)] = "",
        [EXIT_ROW_OF(EXIT_RUN_FAILED)] =
            "points did (their measures are empty; the others are there), a warning is against\n"
            "       one (see --strict), or the file could not be written",
        [EXIT_ROW_OF(EXIT_BAD_INPUT)] = "such as the FILE of another sweep",
        [EXIT_ROW_OF(EXIT_INTERRUPTED)] = ""}};

/* --- options -----------------------------------------------------------------------------------*/

typedef struct sweep_options {
    common_options common;
    const char *target;
    const char **over; /* [word count] */
    int over_count;
    const char **measure; /* [word count] */
    int measure_count;
    const char *from;
    const char *csv;
    shard part;
    int jobs;
    double strict;
    bool fresh;
    bool quiet;
    bool json;
} sweep_options;

/* A whole number from 1 to `limit`, up to the end of the text or `end`. */
static bool read_whole(const char *text, char end, unsigned long long limit,
                       unsigned long long *value, const char **rest) {
    const size_t digits = strspn(text, "0123456789");
    *value = digits > 0 && digits < 10 ? strtoull(text, NULL, 10) : 0;
    *rest = text + digits + (text[digits] == '\0' ? 0 : 1);
    return *value >= 1 && *value <= limit && text[digits] == end;
}

static bool read_jobs(const char *text, sweep_options *o) {
    unsigned long long wanted;
    const char *rest;
    if (!read_whole(text, '\0', JOBS_WORKERS_MAX, &wanted, &rest)) {
        fprintf(stderr, "whirl sweep: error: --jobs takes a number from 1 to %d\n",
                JOBS_WORKERS_MAX);
        return false;
    }
    o->jobs = (int)wanted;
    return true;
}

static bool read_shard(const char *text, sweep_options *o) {
    unsigned long long number;
    unsigned long long of;
    const char *rest;
    if (!read_whole(text, '/', 1000000, &number, &rest) ||
        !read_whole(rest, '\0', 1000000, &of, &rest) || number > of) {
        fprintf(stderr, "whirl sweep: error: --shard takes K/N with 1 <= K <= N <= 1000000\n");
        return false;
    }
    o->part = (shard){number, of};
    return true;
}

/* One option with a value; false for another word. */
static bool take_valued(int count, char **words, int *at, sweep_options *o, bool *bad) {
    const char *value = NULL;
    if (!*bad && (value = options_value(count, words, at, "--over", bad)) != NULL) {
        o->over[o->over_count++] = value;
    } else if (!*bad && (value = options_value(count, words, at, "--measure", bad)) != NULL) {
        o->measure[o->measure_count++] = value;
    } else if (!*bad && (value = options_value(count, words, at, "--from", bad)) != NULL) {
        o->from = value;
    } else if (!*bad && (value = options_value(count, words, at, "--csv", bad)) != NULL) {
        o->csv = value;
    } else if (!*bad && (value = options_value(count, words, at, "--jobs", bad)) != NULL) {
        *bad = !read_jobs(value, o);
    } else if (!*bad && (value = options_value(count, words, at, "--shard", bad)) != NULL) {
        *bad = !read_shard(value, o);
    }
    return value != NULL;
}

static bool take_flag(char **words, int *at, sweep_options *o) {
    const struct {
        const char *name;
        bool *flag;
    } flags[] = {{"--fresh", &o->fresh}, {"--quiet", &o->quiet}, {"--json", &o->json}};
    for (size_t i = 0; i < sizeof flags / sizeof flags[0]; i++) {
        if (strcmp(words[*at], flags[i].name) == 0) {
            *flags[i].flag = true;
            ++*at;
            return true;
        }
    }
    return false;
}

static bool take_one(int count, char **words, int *at, void *options, bool *bad) {
    sweep_options *o = options;
    return take_flag(words, at, o) || options_strict("sweep", words, at, &o->strict, bad) ||
           take_valued(count, words, at, o, bad);
}

static bool read_options(int count, char **words, sweep_options *o) {
    static const char *const own[] = {"--over",   "--measure", "--from",  "--csv",
                                      "--fresh",  "--jobs",    "--shard", "--json",
                                      "--strict", "--quiet",   NULL};
    const target_reader reader = {
        .command = "sweep", .groups = usage.groups, .own = own, .take = take_one};
    if (!target_read(&reader, count, words, &o->common, o, &o->target) ||
        !target_is_there(o->target, &usage)) {
        return false;
    }
    if (o->json && strcmp(o->csv, "-") != 0) {
        fprintf(stderr, "whirl sweep: error: --json prints the rows that --csv FILE keeps\n"
                        "hint: leave one of them out\n");
        return false;
    }
    o->csv = o->json ? "/dev/null" : o->csv;
    if (o->over_count == 0) {
        fprintf(stderr, "whirl sweep: error: nothing to sweep over\n"
                        "hint: such as --over \"r=10..60 [mm]:11\"\n");
        return false;
    }
    return true;
}

/* --- the sweep ---------------------------------------------------------------------------------*/

static const char *model_text(const source_model *from) {
    for (size_t i = 0; i < builtin_model_count && from->text == NULL; i++) {
        if (strcmp(builtin_models[i].file, from->file) == 0) {
            return builtin_models[i].text;
        }
    }
    return from->text != NULL ? from->text : "";
}

static int sweep_loaded(const sweep_options *o, const source_model *from, const loaded *base,
                        sweep *s) {
    if (!start_has_method(base->image, s->engine.method, from->errors)) {
        diags_flush(from->errors, stderr);
        return EXIT_BAD_INPUT;
    }
    if (!changes_take_part(s->grid, base->instance)) {
        return EXIT_BAD_INPUT;
    }
    s->shared = sweep_can_share(s->grid, base->image) ? base->image : NULL;
    uint64_t first;
    uint64_t end;
    grid_shard(s->grid, o->part.number, o->part.of, &first, &end);
    char *fingerprint = fingerprint_make(s, model_text(from), base->instance, base->image, o->part);
    const session_settings settings = {.csv = o->csv,
                                       .fingerprint = fingerprint,
                                       .first = first,
                                       .end = end,
                                       .header = o->part.number == 1,
                                       .jobs = o->jobs,
                                       .fresh = o->fresh,
                                       .quiet = o->quiet,
                                       .json = o->json,
                                       .stop = &interrupted};
    interrupts_catch();
    const int code = session_run(s, &settings);
    free(fingerprint);
    return code;
}

/* --from in seconds: parsed like --until, so that it may name parameters, too. */
static bool read_from(const sweep_options *o, const mechanism *of, const scene *in,
                      const overrides *changes, diags *errors, double *from_s) {
    *from_s = 0.0;
    return o->from == NULL || instance_duration(of, in, changes, "from", o->from, errors, from_s);
}

static int sweep_scene(const sweep_options *o, source_model *from, const mechanism *of,
                       const scene *in) {
    grid g = {0};
    bool good = true;
    for (int i = 0; i < o->over_count && good; i++) {
        good = grid_add(&g, of, o->over[i], from->errors);
    }
    overrides changes = options_overrides(&o->common.change);
    changes.balance = true;
    sweep s = {.grid = &g,
               .scene = in,
               .changes = &changes,
               .kind = o->common.number,
               .engine = o->common.integration,
               .strict = o->strict};
    good = good && read_from(o, of, in, &changes, from->errors, &s.from_s);
    measures *wanted = good ? measures_new(of, o->measure, o->measure_count, from->errors) : NULL;
    diags_flush(from->errors, stderr);
    int code = EXIT_BAD_INPUT;
    if (wanted != NULL) {
        loaded base;
        s.measures = wanted;
        const load_wish wish = {.settings = o->common.integration,
                                .use = IMAGE_TO_RUN,
                                .keep = KEEP_INSTANCE,
                                .conserve = true};
        code = load(&base, from, &wanted->mechanism, in, &changes, &wish);
        if (code == EXIT_DONE && s.from_s > base.instance->until_s) {
            fprintf(stderr, "whirl sweep: error: --from %.9g s lies behind the end, %.9g s\n",
                    s.from_s, base.instance->until_s);
            code = EXIT_BAD_INPUT;
        }
        if (code == EXIT_DONE && !sweep_ends_are_alike(&s, base.instance->until_s)) {
            code = EXIT_BAD_INPUT;
        }
        if (code == EXIT_DONE && !o->quiet) {
            say_hints(&base);
        }
        if (code == EXIT_DONE && o->common.number == &engine_float) {
            say_float_range(base.image);
        }
        if (code == EXIT_DONE) {
            code = sweep_loaded(o, from, &base, &s);
        }
        unload(&base);
    }
    measures_free(wanted);
    grid_free(&g);
    return code;
}

/* The rows, and the files beside them (host/sweep/sheet.h). */
static bool model_would_be_lost(const source_model *from, const char *csv) {
    return source_would_be_lost(from, "--csv", csv, "") ||
           source_would_be_lost(from, "--csv", csv, ".sweep");
}

static int processors(void) {
    const long online = sysconf(_SC_NPROCESSORS_ONLN);
    return online < 1 ? 1 : online > JOBS_WORKERS_MAX ? JOBS_WORKERS_MAX : (int)online;
}

int command_sweep(int count, char **words) {
    if (options_help(count, words, &usage)) {
        return EXIT_DONE;
    }
    sweep_options o = {
        .csv = "-", .part = {1, 1}, .jobs = processors(), .common = options_defaults()};
    o.over = room(count, sizeof(const char *));
    o.measure = room(count, sizeof(const char *));
    int code = EXIT_BAD_INPUT;
    if (read_options(count, words, &o)) {
        source_model from;
        const mechanism *of;
        const scene *in;
        code = source_open(&from, o.target);
        if (code == EXIT_DONE) {
            code = source_pick(&from, true, &of, &in);
        }
        if (code == EXIT_DONE && model_would_be_lost(&from, o.csv)) {
            code = EXIT_BAD_INPUT;
        }
        if (code == EXIT_DONE) {
            code = sweep_scene(&o, &from, of, in);
        }
        source_close(&from);
    }
    options_forget(&o.common);
    free(o.over);
    free(o.measure);
    return code;
}

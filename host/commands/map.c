/* map.c: `whirl map`: for which pairs of two swept values a run stays bounded, keeps its energy and a tolerance. */
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "commands.h"
#include "files.h"
#include "host/fixed/engine_fixed.h"
#include "host/map/map_text.h"
#include "host/number/decimal.h"
#include "host/plot/plot.h"
#include "host/run/start.h"
#include "host/trust/horizon.h"
#include "load.h"
#include "options.h"

enum { AXES = 2 };
#define POINTS_MOST 250000

static const command_usage usage = {
    .head =
        "usage: whirl map SCENE|MECHANISM[:SCENE]|FILE[:SCENE] --over A=FROM..TO:COUNT --over "
        "B=FROM..TO:COUNT [options]\n"
        "\n"
        "A stability map: the scene is run for each pair of two swept values, one of which may be the\n"
        "step, and a mark tells what became of it: right to the tolerance, off by more, its energy not\n"
        "kept, or out of all bounds. Where one is the step, the longest that the linear theory lets be\n"
        "stable stands beside it.\n"
        "\n"
        "  --over step=1ms..0.1s:20,log  COUNT even values of a parameter, an input, a start value or\n"
        "                       the step; log: even in the logarithm (twice)\n",
    .groups = OPTIONS_CHANGE | OPTIONS_STEP | OPTIONS_ENGINE | OPTIONS_NUMBER,
    .tail =
        "  --tolerance 1e-3     part of the range that a coordinate has in a run (default: 1e-3)\n"
        "  --csv FILE           a row for each pair; - is standard output, and the map then goes to\n"
        "                       standard error\n"
        "  --plot FILE.svg|.png a square for each pair, and the theory's limit as a line\n"
        "  --quiet              no progress, and no map beside --csv or --plot\n",
    .why = {[EXIT_ROW_OF(EXIT_DONE)] = "whatever became of the runs",
            [EXIT_ROW_OF(EXIT_RUN_FAILED)] = "no pair has a run",
            [EXIT_ROW_OF(EXIT_BAD_INPUT)] = "",
            [EXIT_ROW_OF(EXIT_INTERRUPTED)] = ""}};

static volatile sig_atomic_t interrupted;

static void on_interrupt(int signal_number) {
    (void)signal_number;
    interrupted = 1;
}

typedef struct map_options {
    common_options common;
    const char *target;
    const char *over[AXES];
    int over_count;
    const char *csv;
    const char *plot;
    double tolerance;
    bool quiet;
} map_options;

static bool read_tolerance(const char *text, double *tolerance) {
    const char *end = text;
    *tolerance = decimal_read(text, &end);
    const bool good = end != text && *end == '\0' && *tolerance >= 1e-15 && *tolerance <= 1.0;
    if (!good) {
        fprintf(stderr,
                "whirl map: error: --tolerance takes a number from 1e-15 to 1, not '%.40s'\n"
                "hint: a part of the range that a coordinate has: --tolerance 1e-3\n",
                text);
    }
    return good;
}

static bool take_over(const char *text, map_options *o) {
    if (o->over_count == AXES) {
        fprintf(stderr, "whirl map: error: two --over, not also '%.60s'\n", text);
        return false;
    }
    o->over[o->over_count++] = text;
    return true;
}

/* `--over VALUE`, or `--over=VALUE`: which may be there twice. */
static bool take_axis(int count, char **words, int *at, map_options *o, bool *bad) {
    const size_t length = strlen("--over");
    const char *word = words[*at];
    if (strncmp(word, "--over", length) != 0 || (word[length] != '\0' && word[length] != '=')) {
        return false;
    }
    if (word[length] == '\0' && *at + 1 == count) {
        fputs("whirl map: error: --over needs a value\n", stderr);
        *bad = true;
        return true;
    }
    const char *value = word[length] == '=' ? word + length + 1 : words[++*at];
    ++*at;
    *bad = !take_over(value, o);
    return true;
}

static bool take_one(int count, char **words, int *at, map_options *o, bool *bad) {
    const char *value = NULL;
    if (take_axis(count, words, at, o, bad) ||
        options_take("map", usage.groups, count, words, at, &o->common, bad)) {
        return true;
    }
    if (!*bad && (value = options_value(count, words, at, "--tolerance", bad)) != NULL) {
        *bad = !read_tolerance(value, &o->tolerance);
    } else if (!*bad && (value = options_value(count, words, at, "--csv", bad)) != NULL) {
        o->csv = value;
    } else if (!*bad && (value = options_value(count, words, at, "--plot", bad)) != NULL) {
        o->plot = value;
    } else if (!*bad && strcmp(words[*at], "--quiet") == 0) {
        o->quiet = true;
        ++*at;
        return true;
    }
    return value != NULL;
}

/* Nothing is missing, and nothing contradicts. */
static bool is_whole(const map_options *o) {
    if (o->over_count < AXES) {
        fputs("whirl map: error: two --over are wanted\nhint: --over step=1ms..0.1s:20,log --over "
              "'k=1..100 [N/m]:20,log'\n",
              stderr);
        return false;
    }
    if (o->plot != NULL && !plot_can_draw(o->plot)) {
        fprintf(stderr, "whirl map: error: --plot draws .svg and .png files, not %s\n", o->plot);
        return false;
    }
    if (o->csv != NULL && o->plot != NULL && files_same(o->csv, o->plot)) {
        fputs("whirl map: error: --csv and --plot cannot share a file\n", stderr);
        return false;
    }
    if (o->common.number == &engine_fixed) {
        fputs("whirl map: error: --number is double or float here\nhint: fixed point has formats "
              "of its own for each pair; `whirl run --number fixed` tells of one\n",
              stderr);
        return false;
    }
    return true;
}

static bool read_options(int count, char **words, map_options *o) {
    bool bad = false;
    for (int at = 0; at < count && !bad;) {
        if (take_one(count, words, &at, o, &bad) || bad) {
            continue;
        }
        if (words[at][0] == '-' && words[at][1] != '\0') {
            options_unknown(
                "map", words[at], usage.groups,
                (const char *const[]){"--over", "--tolerance", "--csv", "--plot", "--quiet", NULL});
            return false;
        }
        if (o->target != NULL) {
            fprintf(stderr, "whirl map: error: one scene at a time, not also '%s'\n", words[at]);
            return false;
        }
        o->target = words[at++];
    }
    if (!bad && o->target == NULL) {
        options_usage(stderr, &usage);
        return false;
    }
    return !bad && is_whole(o);
}

static void show_progress(void *told, uint64_t done, uint64_t of) {
    (void)told;
    fprintf(stderr, "\r%llu of %llu runs ", (unsigned long long)done, (unsigned long long)of);
}

/* --- the answer -----------------------------------------------------------------------------------------*/

static bool write_rows(const char *file, const stability_map *m) {
    FILE *out = strcmp(file, "-") == 0 ? stdout : fopen(file, "wb");
    const bool good = out != NULL && map_csv(out, m);
    if (!good) {
        fprintf(stderr, "%s: error: cannot be written: %s\n", file, strerror(errno));
    }
    if (out != NULL && out != stdout) {
        fclose(out);
    }
    return good;
}

static int show(const map_options *o, const stability_map *m) {
    char how[200];
    snprintf(how, sizeof how, "%s, %s%s, tolerance %g",
             wh_methods[o->common.integration.method].word, o->common.number->name,
             o->common.integration.compensated ? " compensated" : "", o->tolerance);
    const map_words words = {o->target, how, o->tolerance};
    const bool standard = o->csv != NULL && strcmp(o->csv, "-") == 0;
    if (!o->quiet || (o->csv == NULL && o->plot == NULL)) {
        map_print(standard ? stderr : stdout, m, &words);
    }
    if (o->csv != NULL && !write_rows(o->csv, m)) {
        return EXIT_BAD_INPUT;
    }
    if (m->done < m->grid->points) {
        fprintf(stderr, "whirl map: interrupted after %llu of %llu runs\n",
                (unsigned long long)m->done, (unsigned long long)m->grid->points);
        return EXIT_INTERRUPTED;
    }
    if (map_count(m, MAP_NONE) == m->grid->points) {
        fputs("whirl map: error: no pair has a run\nhint: `whirl run` with the values of one tells "
              "why\n",
              stderr);
        return EXIT_RUN_FAILED;
    }
    return o->plot == NULL || map_plot(o->plot, m, &words) ? EXIT_DONE : EXIT_BAD_INPUT;
}

static int map_grid(const map_options *o, const mechanism *of, const scene *in,
                    const overrides *changes, const grid *g) {
    const bool progress = !o->quiet && isatty(STDERR_FILENO);
    const map_wish wish = {.grid = g,
                           .mechanism = of,
                           .scene = in,
                           .changes = changes,
                           .kind = o->common.number,
                           .settings = o->common.integration,
                           .tolerance = o->tolerance,
                           .stop = &interrupted,
                           .progress = progress ? show_progress : NULL};
    struct sigaction action = {.sa_handler = on_interrupt,
                               .sa_flags = SA_RESTART | (int)SA_RESETHAND};
    if (g->points > POINTS_MOST) {
        fprintf(stderr, "whirl map: error: %llu pairs, at most %d\nhint: fewer in each --over\n",
                (unsigned long long)g->points, POINTS_MOST);
        return EXIT_BAD_INPUT;
    }
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    stability_map m = map_make(&wish);
    if (progress) {
        fputs("\r                              \r", stderr);
    }
    const int code = show(o, &m);
    map_free(&m);
    return code;
}

static int map_source(const map_options *o, source_model *from) {
    const mechanism *of;
    const scene *in;
    int code = source_open(from, o->target);
    code = code == EXIT_DONE ? source_pick(from, true, &of, &in) : code;
    if (code != EXIT_DONE) {
        return code;
    }
    if (source_would_be_lost(from, "--csv", o->csv, "") ||
        source_would_be_lost(from, "--plot", o->plot, "") || !files_can_write(o->csv) ||
        !files_can_write(o->plot)) {
        return EXIT_BAD_INPUT;
    }
    grid g = {.command = "map"};
    bool good = true;
    for (int i = 0; i < AXES && good; i++) {
        good = grid_add(&g, of, o->over[i], from->errors);
    }
    diags_flush(from->errors, stderr);
    overrides changes = options_overrides(&o->common.change);
    changes.balance = true;
    /* what is wrong with every pair is told of the scene as it stands */
    const load_wish wish = {.settings = o->common.integration,
                            .use = IMAGE_TO_RUN,
                            .keep = KEEP_INSTANCE,
                            .conserve = true};
    loaded base;
    code = EXIT_BAD_INPUT;
    if (good) {
        code = load(&base, from, of, in, &changes, &wish);
        if (code == EXIT_DONE &&
            !start_has_method(base.image, o->common.integration.method, from->errors)) {
            diags_flush(from->errors, stderr);
            code = EXIT_BAD_INPUT;
        }
        unload(&base);
        code = code == EXIT_DONE ? map_grid(o, of, in, &changes, &g) : code;
    }
    grid_free(&g);
    return code;
}

int command_map(int count, char **words) {
    map_options o = {.common = options_defaults(), .tolerance = HORIZON_TOLERANCE};
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

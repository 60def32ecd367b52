/* plotting.c: `whirl plot`: curves of recorded or new runs in one picture. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "commands.h"
#include "files.h"
#include "host/base/alloc.h"
#include "host/io/gnuplot.h"
#include "run.h"
#include "target.h"

enum { RUNS_MOST = 64 };

static const command_usage usage = {
    .head =
        "usage: whirl plot FILE.csv|SCENE|FILE[:SCENE] ... --out FILE.svg|.pdf|.png [options]\n"
        "\n"
        "Curves of one run or of several over each other. A FILE.csv is of `whirl run --csv` or\n"
        "`whirl sweep --csv`, or any with a line of names. Scenes are run; they take the options of\n"
        "`whirl run` that change a scene or how it is integrated.\n"
        "\n"
        "  whirl plot light.csv heavy.csv --y \"X', theta\" --out both.svg\n"
        "\n"
        "  --out FILE           the picture, drawn by gnuplot: .svg, .pdf or .png\n" RUN_CHOICE_HELP
        "  --legend NAMES       of the runs, between commas, in place of their titles\n"
        "\n"
        "Crosses at the foot of a panel mark events. The shade begins where single values cannot be\n"
        "trusted any more (docs/plot.md).\n",
    .tail = "",
    .why = OPTIONS_WHY_DRAWS};

typedef struct plot_options {
    common_options common; /* the run parses these */
    plot_choice choice;
    const char *out;
    char **target; /* [targets] */
    int targets;
    char **passed; /* [1 + passed_count] for each scene, which is passed[0] */
    int passed_count;
} plot_options;

static bool is_csv(const char *name) {
    const size_t length = strlen(name);
    return length > 4 && options_same(name + length - 4, ".csv");
}

static void take_one(int count, char **words, int *at, plot_options *o, bool *bad) {
    static const char *const own[] = {RUN_CHOICE_WORDS, "--legend", "--out", NULL};
    const int from = *at;
    const char *value = NULL;
    if (run_take_choice("plot", count, words, at, &o->choice, bad) || *bad) {
        return;
    }
    if ((value = options_value(count, words, at, "--out", bad)) != NULL) {
        o->out = value;
    } else if (!*bad && (value = options_value(count, words, at, "--legend", bad)) != NULL) {
        o->choice.legend = value;
    } else if (!*bad && options_take("plot", OPTIONS_SCENE, count, words, at, &o->common, bad)) {
        for (int i = from; i < *at; i++) {
            o->passed[1 + o->passed_count++] = words[i];
        }
    } else if (!*bad && words[*at][0] == '-') {
        options_unknown("plot", words[*at], OPTIONS_SCENE, own);
        *bad = true;
    } else if (!*bad) {
        o->target[o->targets++] = words[(*at)++];
    }
}

/* "l=20cm" of --set l=20cm or --set=l=20cm, or of --start; NULL: another word. */
static const char *assigned(const plot_options *o, int i) {
    static const char *const options[] = {"--set", "--start"};
    for (int k = 0; k < 2; k++) {
        const size_t length = strlen(options[k]);
        if (strncmp(o->passed[i], options[k], length) == 0) {
            return o->passed[i][length] == '='                           ? o->passed[i] + length + 1
                   : o->passed[i][length] == '\0' && i < o->passed_count ? o->passed[i + 1]
                                                                         : NULL;
        }
    }
    return NULL;
}

/* Options apply to every scene, so no name can have two values. */
static bool sets_once(const plot_options *o) {
    for (int i = 1; i <= o->passed_count; i++) {
        for (int k = i + 1; k <= o->passed_count; k++) {
            const char *first = assigned(o, i);
            const char *second = assigned(o, k);
            const size_t length = first != NULL ? strcspn(first, "= ") : 0;
            const char *option = strncmp(o->passed[i], "--start", 7) == 0 ? "start" : "set";
            if (first != NULL && second != NULL && strcspn(second, "= ") == length &&
                strncmp(first, second, length) == 0) {
                fprintf(stderr,
                        "whirl plot: error: %.*s is given twice, and options change every scene\n"
                        "hint: record each run, then draw both:\n"
                        "  whirl run %s --%s \"%s\" --csv a.csv\n"
                        "  whirl run %s --%s \"%s\" --csv b.csv\n"
                        "  whirl plot a.csv b.csv --out %s\n",
                        (int)length, first, o->target[0], option, first, o->target[o->targets - 1],
                        option, second, o->out);
                return false;
            }
        }
    }
    return true;
}

/* Are the options complete and consistent? */
static bool is_whole(const plot_options *o) {
    bool scenes = false;
    for (int i = 0; i < o->targets; i++) {
        scenes = scenes || !is_csv(o->target[i]);
    }
    if (o->out == NULL) {
        fputs("whirl plot: error: no file for the picture\nhint: --out picture.svg\n", stderr);
        return false;
    }
    if (o->passed_count > 0 && !scenes) {
        fprintf(stderr,
                "whirl plot: error: %s changes a scene, and only files are named\n"
                "hint: whirl plot SCENE %s ... runs it\n",
                o->passed[1], o->passed[1]);
        return false;
    }
    if (o->targets > RUNS_MOST) {
        fprintf(stderr, "whirl plot: error: %d runs, at most %d\n", o->targets, RUNS_MOST);
        return false;
    }
    for (int i = 0; i < o->targets; i++) {
        if (files_same(o->target[i], o->out)) {
            fprintf(stderr, "whirl plot: error: --out would write over %s\n", o->out);
            return false;
        }
    }
    return sets_once(o) && gnuplot_can_draw_for("plot", "--out", o->out) && gnuplot_is_there();
}

static int draw_all(plot_options *o) {
    plot_run *runs = alloc(o->targets, sizeof *runs);
    int code = EXIT_DONE;
    int count = 0;
    while (count < o->targets && code == EXIT_DONE) {
        o->passed[0] = o->target[count];
        plot_run *to = &runs[count++];
        if (!is_csv(o->passed[0])) {
            code = run_to_take(1 + o->passed_count, o->passed, &o->choice, to);
        } else if (!plot_run_read("plot", o->passed[0], to)) {
            code = EXIT_BAD_INPUT;
        }
    }
    if (code == EXIT_DONE && !plot_draw("plot", o->out, &o->choice, runs, count)) {
        code = EXIT_BAD_INPUT;
    }
    for (int i = 0; i < count; i++) {
        plot_run_close(&runs[i]);
    }
    free(runs);
    return code;
}

int command_plot(int count, char **words) {
    if (options_help(count, words, &usage)) {
        return EXIT_DONE;
    }
    plot_options o = {.common = options_defaults(),
                      .target = alloc(count, sizeof *o.target),
                      .passed = alloc(count + 1, sizeof *o.passed)};
    bool bad = false;
    for (int at = 0; at < count && !bad;) {
        take_one(count, words, &at, &o, &bad);
    }
    int code = EXIT_BAD_INPUT;
    if (!bad && o.targets == 0) {
        options_usage(stderr, &usage);
    } else if (!bad && is_whole(&o)) {
        code = draw_all(&o);
    }
    options_forget(&o.common);
    free(o.target);
    free(o.passed);
    return code;
}

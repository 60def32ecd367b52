/* figure.c: `whirl plot` and `whirl figure`: curves of runs, and the figures of the dissertation. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "host/base/alloc.h"
#include "host/cli/commands.h"
#include "host/cli/load.h"
#include "host/cli/options.h"
#include "host/cli/run.h"
#include "host/io/plot.h"
#include "host/lang/builtin.h"
#include "host/os/system.h"

/* === whirl plot =============================================================================== */

enum { RUNS_MOST = 64 };

static const command_usage plot_usage = {
    .head =
        "usage: whirl plot FILE.csv|SCENE|FILE[:SCENE] ... --out FILE.svg|.pdf|.png [options]\n"
        "\n"
        "Draws one or several runs in one picture (docs/plot.md). FILE.csv is from `whirl run --csv` or\n"
        "`whirl sweep --csv`, or any CSV file with a line of names. Whirl runs the scenes, with those\n"
        "options of `whirl run` that change a scene or its integration.\n"
        "\n"
        "  whirl plot light.csv heavy.csv --y \"X', theta\" --out both.svg\n"
        "\n"
        "  --out FILE           the picture, drawn by gnuplot: .svg, .pdf or .png\n" RUN_CHOICE_HELP
        "  --legend NAMES       names of the runs, with commas between them, instead of their "
        "titles\n"
        "\n"
        "Crosses at the foot of a panel mark events. The shade begins at the trusted time of the run.\n",
    .why = {"", "a run failed", "", ""}};

typedef struct plot_options {
    common_options common; /* unused: each run parses its options from `passed` */
    plot_choice choice;
    const char *out;
    char **target; /* [targets] */
    int targets;
    char **passed; /* [1 + passed_count] words of a run; passed[0] is the scene */
    int passed_count;
} plot_options;

static bool is_csv(const char *name) {
    const size_t length = strlen(name);
    return length > 4 && strcasecmp(name + length - 4, ".csv") == 0;
}

static bool is_whole(const plot_options *o) {
    bool scenes = false;
    for (int i = 0; i < o->targets; i++) {
        scenes = scenes || !is_csv(o->target[i]);
    }
    if (o->out == NULL) {
        return options_fail("plot", "no file for the picture\nhint: --out picture.svg");
    }
    if (o->passed_count > 0 && !scenes) {
        return options_fail("plot",
                            "%s changes a scene, but the command names only files\n"
                            "hint: whirl plot SCENE %s ... runs it",
                            o->passed[1], o->passed[1]);
    }
    if (o->targets > RUNS_MOST) {
        return options_fail("plot", "the command names %d runs; the limit is %d", o->targets,
                            RUNS_MOST);
    }
    return true;
}

static int plot_work(void *options) {
    plot_options *o = options;
    if (!is_whole(o)) {
        return EXIT_BAD_INPUT;
    }
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
    plot_options o = {.common = options_defaults(),
                      .target = alloc(count, sizeof *o.target),
                      .passed = alloc(count + 1, sizeof *o.passed)};
    const char *last;
    const own_option own[] = {RUN_CHOICE_ROWS(o.choice),
                              {.word = "--legend", .text = &o.choice.legend},
                              {.word = "--out", .text = &o.out, .file = FILE_DRAWN},
                              {.word = NULL}};
    const target_reader reader = {.command = "plot",
                                  .usage = &plot_usage,
                                  .table = own,
                                  .many = o.target,
                                  .many_count = &o.targets,
                                  .passed = o.passed + 1,
                                  .passed_count = &o.passed_count,
                                  .work = plot_work};
    const int code = target_command(&reader, count, words, &o.common, &o, &last);
    free(o.target);
    free(o.passed);
    return code;
}

/* === whirl figure ============================================================================= */

enum { DATA_MOST = 16, WORDS_MOST = 64 };

static const command_usage usage = {
    .head =
        "usage: whirl figure NUMBER|FINDING|FILE.fig [options]\n"
        "\n"
        "Draws a figure of the dissertation (`whirl list --figures`), as it is or varied. Its runs take\n"
        "those options of `whirl run` that change a scene or its integration, such as --set m=2kg. A varied\n"
        "figure does not mark the dissertation's values.\n"
        "\n"
        "  whirl figure 51 --set=M=-1\n"
        "\n"
        "  --out FILE           the picture: .svg, .pdf or .png (default: figNUMBER.svg)\n"
        "  --data NAME=FILE     use these records as NAME instead of a run (repeatable)\n",
    .why = {"", "a run failed", "", ""}};

typedef struct figure_options {
    common_options common; /* unused: each run parses its options from `passed` */
    const char *name;
    const char *out;
    const char *given[DATA_MOST]; /* NAME=FILE */
    int given_count;
    char **passed; /* [passed_count] words for every run */
    int passed_count;
    char *varied; /* the passed words as one text, with a blank before each word */
} figure_options;

/* Splits a built-in description into words by the shell's rules, in place. */
static int words_of(char *line, char **word) {
    int count = 0;
    char *to = line;
    for (char *at = line; *at != '\0' && count < WORDS_MOST;) {
        word[count++] = to;
        for (char quote = '\0'; *at != '\0' && (quote != '\0' || *at != ' '); at++) {
            if (*at == quote || (quote == '\0' && (*at == '\'' || *at == '"'))) {
                quote = quote == '\0' ? *at : '\0';
            } else {
                *to++ = *at;
            }
        }
        at += strspn(at, " ");
        *to++ = '\0';
    }
    return count;
}

static const char *given_for(const figure_options *o, const char *name) {
    for (int i = 0; i < o->given_count; i++) {
        if (options_is(o->given[i], name)) {
            return o->given[i] + strlen(name) + 1;
        }
    }
    return NULL;
}

/* Does the command line replace the option at word[at] of a figure? --with and --without are never replaced. */
static bool is_replaced(const figure_options *o, char **word, int at, int count) {
    char *option = alloc_copy(word[at], strcspn(word[at], "="));
    const char *value = options_value(count, word, at, option);
    const bool named = strcmp(option, "--set") == 0 || strcmp(option, "--start") == 0;
    const size_t length = named ? strcspn(value, "= ") : 0;
    bool is = false;
    for (int i = 0; option[0] == '-' && i < o->passed_count; i++) {
        if (options_is(o->passed[i], option) && strncmp(option, "--with", 6) != 0) {
            const char *given = options_value(o->passed_count, o->passed, i, option);
            is = is || (strncmp(given, value, length) == 0 &&
                        (!named || strchr("= ", given[length]) != NULL));
        }
    }
    free(option);
    return is;
}

/* Makes the records that a line `kind NAME WORDS` of the figure's description asks for. */
static int make_data(const figure_options *o, const char *kind, char **word, int count,
                     figure_data *data) {
    char folder[] = "/tmp/whirl-figure-XXXXXX";
    static char csv_word[] = "--csv";
    static char strict_word[] = "--strict=off"; /* findings must not stop the figure */
    if (kind[0] == 't') {
        fprintf(stderr,
                "whirl figure: error: the records '%s' come from mk/figures/%s, which whirl cannot "
                "run\nhint: run `make figures`, or use --data %s=FILE.csv\n",
                word[0], word[1], word[0]);
        return EXIT_BAD_INPUT;
    }
    if (!system_scratch_folder(folder)) {
        perror("whirl figure: error: cannot make a temporary folder");
        return EXIT_RUN_FAILED;
    }
    char *file = alloc_words("%s/records.csv", folder);
    char **all = alloc(count + o->passed_count + 3, sizeof *all);
    int n = 0;
    for (int i = 1; i < count; i++) {
        if (!is_replaced(o, word, i, count)) {
            all[n++] = word[i];
        } else if (strchr(word[i], '=') == NULL && i + 1 < count && word[i + 1][0] != '-') {
            i++;
        }
    }
    for (int i = 0; i < o->passed_count; i++) {
        all[n++] = o->passed[i];
    }
    all[n++] = strict_word;
    all[n++] = csv_word;
    all[n++] = file;
    plot_run taken = {0};
    const int code =
        kind[0] == 'r' ? run_to_take(n, all, &(plot_choice){0}, &taken) : command_sweep(n, all);
    data->trusted_s = taken.trusted_s;
    plot_run_close(&taken);
    size_t length;
    data->csv = code == EXIT_DONE ? read_all(file, RECORDS_BYTES_MAX, &length) : NULL;
    static const char *const ends[] = {"", ".toml", ".sweep"};
    for (size_t i = 0; i < sizeof ends / sizeof ends[0]; i++) {
        char *left = alloc_words("%s%s", file, ends[i]);
        (void)unlink(left);
        free(left);
    }
    (void)rmdir(folder);
    free(file);
    free(all);
    return code == EXIT_DONE && data->csv == NULL ? EXIT_RUN_FAILED : code;
}

static int take_data(const figure_options *o, const char *text, figure_data *data, int *count) {
    static const char *const kinds[] = {"run", "sweep", "table"};
    int code = EXIT_DONE;
    for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++) {
        const char *at = text;
        for (char *line;
             code == EXIT_DONE && *count < DATA_MOST && (line = figure_line(&at, kinds[k])) != NULL;
             free(line)) {
            char *word[WORDS_MOST] = {NULL};
            const int words = words_of(line, word);
            figure_data *d = &data[(*count)++];
            d->name = alloc_words("%s", word[0]);
            const char *given = given_for(o, d->name);
            size_t length;
            if (given != NULL) {
                d->csv = read_all(given, RECORDS_BYTES_MAX, &length);
                code = d->csv != NULL ? EXIT_DONE : EXIT_BAD_INPUT;
            } else {
                code = make_data(o, kinds[k], word, words, d);
            }
        }
    }
    return code;
}

/* `name` is "51", "fig51" or "finding_spin" (mk/figures). */
static const struct builtin_model *figure_named(const char *name) {
    const struct builtin_model *found = NULL;
    char *file = alloc_words("/%s.fig", name);
    char *numbered = alloc_words("/fig%s.fig", name);
    for (size_t i = 0; i < builtin_figure_count && found == NULL; i++) {
        const char *own = strrchr(builtin_figures[i].file, '/');
        found = strcmp(own, file) == 0 || strcmp(own, numbered) == 0 ? &builtin_figures[i] : NULL;
    }
    free(file);
    free(numbered);
    return found;
}

static int draw(const figure_options *o, const char *where, const char *text) {
    figure_data data[DATA_MOST] = {{0}};
    int count = 0;
    char *out = o->out != NULL                  ? alloc_words("%s", o->out)
                : strncmp(o->name, "f", 1) == 0 ? alloc_words("%s.svg", o->name)
                                                : alloc_words("fig%s.svg", o->name);
    int code = o->out != NULL || options_can_write("figure", "--out", FILE_DRAWN, out)
                   ? take_data(o, text, data, &count)
                   : EXIT_BAD_INPUT;
    if (code == EXIT_DONE && !figure_draw(out, where, text, data, count, o->varied)) {
        code = EXIT_BAD_INPUT;
    }
    if (code == EXIT_DONE && o->out == NULL) {
        puts(out);
    }
    for (int i = 0; i < count; i++) {
        free(data[i].name);
        free(data[i].csv);
    }
    free(out);
    return code;
}

static int figure_work(void *options) {
    figure_options *o = options;
    for (int i = 0; i < o->given_count; i++) {
        if (strchr(o->given[i], '=') == NULL) {
            fprintf(stderr, "whirl figure: error: --data takes NAME=FILE, not '%.60s'\n",
                    o->given[i]);
            return EXIT_BAD_INPUT;
        }
    }
    for (int i = 0; i < o->passed_count; i++) {
        char *longer = alloc_words("%s %s", o->varied, o->passed[i]);
        free(o->varied);
        o->varied = longer;
    }
    const size_t length = strlen(o->name);
    if (length > 4 && strcmp(o->name + length - 4, ".fig") == 0) {
        if (o->out == NULL) {
            fputs("whirl figure: error: no file for the picture\nhint: --out figure.svg\n", stderr);
            return EXIT_BAD_INPUT;
        }
        size_t size;
        char *text = read_all(o->name, MODEL_BYTES_MAX, &size);
        const int code = text != NULL ? draw(o, o->name, text) : EXIT_BAD_INPUT;
        free(text);
        return code;
    }
    const struct builtin_model *figure = figure_named(o->name);
    if (figure == NULL) {
        fprintf(stderr,
                "whirl figure: error: no figure is called '%.60s'\n"
                "hint: `whirl list --figures` lists them\n",
                o->name);
        return EXIT_BAD_INPUT;
    }
    return draw(o, figure->file, figure->text);
}

int command_figure(int count, char **words) {
    figure_options o = {.common = options_defaults(),
                        .passed = alloc(count, sizeof *o.passed),
                        .varied = alloc_words("%s", "")};
    const own_option own[] = {
        {.word = "--out", .text = &o.out, .file = FILE_DRAWN},
        {.word = "--data", .text = o.given, .count = &o.given_count, .limit = DATA_MOST},
        {.word = NULL}};
    const target_reader reader = {.command = "figure",
                                  .usage = &usage,
                                  .table = own,
                                  .passed = o.passed,
                                  .passed_count = &o.passed_count,
                                  .one = "figure",
                                  .work = figure_work};
    const int code = target_command(&reader, count, words, &o.common, &o, &o.name);
    free(o.passed);
    free(o.varied);
    return code;
}

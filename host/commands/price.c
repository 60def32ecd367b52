/* price.c: `whirl price`: error against price, for all settings of a scene. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "commands.h"
#include "files.h"
#include "host/base/written.h"
#include "host/price/measured.h"
#include "interrupts.h"
#include "pricing.h"

static const char head[] =
    "usage: whirl price SCENE|MECHANISM[:SCENE]|FILE[:SCENE] [options]\n"
    "\n"
    "Tries methods, numbers, forms, matrices, tables and many steps on a scene, as far as it takes\n"
    "them, and prints how far each is off a reference of higher precision, beside what it costs on a\n"
    "board: cycles a simulated second, or instructions if cycles are not counted there; flash, RAM and\n"
    "stack. It shows at most 12 rows of the front: no other row is as cheap and errs less. Each figure\n"
    "has a letter that tells how it is known.\n"
    "What is run is named as for `whirl run`.\n"
    "\n";
static const char tail[] =
    "  --all                every row\n"
    "  --csv FILE           every row, with the command lines that do it again; - is standard output\n"
    "                       (the table then goes to standard error)\n"
    "  --measure            count what is on the front instead of predicting it: in Whirl's source\n"
    "                       tree, where the board's compiler and emulator are; takes minutes\n"
    "  --quiet              no table, no progress\n"
    "\n";
static const char *const own[] = {"--all", "--csv", "--measure", NULL};

static void print_help(FILE *out) {
    const command_usage common = {.head = "", .groups = PRICING_GROUPS, .tail = ""};
    const command_usage end = {
        .head = "",
        .tail = "",
        .why = {
            [EXIT_ROW_OF(EXIT_DONE)] = "",
            [EXIT_ROW_OF(EXIT_RUN_FAILED)] =
                "there is no reference that could be trusted, no setting that keeps to the motion,\n"
                "       none with a price, or none within --error",
            [EXIT_ROW_OF(EXIT_BAD_INPUT)] = "",
            [EXIT_ROW_OF(EXIT_INTERRUPTED)] = ""}};
    fputs(head, out);
    pricing_describe(out);
    fputs(tail, out);
    options_usage(out, &common);
    options_usage(out, &end);
}

typedef struct price_options {
    pricing_options common;
    const char *csv;
    bool all;
    bool measure;
} price_options;

static bool take_own(int count, char **words, int *at, price_options *o, bool *bad) {
    if (strcmp(words[*at], "--all") == 0) {
        o->all = true;
        ++*at;
        return true;
    }
    if (strcmp(words[*at], "--measure") == 0) {
        o->measure = true;
        ++*at;
        return true;
    }
    const char *value = options_value(count, words, at, "--csv", bad);
    o->csv = value != NULL ? value : o->csv;
    return value != NULL || *bad;
}

static bool take_one(int count, char **words, int *at, void *options, bool *bad) {
    price_options *o = options;
    return take_own(count, words, at, o, bad) || pricing_take(count, words, at, &o->common, bad);
}

static void show_progress(void *context, int done, int of) {
    (void)context;
    fprintf(stderr, "\r%3d of %d settings ", done, of);
}

static bool write_csv(const char *file, const trials *t, const table *made,
                      const table_words *words) {
    FILE *out = written_open(file);
    if (out != NULL) {
        table_csv(out, t, made, words);
    }
    return out != NULL && written_close(out, file, true);
}

/* The cheapest row that keeps the error, in words. */
static int say_cheapest(FILE *out, const pricing *p, const table *made, const table_words *words) {
    for (int i = 0; i < made->count; i++) {
        const table_row *row = &made->row[i];
        if (trial_error_si(&p->trial, row->result.error) <= p->error_si) {
            char *line =
                table_run_line(&p->trial, &row->setting, row->pace, row->result.point, words);
            fprintf(out, "the cheapest within %s: %.2e %s\n  %s\n",
                    p->options->value[PRICING_ERROR], row->result.error, trial_unit(&p->trial),
                    line);
            free(line);
            return EXIT_DONE;
        }
    }
    fprintf(stderr, "whirl price: nothing that was tried errs by less than %s\n",
            p->options->value[PRICING_ERROR]);
    return EXIT_RUN_FAILED;
}

static int show(const price_options *o, pricing *p, const table *made) {
    const table_words words = {p->target, p->words, o->all, p->effort};
    FILE *out = o->csv != NULL && strcmp(o->csv, "-") == 0 ? stderr : stdout;
    if (!o->common.quiet) {
        table_print(out, &p->trial, made, &words);
    }
    if (!p->trial.reliable || made == NULL || made->count == 0) {
        fprintf(stderr, "whirl price: error: no error of '%s' is known%s\n", p->options->target,
                p->trial.reliable ? ": no setting has a row" : ", without a reference to trust");
        return EXIT_RUN_FAILED;
    }
    if (o->csv != NULL && !write_csv(o->csv, &p->trial, made, &words)) {
        return EXIT_BAD_INPUT;
    }
    return p->asks_error ? say_cheapest(out, p, made, &words) : EXIT_DONE;
}

static int count_front(pricing *p, table *made, const table_wish *w) {
    const table_words words = {p->target, p->words, false, p->effort};
    const measured_end end = measured_front(&p->trial, made, &words, w);
    if (end == MEASURED_MISSING) {
        pricing_says_missing(p, "a tool is missing");
    }
    p->trial.stopped = p->trial.stopped || interrupted;
    return end == MEASURED_MISSING ? EXIT_BAD_INPUT : EXIT_DONE;
}

static bool can_measure(const pricing *p) {
    char text[MEASURED_TEXT];
    const char *missing = measured_missing(NULL, p->board, text);
    if (missing != NULL) {
        pricing_says_missing(p, missing);
    }
    return missing == NULL;
}

static int price_scene(const price_options *o, pricing *p) {
    const bool progress = !o->common.quiet && isatty(STDERR_FILENO);
    if (source_would_be_lost(&p->from, "--csv", o->csv, "") || !written_can(o->csv) ||
        (o->measure && !can_measure(p))) {
        return EXIT_BAD_INPUT;
    }
    interrupts_catch();
    if (progress) {
        fputs("\rthe reference   ", stderr);
    }
    int code = pricing_begin(p, pricing_spacing(p->until_s, PRICING_RECORDS), &interrupted);
    table *made = NULL;
    if (code == EXIT_DONE && p->trial.reliable && !p->trial.stopped) {
        table_wish wish = pricing_wish(p);
        wish.progress = progress ? show_progress : NULL;
        made = table_new(&p->trial, &wish);
        code = o->measure && !p->trial.stopped ? count_front(p, made, &wish) : code;
    }
    if (progress) {
        fputs("\r                    \r", stderr);
    }
    if (code == EXIT_DONE && p->trial.stopped) {
        fputs("whirl price: interrupted\n", stderr);
        code = EXIT_INTERRUPTED;
    } else if (code == EXIT_DONE) {
        code = show(o, p, made);
    }
    table_free(made);
    return code;
}

int command_price(int count, char **words) {
    if (options_wants_help(count, words)) {
        print_help(stdout);
        return EXIT_DONE;
    }
    price_options o = {.common = pricing_defaults("price", count)};
    int code = EXIT_BAD_INPUT;
    if (pricing_read(count, words, own, take_one, &o, &o.common)) {
        pricing p;
        code = pricing_open(&p, &o.common);
        if (code == EXIT_DONE) {
            code = price_scene(&o, &p);
        }
        pricing_close(&p);
    }
    pricing_forget(&o.common);
    return code;
}

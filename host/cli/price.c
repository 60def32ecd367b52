/* price.c: `whirl price`: error against price, for all settings of a scene. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "commands.h"
#include "host/cli/load.h"
#include "host/io/plot.h"
#include "host/os/atomic_file.h"
#include "host/os/system.h"
#include "host/study/price_table.h"
#include "pricing.h"

static const char head[] =
    "usage: whirl price SCENE|MECHANISM[:SCENE]|FILE[:SCENE] [options]\n"
    "\n"
    "Tries methods, number types, forms, matrices, tables and many step sizes on a scene\n"
    "(docs/price.md). Prints the error of each, compared with a reference of higher precision, and its\n"
    "cost on a board: cycles a simulated second, flash, RAM and stack. Boards without cycle counts have\n"
    "instructions. The table has at most 12 rows of the Pareto front. A letter after each figure shows\n"
    "its source.\n"
    "\n";

static bool write_csv(const char *file, const trials *t, const table *made,
                      const table_words *words) {
    FILE *out = atomic_file_open(file);
    if (out != NULL) {
        table_csv(out, t, made, words);
    }
    return out != NULL && plot_run_csv_end(out, file, true, "price", t->image[0]->name);
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

static int show(pricing *p, const table *made) {
    const char *const *value = p->options->value;
    const char *csv = value[PRICING_CSV];
    const table_words words = {p->target, p->words, value[PRICING_ALL] != NULL, p->effort};
    const bool is_json = value[PRICING_JSON] != NULL;
    FILE *out = is_json || (csv != NULL && strcmp(csv, "-") == 0) ? stderr : stdout;
    if (value[PRICING_QUIET] == NULL && !is_json) {
        table_print(out, &p->trial, made, &words);
    }
    if (!p->trial.reliable || made == NULL || made->count == 0) {
        fprintf(stderr, "whirl price: error: no error of '%s' is known%s\n", p->options->target,
                p->trial.reliable ? ": no setting has a row" : ", without a reference to trust");
        return EXIT_RUN_FAILED;
    }
    if (csv != NULL && !write_csv(csv, &p->trial, made, &words)) {
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

static int price_scene(pricing *p) {
    const char *csv = p->options->value[PRICING_CSV];
    const bool measure = p->options->value[PRICING_MEASURE] != NULL;
    const table_wish wish = pricing_wish(p);
    if (p->options->value[PRICING_JSON] != NULL && csv != NULL && strcmp(csv, "-") == 0) {
        fputs("whirl price: error: --json and rows cannot share standard output\n"
              "hint: --csv rows.csv\n",
              stderr);
        return EXIT_BAD_INPUT;
    }
    if (source_would_be_lost(&p->from, "--csv", csv, "") || !atomic_file_can(csv) ||
        (measure && !can_measure(p))) {
        return EXIT_BAD_INPUT;
    }
    interrupts_catch();
    if (wish.progress != NULL) {
        fputs("\rthe reference   ", stderr);
    }
    int code = pricing_begin(p, pricing_spacing(p->until_s, PRICING_RECORDS));
    table *made = NULL;
    if (code == EXIT_DONE && p->trial.reliable && !p->trial.stopped) {
        made = table_new(&p->trial, &wish);
        code = measure && !p->trial.stopped ? count_front(p, made, &wish) : code;
    }
    if (wish.progress != NULL) {
        fputs("\r                    \r", stderr);
    }
    if (code == EXIT_DONE && p->trial.stopped) {
        code = EXIT_INTERRUPTED;
    } else if (code == EXIT_DONE) {
        code = show(p, made);
        if (p->options->value[PRICING_JSON] != NULL) {
            const table_words words = {p->target, p->words, true, p->effort};
            table_json(stdout, &p->trial, made, &words, code);
        }
    }
    table_free(made);
    return code;
}

int command_price(int count, char **words) {
    static const pricing_command price = {
        "price", PRICING_PRICE, head,
        "there is no reference that could be trusted, no setting that keeps to the motion,\n"
        "       none with a price, or none within --error",
        price_scene};
    return pricing_run(&price, count, words);
}

/* choose.c: `whirl choose`: the settings that keep an error on a board with the fewest cycles and the least flash. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "commands.h"
#include "host/number/decimal.h"
#include "host/number/functions.h"
#include "host/os/system.h"
#include "host/study/choice.h"
#include "host/study/price_table.h"
#include "pricing.h"

/* Least records to the horizon; the most are two and a half times as many. */
#define RECORDS 1000.0
#define RECORDS_MOST 2500.0
static const char head[] =
    "usage: whirl choose SCENE|MECHANISM[:SCENE]|FILE[:SCENE] --error E [options]\n"
    "\n"
    "Finds two settings of method, number type, form and step that keep an error on a board with a\n"
    "margin of 2: the one with the fewest cycles, and the one with the least flash. Prints their costs,\n"
    "and the commands that run, generate and count them.\n"
    "\n"
    "In Whirl's source tree, with the board's compiler and emulator, the steps are counted. Elsewhere\n"
    "they are predicted; a scene with contacts then has no answer.\n"
    "\n";

static bool fits(const pricing *p) {
    if (p->options->value[PRICING_MEASURE] != NULL && p->options->value[PRICING_PREDICT] != NULL) {
        fputs("whirl choose: error: --measure and --predict: one of the two\n", stderr);
        return false;
    }
    if (!p->asks_error) {
        fputs("whirl choose: error: --error is missing: without it, the cheapest step is none\n"
              "hint: such as --error 1e-3, a part of the largest value, or --of X --error 0.1mm\n",
              stderr);
    }
    return p->asks_error;
}

/* "32KB", "2048", "1 MiB": bytes. */
static bool read_bytes(const char *option, const char *text, double *bytes) {
    static const struct {
        const char *word;
        double bytes;
    } units[] = {{"", 1.0},         {"B", 1.0},         {"K", 1024.0},   {"k", 1024.0},
                 {"KB", 1024.0},    {"kB", 1024.0},     {"KiB", 1024.0}, {"M", 1048576.0},
                 {"MB", 1048576.0}, {"MiB", 1048576.0}, {"bytes", 1.0}};
    const char *rest;
    const double number = decimal_read(text, &rest);
    const bool begins = rest != text;
    rest += strspn(rest, " ");
    for (size_t i = 0; begins && i < sizeof units / sizeof units[0]; i++) {
        if (strcmp(rest, units[i].word) == 0) {
            *bytes = number * units[i].bytes;
            if (*bytes > 0.0 && isfinite(*bytes)) {
                return true;
            }
        }
    }
    fprintf(stderr,
            "whirl choose: error: %s takes a number of bytes above zero, not %s\n"
            "hint: such as 32KB, or 32768\n",
            option, text);
    return false;
}

static bool read_limits(const pricing *p, choice_wish *w) {
    const dimension per_s = dim_of(0, 0, -1, 0, 0);
    const char *const *v = p->options->value;
    w->clock_Hz = p->board->clock_Hz;
    w->flash_bytes = (double)p->board->flash_bytes;
    w->ram_bytes = (double)p->board->ram_bytes;
    return (v[PRICING_RATE] == NULL ||
            pricing_quantity("choose", p->of, NULL, "--rate", v[PRICING_RATE], per_s,
                             &w->table.rate_Hz)) &&
           (v[PRICING_CLOCK] == NULL || pricing_quantity("choose", p->of, NULL, "--clock",
                                                         v[PRICING_CLOCK], per_s, &w->clock_Hz)) &&
           (v[PRICING_FLASH] == NULL || read_bytes("--flash", v[PRICING_FLASH], &w->flash_bytes)) &&
           (v[PRICING_RAM] == NULL || read_bytes("--ram", v[PRICING_RAM], &w->ram_bytes));
}

/* Spaces the records by whole periods, 1, 2, 5, 10, ..., below the most records; false if the horizon is
 * shorter than a period. */
static bool space_records(const pricing *p, choice_wish *w, whole_ratio *spacing) {
    w->table.periods = 1;
    if (!(w->table.rate_Hz > 0.0)) {
        *spacing = pricing_spacing(p->until_s, RECORDS);
        return true;
    }
    const whole_ratio rate =
        w->table.rate_Hz < 1e15 ? ratio_of(w->table.rate_Hz) : (whole_ratio){0, 1};
    static const uint64_t mantissa[] = {1, 2, 5};
    uint64_t periods = 1;
    for (int i = 0; p->until_s * w->table.rate_Hz / (double)periods > RECORDS_MOST && i < 36; i++) {
        periods = mantissa[(i + 1) % 3];
        for (int k = (i + 1) / 3; k > 0; k--) {
            periods *= 10;
        }
    }
    w->table.periods = periods;
    const uint64_t common = ratio_divisor(periods, rate.numerator);
    *spacing = (whole_ratio){rate.denominator * (periods / common), rate.numerator / common};
    if (rate.numerator == 0 && w->table.rate_Hz > 1.0) {
        fprintf(stderr, "whirl choose: error: --rate %.9g Hz is more than any step can follow\n",
                w->table.rate_Hz);
        return false;
    }
    if (rate.numerator == 0 || p->until_s * w->table.rate_Hz < 1.0 - 1e-9) {
        fprintf(stderr,
                "whirl choose: error: not one period of --rate %.9g Hz lies in %.9g s of motion\n"
                "hint: a later --until, or a higher rate\n",
                w->table.rate_Hz, p->until_s);
        return false;
    }
    return true;
}

/* --error in the unit of the trial's errors. */
static double allowed_of(const pricing *p) { return p->error_si / trial_error_si(&p->trial, 1.0); }

static void show_counting(void *context, int counted) {
    (void)context;
    fprintf(stderr, "\rcounting on the board: %d so far ", counted);
}

static const char prices_counted[] =
    "counted on the board: of what is named, its step or its whole run, and its bytes";
static const char prices_asked[] = "predicted, as --predict asks for";

enum { PRICES_TEXT = 64 + MEASURED_TEXT };
static const char *predicted_since(const char *missing, char text[PRICES_TEXT]) {
    snprintf(text, PRICES_TEXT, "predicted, since nothing can be counted: %s", missing);
    return text;
}

/* A run with contacts, without a predicted cost. */
static int says_contacts(const pricing *p, const char *missing) {
    fprintf(stderr,
            "whirl choose: error: the cost of contacts must be counted: %s\n"
            "hint: whirl price %s%s shows errors and evaluations without that\n",
            missing, p->target, p->words);
    return EXIT_RUN_FAILED;
}

static int choose_from(pricing *p, choice_wish *w, bool counts) {
    const table_words words = {p->target, p->words, false, p->effort};
    w->table.error = allowed_of(p);
    w->counts = counts;
    p->trial.tolerated = w->table.error;
    p->trial.without_events = p->trial.image[0]->contacts > 0;
    table *made = table_new(&p->trial, &w->table);
    choice c = choice_make(&p->trial, made, w);
    int code = EXIT_DONE;
    if (counts && !p->trial.stopped &&
        choice_counted(&p->trial, made, w, &words, &c) == MEASURED_MISSING) {
        if (p->options->value[PRICING_MEASURE] != NULL) {
            pricing_says_missing(p, "a tool is missing");
            code = EXIT_BAD_INPUT;
        } else if (p->trial.without_events) {
            code = says_contacts(p, "a tool is missing");
        }
        w->counts = false;
        w->prices = "predicted, since a tool is missing that counts";
        c = choice_make(&p->trial, made, w);
    }
    if (w->table.progress != NULL) {
        fputs("\r                                        \r", stderr);
    }
    if (code == EXIT_DONE && p->trial.stopped) {
        code = EXIT_INTERRUPTED;
    } else if (code == EXIT_DONE) {
        const double horizon_s = trial_horizon_s(&p->trial);
        const bool is_short = c.fastest.row >= 0 && horizon_s < 0.5 * p->until_s;
        code = c.fastest.row >= 0 && !is_short ? EXIT_DONE : EXIT_RUN_FAILED;
        if (p->options->value[PRICING_JSON] != NULL) {
            choice_json(stdout, &p->trial, made, w, &c, &words, code);
        } else {
            choice_print(stdout, &p->trial, made, w, &c, &words);
        }
        if (is_short) {
            fprintf(stderr,
                    "whirl choose: error: errors are known until t = %.6g s only, less than half "
                    "of %.6g s\n"
                    "hint: --horizon %.6gs asks for no more\n",
                    horizon_s, p->until_s, horizon_s);
        }
    }
    table_free(made);
    return code;
}

/* The reason why nothing is counted, or NULL; and the statement about prices. */
typedef struct basis {
    const char *missing;
    char text[MEASURED_TEXT];
    char told[PRICES_TEXT];
} basis;

static bool predicts(const pricing *p) { return p->options->value[PRICING_PREDICT] != NULL; }

/* EXIT_BAD_INPUT: --measure is impossible. */
static int look_for_tools(const pricing *p, basis *b) {
    b->missing =
        predicts(p) ? "" : measured_missing(p->has_trial ? &p->trial : NULL, p->board, b->text);
    if (p->options->value[PRICING_MEASURE] != NULL && b->missing != NULL) {
        pricing_says_missing(p, b->missing);
        return EXIT_BAD_INPUT;
    }
    return EXIT_DONE;
}

static int choose_begun(pricing *p, choice_wish *w) {
    basis b;
    if (p->trial.stopped) {
        return EXIT_INTERRUPTED;
    }
    if (!p->trial.reliable) {
        figure_reference(stderr, &p->trial);
        return EXIT_RUN_FAILED;
    }
    if (w->table.progress != NULL && !predicts(p)) {
        fputs("\rbuilding what counts ", stderr);
    }
    const int code = look_for_tools(p, &b);
    if (code != EXIT_DONE) {
        return code;
    }
    if (b.missing != NULL && p->trial.image[0]->contacts > 0) {
        return says_contacts(p, predicts(p) ? "leave out --predict" : b.missing);
    }
    w->prices = b.missing == NULL ? prices_counted
                : predicts(p)     ? prices_asked
                                  : predicted_since(b.missing, b.told);
    const int done = choose_from(p, w, b.missing == NULL);
    w->prices = NULL; /* `b` may hold it */
    return done;
}

static int choose_scene(pricing *p) {
    choice_wish w = {.table = pricing_wish(p)};
    whole_ratio spacing;
    basis early;
    if (!fits(p) || !read_limits(p, &w) || !space_records(p, &w, &spacing) ||
        (p->options->value[PRICING_MEASURE] != NULL && look_for_tools(p, &early) != EXIT_DONE)) {
        return EXIT_BAD_INPUT;
    }
    w.counting = w.table.progress != NULL ? show_counting : NULL;
    interrupts_catch();
    const int code = pricing_begin(p, spacing);
    return code == EXIT_DONE ? choose_begun(p, &w) : code;
}

int command_choose(int count, char **words) {
    static const pricing_command choose = {
        "choose", PRICING_CHOOSE, head,
        "nothing fits (it says what would, and how many settings were left), or there is no\n"
        "       reference that could be trusted",
        choose_scene};
    return pricing_run(&choose, count, words);
}

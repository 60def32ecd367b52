/* pricing.c: `whirl price` and `whirl choose`. Both use the table of error and cost of host/study/price_table.h. */
#include "pricing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "commands.h"
#include "host/base/alloc.h"
#include "host/engine/start.h"
#include "host/io/plot.h"
#include "host/lang/override.h"
#include "host/lang/value.h"
#include "host/number/decimal.h"
#include "host/number/functions.h"
#include "host/os/atomic_file.h"
#include "host/os/jobs.h"
#include "host/os/system.h"
#include "host/study/choice.h"
#include "host/study/price_table.h"

/* === options and the scene ==================================================================== */

typedef struct pricing_command {
    const char *name;   /* "price" */
    unsigned bit;       /* PRICING_PRICE or PRICING_CHOOSE */
    const char *head;   /* head of the help text */
    const char *failed; /* why the exit status may be 1 */
    int (*work)(void *options);
} pricing_command;

typedef struct pricing_row {
    unsigned commands;
    const char *word;
    const char *value;
    const char *text;
} pricing_row;

#define ROW(id, who, word, value, text) [id] = {PRICING_##who, word, value, text},
static const pricing_row option_rows[PRICING_OPTIONS] = {PRICING_OPTION_ROWS(ROW)};
#undef ROW

pricing pricing_defaults(const char *command, int word_count) {
    return (pricing){.command = command,
                     .common = options_defaults(),
                     .value = {[PRICING_BOARD] = COST_BOARD_DEFAULT},
                     .vary = alloc(word_count, sizeof(const char *))};
}

static int run_command(const pricing_command *c, int count, char **words) {
    pricing p = pricing_defaults(c->name, count);
    own_option own[PRICING_OPTIONS + 1] = {{.word = NULL}};
    int all = 0;
    char *head;
    FILE *out = alloc_text(&head, NULL);
    fputs(c->head, out);
    for (int i = 0; i < PRICING_OPTIONS; i++) {
        const pricing_row *row = &option_rows[i];
        if ((row->commands & c->bit) != 0) {
            own[all++] = (own_option){.word = row->word,
                                      .text = i == PRICING_VARY ? p.vary : &p.value[i],
                                      .file = i == PRICING_CSV ? FILE_WRITTEN_LATE : FILE_NONE,
                                      .count = i == PRICING_VARY ? &p.vary_count : NULL,
                                      .is_bare = row->value == NULL};
            options_describe(out, row->word, row->value != NULL ? row->value : "", row->text);
        }
    }
    fputc('\n', out);
    alloc_text_end(out);
    const command_usage usage = {
        .head = head, .groups = PRICING_GROUPS, .tail = "", .why = {"", c->failed, "", ""}};
    const target_reader reader = {
        .command = c->name, .usage = &usage, .table = own, .work = c->work};
    const int code = target_command(&reader, count, words, &p.common, &p, &p.typed);
    if (code == EXIT_INTERRUPTED) {
        fprintf(stderr, "whirl %s: interrupted\n", c->name);
    }
    pricing_close(&p);
    free(head);
    return code;
}

static void says_missing(const pricing *p, const char *why) {
    fprintf(
        stderr,
        "whirl %s: error: --measure: whirl cannot count costs on %s: %s\n"
        "hint: leave out --measure to predict costs, or run `make deps` to install compilers and emulators\n",
        p->command, p->board->name, why);
}

/* --- the scene -------------------------------------------------------------------------------------*/

bool pricing_quantity(const char *command, const mechanism *of, const char *name, const char *what,
                      const char *text, dimension wanted, double *value) {
    struct arena *arena = arena_new();
    diags *errors = diags_new();
    const expr *made = name == NULL ? override_quantity(of, what, text, wanted, arena, errors)
                                    : override_size(of, name, what, text, arena, errors);
    const bool number = made != NULL && (made->uses & ~(unsigned)USES_UNIT) == 0;
    *value = number ? expr_value(made, NULL) : 0.0;
    diags_flush(errors, stderr);
    diags_free(errors);
    arena_free(arena);
    if (made != NULL && !(number && isfinite(*value) && *value > 0.0)) {
        return options_fail(command, "%s takes a number above zero, not %s", what, text);
    }
    return made != NULL;
}

const cost_board *pricing_board(const char *command, const char *value) {
    const int chosen = options_choose(command, "board", value, cost_boards, sizeof cost_boards[0],
                                      cost_board_count);
    static const char *const f405[] = {"netduinoplus2", "stm32-h405", "feather-f405"};
    for (size_t i = 0; chosen < 0 && i < sizeof f405 / sizeof f405[0]; i++) {
        if (strcasecmp(value, f405[i]) == 0) {
            fputs("hint: --board mps2-an386 has the processor of an STM32F405\n", stderr);
        }
    }
    return chosen < 0 ? NULL : &cost_boards[chosen];
}

/* Default of --effort, in operations. */
#define EFFORT 1e9

static bool read_error(pricing *p) {
    const char *text = p->value[PRICING_ERROR];
    const char *command = p->command;
    const char *equals = text != NULL ? strchr(text, '=') : NULL;
    p->quantity = p->value[PRICING_OF];
    if (equals != NULL && p->quantity != NULL) {
        return options_fail(command,
                            "--of and --error must not both name a quantity\nhint: --error "
                            "\"%s\"",
                            equals + 1 + strspn(equals + 1, " "));
    }
    if (equals != NULL && equals == text + strspn(text, " \t")) {
        return options_fail(command,
                            "--error '%s': a quantity is missing before '='\nhint: --error "
                            "\"x%s\"",
                            text, equals);
    }
    if (equals != NULL) {
        p->quantity = p->named = alloc_trimmed(text, (size_t)(equals - text));
    }
    return text == NULL ||
           pricing_quantity(command, p->of, p->quantity, "--error", text, dim_none(), &p->error_si);
}

static bool read_methods(pricing *p) {
    const char *at = p->value[PRICING_METHOD];
    const char *words[WH_METHODS + 1] = {[WH_METHODS] = "all"};
    for (int i = 0; i < WH_METHODS; i++) {
        words[i] = wh_methods[i].word;
    }
    int chosen = 0;
    for (char *word; chosen >= 0 && (word = alloc_entry(&at)) != NULL; free(word)) {
        chosen = options_choose(p->command, "method", word, words, sizeof words[0], WH_METHODS + 1);
        for (int m = 0; m < WH_METHODS; m++) {
            p->method[m] = p->method[m] || chosen == m || chosen == WH_METHODS;
        }
    }
    return chosen >= 0;
}

static table_request request_of(const pricing *p) {
    const bool shows = p->value[PRICING_QUIET] == NULL && isatty(STDERR_FILENO);
    return (table_request){.operations = p->effort,
                           .method = p->value[PRICING_METHOD] != NULL ? p->method : NULL,
                           .periods = 1,
                           .workers = jobs_workers(),
                           .shows = shows};
}

static bool read_ranges(pricing *p) {
    p->grid.command = p->command;
    p->grid.option = "--vary";
    for (int i = 0; i < p->vary_count; i++) {
        const bool counted = strrchr(p->vary[i], ':') != NULL;
        char *text = counted ? alloc_words("%s", p->vary[i])
                             : alloc_words("%s:%d", p->vary[i], PRICING_PLACES);
        const bool good = grid_add(&p->grid, p->of, text, p->from.errors);
        free(text);
        diags_flush(p->from.errors, stderr);
        if (!good) {
            return false;
        }
        if (p->grid.axes[i].symbol == NULL) {
            return options_fail(p->command,
                                "--vary cannot change the step: whirl tries the steps itself");
        }
    }
    if (p->grid.count > 0 && p->grid.points > PRICING_PLACES_MAX) {
        return options_fail(p->command, "--vary: %llu combinations exceed the limit of %d",
                            (unsigned long long)p->grid.points, PRICING_PLACES_MAX);
    }
    return true;
}

static bool can_start(pricing *p, const instance *inst) {
    if (!changes_take_part(&p->grid, inst)) {
        return false;
    }
    for (int i = 0; i < p->scene->source.points; i++) {
        const setting plain = {IMAGE_SETTINGS_DEFAULT, &engine_double};
        image *im = p->scene->source.make(p->scene, i, &plain, NULL, NULL);
        const bool good = im != NULL && start_is_possible(im, &engine_double, p->from.errors) &&
                          start_angles_are_held(im, p->from.errors);
        diags_flush(p->from.errors, stderr);
        image_free(im);
        if (!good) {
            return false;
        }
    }
    return true;
}

static bool read_times(pricing *p) {
    const char *horizon = p->value[PRICING_HORIZON];
    instance *inst = instance_make(p->of, p->in, &p->changes, p->from.errors);
    bool good = inst != NULL;
    if (good) {
        p->until_s = inst->until_s;
        good = horizon == NULL || instance_duration(p->of, p->in, &p->changes, "horizon", horizon,
                                                    p->from.errors, &p->until_s);
    }
    diags_flush(p->from.errors, stderr);
    if (good) {
        pricing_scene_add_own(p->scene, inst);
        good = can_start(p, inst);
    }
    instance_free(inst);
    if (good && !(p->until_s > 0.0)) {
        return options_fail(p->command, "the motion to compare has a length of 0 s\nhint: "
                                        "--horizon 1s");
    }
    return good;
}

int pricing_open(pricing *p) {
    int code = source_open(&p->from, p->typed);
    if (code == EXIT_DONE) {
        code = source_pick(&p->from, true, &p->of, &p->in);
    }
    if (code != EXIT_DONE) {
        return code;
    }
    p->changes = p->common.changes;
    p->changes.balance = p->balance;
    overrides asked = p->changes;
    asked.until = NULL; /* each printed command line gets its own --until */
    p->words = pricing_words(&asked, false);
    p->target = pricing_quoted(p->typed);
    p->board = pricing_board(p->command, p->value[PRICING_BOARD]);
    const char *effort = p->value[PRICING_EFFORT];
    p->effort = EFFORT;
    if (p->board == NULL ||
        (effort != NULL &&
         !options_number(p->command, "--effort", effort, EFFORT_LEAST, EFFORT_MOST,
                         "a number of operations: --effort 1e10", &p->effort)) ||
        !read_methods(p) || !read_error(p) || !read_ranges(p)) {
        return EXIT_BAD_INPUT;
    }
    p->scene = pricing_scene_new(p->of, p->in, &p->changes, &p->grid, p->from.errors);
    return read_times(p) ? EXIT_DONE : EXIT_BAD_INPUT;
}

void pricing_close(pricing *p) {
    trial_end(&p->trial);
    pricing_scene_free(p->scene);
    grid_free(&p->grid);
    free(p->words);
    free(p->target);
    free(p->named);
    free(p->vary);
    source_close(&p->from);
}

whole_ratio pricing_spacing(double until_s, double count) {
    static const double mantissa[] = {1.0, 2.0, 5.0};
    const double most = until_s / count * (1.0 + 1e-9);
    double spacing_s = 0.0;
    for (int power = -20; power <= 18; power++) {
        for (int i = 0; i < 3; i++) {
            char text[40];
            snprintf(text, sizeof text, "%.0fe%d", mantissa[i], power);
            const double each_s = decimal_read(text, NULL);
            spacing_s = each_s <= most ? each_s : spacing_s;
        }
    }
    return ratio_of(spacing_s);
}

int pricing_begin(pricing *p, whole_ratio spacing) {
    uint64_t wanted = 0;
    const double each_s = ratio_times(1, spacing);
    if (each_s > 0.0 && p->until_s / each_s < 1e7) {
        wanted = (uint64_t)number_floor(p->until_s / each_s * (1.0 + 1e-9));
    }
    if (wanted < 1) {
        fprintf(stderr,
                "whirl %s: error: Whirl cannot compare steps over a motion of %.9g s: it "
                "is too short or too long\n",
                p->command, p->until_s);
        return EXIT_BAD_INPUT;
    }
    const trial_request request = {.source = &p->scene->source,
                                   .board = p->board,
                                   .target = p->target,
                                   .changes = p->words,
                                   .of = p->quantity,
                                   .spacing = spacing,
                                   .records = (int)wanted};
    return trial_begin(&p->trial, &request) ? EXIT_DONE : EXIT_BAD_INPUT;
}

/* === price ==================================================================================== */

static const char price_head[] =
    "usage: whirl price SCENE|MECHANISM[:SCENE]|FILE[:SCENE] [options]\n"
    "\n"
    "Tries methods, number types, forms, matrices, tables and many step sizes on a scene\n"
    "(docs/price.md). Prints the error of each setting, compared with a run of shorter steps,\n"
    "and its cost on a board: cycles per simulated second, flash, RAM and stack. If the board has no\n"
    "cycle counts, the cost is in instructions. The table has at most 12 rows of the Pareto front. A\n"
    "letter after each figure shows its source.\n"
    "\n";

static bool write_csv(const char *file, const trials *t, const table *made) {
    FILE *out = atomic_file_open(file);
    if (out != NULL) {
        table_csv(out, t, made);
    }
    return out != NULL && plot_run_csv_end(out, file, true, "price", t->image[0]->name);
}

/* Returns an exit status. */
static int say_cheapest(FILE *out, const pricing *p, const table *made) {
    for (int i = 0; i < made->count; i++) {
        const table_row *row = &made->row[i];
        if (trial_error_si(&p->trial, row->result.error) <= p->error_si) {
            char *line = table_run_line(&p->trial, &row->setting, row->pace, row->result.point);
            fprintf(out, "the cheapest setting within %s has an error of %.2e %s:\n  %s\n",
                    p->value[PRICING_ERROR], row->result.error, trial_unit(&p->trial), line);
            free(line);
            return EXIT_DONE;
        }
    }
    fprintf(stderr, "whirl price: error: no tried setting has an error below %s\n",
            p->value[PRICING_ERROR]);
    return EXIT_RUN_FAILED;
}

static int show(pricing *p, const table *made) {
    const char *const *value = p->value;
    const char *csv = value[PRICING_CSV];
    const bool is_json = value[PRICING_JSON] != NULL;
    FILE *out = is_json || options_is_standard(csv) ? stderr : stdout;
    if (value[PRICING_QUIET] == NULL && !is_json) {
        table_print(out, &p->trial, made, value[PRICING_ALL] != NULL);
    }
    if (!p->trial.reliable || made == NULL || made->count == 0) {
        fprintf(stderr, "whirl price: error: no setting of '%s' has a known error%s\n", p->typed,
                p->trial.reliable ? ": the table has no row" : ": there is no reliable reference");
        return EXIT_RUN_FAILED;
    }
    if (csv != NULL && !write_csv(csv, &p->trial, made)) {
        return EXIT_RUN_FAILED;
    }
    return p->value[PRICING_ERROR] != NULL ? say_cheapest(out, p, made) : EXIT_DONE;
}

static int count_front(pricing *p, table *made, const table_request *w) {
    const measured_end end = measured_front(&p->trial, made, w->shows);
    if (end == MEASURED_MISSING) {
        says_missing(p, "a tool is missing");
    }
    p->trial.stopped = p->trial.stopped || interrupted;
    return end == MEASURED_MISSING ? EXIT_BAD_INPUT : EXIT_DONE;
}

static bool can_measure(const pricing *p) {
    char text[MEASURED_TEXT];
    const char *missing = measured_missing(NULL, p->board, text);
    if (missing != NULL) {
        says_missing(p, missing);
    }
    return missing == NULL;
}

static int price_scene(void *options) {
    pricing *p = options;
    const int opened = pricing_open(p);
    if (opened != EXIT_DONE) {
        return opened;
    }
    const bool measure = p->value[PRICING_MEASURE] != NULL;
    const table_request request = request_of(p);
    const bool is_json = p->value[PRICING_JSON] != NULL;
    if (!options_json_is_alone("price", is_json, p->value[PRICING_CSV]) ||
        (measure && !can_measure(p))) {
        return EXIT_BAD_INPUT;
    }
    interrupts_catch();
    if (request.shows) {
        fputs("\rthe reference   ", stderr);
    }
    int code = pricing_begin(p, pricing_spacing(p->until_s, PRICING_RECORDS));
    table *made = NULL;
    if (code == EXIT_DONE && p->trial.reliable && !p->trial.stopped) {
        made = table_new(&p->trial, &request);
        code = measure && !p->trial.stopped ? count_front(p, made, &request) : code;
    }
    if (request.shows) {
        fputs("\r                    \r", stderr);
    }
    if (code == EXIT_DONE && p->trial.stopped) {
        code = EXIT_INTERRUPTED;
    } else if (code == EXIT_DONE) {
        code = show(p, made);
        if (is_json) {
            table_json(stdout, &p->trial, made, code);
        }
    }
    table_free(made);
    return code;
}

int command_price(int count, char **words) {
    static const pricing_command price = {
        "price", PRICING_PRICE, price_head,
        "no reference is accurate enough, no setting follows the motion, none has a\n       "
        "cost, or none is within --error",
        price_scene};
    return run_command(&price, count, words);
}

/* === choose =================================================================================== */

static const char choose_head[] =
    "usage: whirl choose SCENE|MECHANISM[:SCENE]|FILE[:SCENE] --error E [options]\n"
    "\n"
    "Finds two settings (method, number type, form and step) whose error is at most half of --error.\n"
    "One needs the fewest cycles on a board, the other the least flash. Prints their costs, and the\n"
    "commands that run, generate and count them.\n"
    "\n"
    "In its source tree, Whirl counts instructions with the board's compiler and emulator. Elsewhere\n"
    "it predicts them, and cannot answer for a scene with contacts.\n"
    "\n";
static bool fits(const pricing *p) {
    if (p->value[PRICING_MEASURE] != NULL && p->value[PRICING_PREDICT] != NULL) {
        return options_fail("choose", "--measure and --predict contradict each other");
    }
    if (p->value[PRICING_ERROR] == NULL) {
        fputs("whirl choose: error: --error is missing\nhint: --error 1e-3 (a part of the largest "
              "value), or --of X --error 0.1mm\n",
              stderr);
    }
    return p->value[PRICING_ERROR] != NULL;
}

/* Reads "32KB", "2048", "1 MiB" or "100 bytes". */
static bool read_bytes(const char *option, const char *text, double *bytes) {
    const char *rest;
    *bytes = decimal_read(text, &rest);
    rest += rest != text ? strspn(rest, " ") : 0;
    if (*rest == 'k' || *rest == 'K' || *rest == 'M') {
        *bytes *= *rest == 'M' ? 1048576.0 : 1024.0;
        rest += rest[1] == 'i' ? 2 : 1;
    }
    const bool ends = rest[0] == '\0' || strcmp(rest, "B") == 0 || strcmp(rest, "bytes") == 0;
    return (ends && *bytes > 0.0 && isfinite(*bytes)) ||
           options_fail("choose",
                        "%s takes a number of bytes above zero, not %s\n"
                        "hint: such as 32KB, or 32768",
                        option, text);
}

static bool read_limits(const pricing *p, choice_request *w) {
    const dimension per_s = dim_of(0, 0, -1, 0, 0);
    const char *const *v = p->value;
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

/* Sets *spacing; with --rate, the spacing is a whole number of periods. Returns false after an error (reported). */
static bool space_records(const pricing *p, choice_request *w, whole_ratio *spacing) {
    w->table.periods = 1;
    if (!(w->table.rate_Hz > 0.0)) {
        *spacing = pricing_spacing(p->until_s, PRICING_RECORDS);
        return true;
    }
    const whole_ratio rate =
        w->table.rate_Hz < 1e15 ? ratio_of(w->table.rate_Hz) : (whole_ratio){0, 1};
    uint64_t periods = 1;
    for (int i = 1;
         p->until_s * w->table.rate_Hz / (double)periods > 2.5 * PRICING_RECORDS && i <= 36; i++) {
        periods = table_decade(i);
    }
    w->table.periods = periods;
    const uint64_t common = ratio_divisor(periods, rate.numerator);
    *spacing = (whole_ratio){rate.denominator * (periods / common), rate.numerator / common};
    if (rate.numerator == 0 && w->table.rate_Hz > 1.0) {
        return options_fail("choose", "--rate %.9g Hz is faster than the shortest possible step",
                            w->table.rate_Hz);
    }
    if (rate.numerator == 0 || p->until_s * w->table.rate_Hz < 1.0 - 1e-9) {
        return options_fail("choose",
                            "one period of --rate %.9g Hz is longer than the motion of "
                            "%.9g s\nhint: use a later --until, or a higher --rate",
                            w->table.rate_Hz, p->until_s);
    }
    return true;
}

/* Reports that contacts have no predicted cost. */
static int says_contacts(const pricing *p, const char *missing) {
    fprintf(stderr,
            "whirl choose: error: the cost of contacts must be counted: %s\n"
            "hint: whirl price %s%s shows errors and evaluations without counting\n",
            missing, p->target, p->words);
    return EXIT_RUN_FAILED;
}

static int choose_from(pricing *p, choice_request *w, bool counts) {
    w->table.error = p->error_si / trial_error_si(&p->trial, 1.0); /* in the trial's unit */
    w->counts = counts;
    p->trial.tolerated = w->table.error;
    p->trial.without_events = p->trial.image[0]->contacts > 0;
    table *made = table_new(&p->trial, &w->table);
    choice c = choice_make(&p->trial, made, w);
    int code = EXIT_DONE;
    if (counts && !p->trial.stopped && choice_counted(&p->trial, made, w, &c) == MEASURED_MISSING) {
        if (p->value[PRICING_MEASURE] != NULL) {
            says_missing(p, "a tool is missing");
            code = EXIT_BAD_INPUT;
        } else if (p->trial.without_events) {
            code = says_contacts(p, "a tool is missing");
        }
        w->counts = false;
        w->prices = "predicted, because a tool for counting is missing";
        c = choice_make(&p->trial, made, w);
    }
    if (w->table.shows) {
        fputs("\r                                        \r", stderr);
    }
    if (code == EXIT_DONE && p->trial.stopped) {
        code = EXIT_INTERRUPTED;
    } else if (code == EXIT_DONE) {
        const double horizon_s = trial_horizon_s(&p->trial);
        const bool found = c.of[CHOICE_FASTEST].row >= 0;
        const bool is_short = found && horizon_s < 0.5 * p->until_s;
        code = found && !is_short ? EXIT_DONE : EXIT_RUN_FAILED;
        if (p->value[PRICING_JSON] != NULL) {
            choice_json(stdout, &p->trial, made, w, &c, code);
        } else {
            choice_print(stdout, &p->trial, made, w, &c);
        }
        if (is_short) {
            fprintf(
                stderr,
                "whirl choose: error: errors are known only until t = %.6g s, which is less than half of the motion (%.6g s)\nhint: --horizon %.6gs\n",
                horizon_s, p->until_s, horizon_s);
        }
    }
    table_free(made);
    return code;
}

static int choose_begun(pricing *p, choice_request *w) {
    const bool predicts = p->value[PRICING_PREDICT] != NULL;
    char text[MEASURED_TEXT];
    if (p->trial.stopped) {
        return EXIT_INTERRUPTED;
    }
    if (!p->trial.reliable) {
        figure_reference(stderr, &p->trial);
        return EXIT_RUN_FAILED;
    }
    if (w->table.shows && !predicts) {
        fputs("\rbuilding the counter ", stderr);
    }
    const char *missing = predicts ? "" : measured_missing(&p->trial, p->board, text);
    if (p->value[PRICING_MEASURE] != NULL && missing != NULL) {
        says_missing(p, missing);
        return EXIT_BAD_INPUT;
    }
    if (missing != NULL && p->trial.image[0]->contacts > 0) {
        return says_contacts(p, predicts ? "leave out --predict" : missing);
    }
    char *prices = alloc_words(
        "%s%s",
        missing == NULL
            ? "counted on the board: the cost of a step or of the whole run, and the bytes"
        : predicts ? "predicted, as --predict asks for"
                   : "predicted, because the instructions cannot be counted: ",
        missing != NULL ? missing : "");
    w->prices = prices;
    const int done = choose_from(p, w, missing == NULL);
    free(prices);
    return done;
}

static int choose_scene(void *options) {
    pricing *p = options;
    const int opened = pricing_open(p);
    if (opened != EXIT_DONE) {
        return opened;
    }
    choice_request w = {.table = request_of(p)};
    whole_ratio spacing;
    if (!fits(p) || !read_limits(p, &w) || !space_records(p, &w, &spacing) ||
        (p->value[PRICING_MEASURE] != NULL && !can_measure(p))) {
        return EXIT_BAD_INPUT;
    }
    interrupts_catch();
    const int code = pricing_begin(p, spacing);
    return code == EXIT_DONE ? choose_begun(p, &w) : code;
}

int command_choose(int count, char **words) {
    static const pricing_command choose = {
        "choose", PRICING_CHOOSE, choose_head,
        "no setting fits (the output has the reasons), or no reference is accurate enough",
        choose_scene};
    return run_command(&choose, count, words);
}

/* pricing.c: the options of `whirl price` and `whirl choose` (pricing.h). */
#include "pricing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "host/base/alloc.h"
#include "host/engine/start.h"
#include "host/lang/override.h"
#include "host/lang/value.h"
#include "host/number/decimal.h"
#include "host/number/functions.h"
#include "host/os/jobs.h"

typedef struct pricing_row {
    unsigned commands;
    const char *word;
    const char *value;
    const char *text;
} pricing_row;

#define ROW(id, who, word, value, text) [id] = {PRICING_##who, word, value, text},
static const pricing_row rows[PRICING_OPTIONS] = {PRICING_OPTION_ROWS(ROW)};
#undef ROW

enum { TEXT_COLUMN = 23 };
_Static_assert((int)PRICING_OPTIONS <= (int)OWN_OPTIONS_MOST, "room for all");

pricing_options pricing_defaults(const char *command, int word_count) {
    return (pricing_options){.command = command,
                             .common = options_defaults(),
                             .value = {[PRICING_BOARD] = COST_BOARD_DEFAULT},
                             .vary = alloc(word_count, sizeof(const char *))};
}

static void print_help(FILE *out, const pricing_command *c) {
    const command_usage common = {.head = "", .groups = PRICING_GROUPS, .tail = ""};
    const command_usage end = {.head = "",
                               .tail = "",
                               .why = {[EXIT_ROW_OF(EXIT_DONE)] = "",
                                       [EXIT_ROW_OF(EXIT_RUN_FAILED)] = c->failed,
                                       [EXIT_ROW_OF(EXIT_BAD_INPUT)] = "",
                                       [EXIT_ROW_OF(EXIT_INTERRUPTED)] = ""}};
    fputs(c->head, out);
    for (int i = 0; i < PRICING_OPTIONS; i++) {
        if ((rows[i].commands & c->bit) != 0) {
            const char *value = rows[i].value != NULL ? rows[i].value : "";
            const int width = fprintf(out, "  %s %s", rows[i].word, value);
            fprintf(out, "%*s", TEXT_COLUMN - width, "");
            options_text(out, rows[i].text, TEXT_COLUMN, TEXT_COLUMN,
                         TEXT_COLUMN + OPTION_TEXT_WIDTH);
        }
    }
    fputc('\n', out);
    options_usage(out, &common);
    options_usage(out, &end);
}

static bool read_words(int count, char **words, pricing_options *o) {
    own_option own[PRICING_OPTIONS + 1] = {{.word = NULL}};
    int all = 0;
    for (int i = 0; i < PRICING_OPTIONS; i++) {
        if ((rows[i].commands & o->bit) != 0) {
            own[all++] = (own_option){.word = rows[i].word,
                                      .text = i == PRICING_VARY ? o->vary : &o->value[i],
                                      .count = i == PRICING_VARY ? &o->vary_count : NULL,
                                      .is_bare = rows[i].value == NULL};
        }
    }
    const target_reader reader = {.command = o->command, .groups = PRICING_GROUPS, .table = own};
    if (!target_read(&reader, count, words, &o->common, o, &o->target)) {
        return false;
    }
    if (o->target == NULL) {
        fprintf(stderr,
                "whirl %s: error: there is no scene\nhint: whirl %s SCENE, FILE or FILE:SCENE; "
                "`whirl list` names the built-in ones\n",
                o->command, o->command);
    }
    return o->target != NULL;
}

int pricing_run(const pricing_command *c, int count, char **words) {
    if (options_wants_help(count, words)) {
        print_help(stdout, c);
        return EXIT_DONE;
    }
    pricing_options o = pricing_defaults(c->name, count);
    int code = EXIT_BAD_INPUT;
    o.bit = c->bit;
    if (read_words(count, words, &o)) {
        pricing p;
        code = pricing_open(&p, &o);
        if (code == EXIT_DONE) {
            code = c->run(&p);
        }
        if (code == EXIT_INTERRUPTED) {
            fprintf(stderr, "whirl %s: interrupted\n", c->name);
        }
        pricing_close(&p);
    }
    options_forget(&o.common);
    free(o.vary);
    return code;
}

void pricing_says_missing(const pricing *p, const char *why) {
    fprintf(
        stderr,
        "whirl %s: error: --measure: nothing can be counted on %s: %s\n"
        "hint: without --measure prices are predicted; `make deps` installs compilers and emulators\n",
        p->options->command, p->board->name, why);
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
        fprintf(stderr, "whirl %s: error: %s takes a number above zero, not %s\n", command, what,
                text);
        return false;
    }
    return made != NULL;
}

const cost_board *pricing_board(const char *command, const char *value) {
    const int chosen = options_choose(command, "board", value, cost_boards, sizeof cost_boards[0],
                                      cost_board_count);
    static const char *const f405[] = {"netduinoplus2", "stm32-h405", "feather-f405"};
    for (size_t i = 0; chosen < 0 && i < sizeof f405 / sizeof f405[0]; i++) {
        if (options_same(value, f405[i])) {
            fputs("hint: --board mps2-an386 has the processor of an STM32F405\n", stderr);
        }
    }
    return chosen < 0 ? NULL : &cost_boards[chosen];
}

static bool find_board(pricing *p) {
    p->board = pricing_board(p->options->command, p->options->value[PRICING_BOARD]);
    return p->board != NULL;
}

/* Operations that all trials may evaluate without --effort. */
#define EFFORT 1e9

/* --error, in the dimension of its quantity or that of --of. An unknown one is reported later. */
static bool read_error(pricing *p) {
    const char *text = p->options->value[PRICING_ERROR];
    const char *command = p->options->command;
    const char *equals = text != NULL ? strchr(text, '=') : NULL;
    p->asks_error = text != NULL;
    p->quantity = p->options->value[PRICING_OF];
    if (equals != NULL && p->quantity != NULL) {
        fprintf(stderr,
                "whirl %s: error: --of and --error both name a quantity\nhint: --error %s\n",
                command, equals + 1);
        return false;
    }
    if (equals != NULL) {
        p->quantity = p->named = alloc_copy(text, (size_t)(equals - text));
        text = equals + 1;
    }
    return text == NULL ||
           pricing_quantity(command, p->of, p->quantity, "--error", text, dim_none(), &p->error_si);
}

static bool read_effort(pricing *p) {
    const char *text = p->options->value[PRICING_EFFORT];
    p->effort = EFFORT;
    return text == NULL || options_number(p->options->command, "--effort", text, EFFORT_LEAST,
                                          EFFORT_MOST, "operations: --effort 1e10", &p->effort);
}

static bool read_methods(pricing *p) {
    const char *at = p->options->value[PRICING_METHOD];
    const char *words[WH_METHODS + 1] = {[WH_METHODS] = "all"};
    for (int i = 0; i < WH_METHODS; i++) {
        words[i] = wh_methods[i].word;
    }
    while (at != NULL) {
        const size_t length = strcspn(at, ",");
        char *word = alloc_copy(at, length);
        const int chosen = options_choose(p->options->command, "method", word, words,
                                          sizeof words[0], WH_METHODS + 1);
        free(word);
        for (int m = 0; m < WH_METHODS; m++) {
            p->method[m] = p->method[m] || chosen == m || chosen == WH_METHODS;
        }
        if (chosen < 0) {
            return false;
        }
        at = at[length] == ',' ? at + length + 1 : NULL;
    }
    return true;
}

static void show_progress(void *context, int done, int of) {
    (void)context;
    fprintf(stderr, "\r%3d of %d settings ", done, of);
}

table_wish pricing_wish(const pricing *p) {
    const bool shows = p->options->value[PRICING_QUIET] == NULL && isatty(STDERR_FILENO);
    return (table_wish){.operations = p->effort,
                        .method = p->options->value[PRICING_METHOD] != NULL ? p->method : NULL,
                        .periods = 1,
                        .workers = jobs_workers(),
                        .progress = shows ? show_progress : NULL};
}

static bool read_ranges(pricing *p) {
    const pricing_options *o = p->options;
    p->grid.command = o->command;
    p->grid.option = "--vary";
    for (int i = 0; i < o->vary_count; i++) {
        const bool counted = strrchr(o->vary[i], ':') != NULL;
        char *text = counted ? alloc_words("%s", o->vary[i])
                             : alloc_words("%s:%d", o->vary[i], PRICING_PLACES);
        const bool good = grid_add(&p->grid, p->of, text, p->from.errors);
        free(text);
        diags_flush(p->from.errors, stderr);
        if (!good) {
            return false;
        }
        if (p->grid.axes[i].symbol == NULL) {
            fprintf(stderr, "whirl %s: error: --vary varies no step: steps are what is priced\n",
                    o->command);
            return false;
        }
    }
    if (p->grid.count > 0 && p->grid.points > PRICING_PLACES_MAX) {
        fprintf(stderr, "whirl %s: error: --vary: %llu places, and at most %d can be tried\n",
                o->command, (unsigned long long)p->grid.points, PRICING_PLACES_MAX);
        return false;
    }
    return true;
}

/* Varied values must take part, and all places must be able to start. */
static bool can_start(pricing *p, const instance *inst) {
    for (int i = 0; i < p->grid.count; i++) {
        const effect *missing = instance_lacks(inst, p->grid.axes[i].symbol);
        if (missing != NULL) {
            fprintf(stderr,
                    "whirl %s: error: '%s' belongs to the effect '%s', which takes no part here\n"
                    "hint: add --with %s\n",
                    p->options->command, p->grid.axes[i].symbol->name, missing->name,
                    missing->name);
            return false;
        }
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
    const char *horizon = p->options->value[PRICING_HORIZON];
    instance *inst = instance_make(p->of, p->in, &p->changes, p->from.errors);
    bool good = inst != NULL;
    if (good) {
        p->until_s = inst->until_s;
        p->step_s = inst->step_s;
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
        fprintf(stderr, "whirl %s: error: a motion of no time has no errors\nhint: --horizon 1s\n",
                p->options->command);
        return false;
    }
    return good;
}

int pricing_open(pricing *p, const pricing_options *o) {
    *p = (pricing){.options = o};
    int code = source_open(&p->from, o->target);
    if (code == EXIT_DONE) {
        code = source_pick(&p->from, true, &p->of, &p->in);
    }
    if (code != EXIT_DONE) {
        return code;
    }
    p->changes = options_overrides(&o->common.change);
    p->changes.balance = o->balance;
    overrides asked = p->changes;
    asked.until = NULL; /* the lines that name settings have an end of their own */
    p->words = pricing_words(&asked, false);
    p->target = pricing_quoted(o->target);
    if (!find_board(p) || !read_effort(p) || !read_methods(p) || !read_error(p) ||
        !read_ranges(p)) {
        return EXIT_BAD_INPUT;
    }
    p->scene = pricing_scene_new(p->of, p->in, &p->changes, &p->grid, p->from.errors);
    return read_times(p) ? EXIT_DONE : EXIT_BAD_INPUT;
}

void pricing_close(pricing *p) {
    if (p->has_trial) {
        trial_end(&p->trial);
    }
    pricing_scene_free(p->scene);
    grid_free(&p->grid);
    free(p->words);
    free(p->target);
    free(p->named);
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
        fprintf(stderr, "whirl %s: error: %.9g s of motion are too short or too long to look at\n",
                p->options->command, p->until_s);
        return EXIT_BAD_INPUT;
    }
    const trial_wish wish = {.source = &p->scene->source,
                             .board = p->board,
                             .of = p->quantity,
                             .spacing = spacing,
                             .records = (int)wanted};
    p->has_trial = true;
    return trial_begin(&p->trial, &wish) ? EXIT_DONE : EXIT_BAD_INPUT;
}

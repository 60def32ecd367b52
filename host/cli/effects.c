/* effects.c: `whirl effects`: the influence of each effect of a scene, its price, and the smallest sufficient set. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "commands.h"
#include "host/base/alloc.h"
#include "host/base/spelling.h"
#include "host/lang/override.h"
#include "host/number/functions.h"
#include "host/study/subsets.h"
#include "pricing.h"

/* Default of --error for a coordinate: ERROR_PART of its range, but at least ERROR_LEAST (SI). */
#define ERROR_PART 1e-3
#define ERROR_LEAST 1e-12

static const command_usage usage = {
    .head =
        "usage: whirl effects SCENE|MECHANISM[:SCENE]|FILE[:SCENE] [options]\n"
        "\n"
        "Prints for each effect of a scene how far it moves each coordinate, its cost on a board, and\n"
        "whether the allowed error permits leaving it out. Then it prints the smallest set of effects that\n"
        "stays within the error, as a command (docs/effects.md). It compares motions at every step, in\n"
        "double. Costs are predictions in float. It cannot judge an effect that did not act in "
        "the run.\n"
        "\n",
    .groups = OPTIONS_CHANGE | OPTIONS_STEP,
    .tail =
        "  --error X=1mm,...    allowed errors of coordinates, rates or outputs; all others are unlimited. A\n"
        "                       bare number is refused if the declared unit is not SI. Default: 0.1 %\n"
        "                       of each coordinate's range.\n"
        "  --board B            the board of the costs: an emulated board of docs/boards.md, or host\n"
        "                       (default: mps2-an386, a Cortex-M4F, also for an STM32F405)\n",
    .why = {"", "the run with all effects diverged", "wrong options, or a scene without effects"}};

typedef struct effects_options {
    common_options common;
    const char *target;
    const char *error;
    const char *board;
} effects_options;

static const char primes[] = "''''''''''";

static bool is_coordinate(const record_column *c) { return c->unknown >= 0 && c->primes == 0; }

/* Returns 0 if there is no such column (reported). */
static int column_of(const subsets *s, const char *name) {
    nearest search = nearest_start(name, strlen(name));
    for (int i = 1; i < s->columns->columns; i++) {
        const record_column *c = &s->columns->column[i];
        const size_t length = strlen(c->name);
        if (strncmp(name, c->name, length) == 0 &&
            strspn(name + length, "'") == (size_t)c->primes &&
            name[length + (size_t)c->primes] == '\0') {
            return i;
        }
        nearest_offer(&search, c->name);
    }
    fprintf(stderr,
            "whirl effects: error: --error: '%s' is not a coordinate, rate or output of '%s'\n"
            "hint: --error %s=...\n",
            name, s->of->name, search.best != NULL ? search.best : s->columns->column[1].name);
    return 0;
}

/* Reads an item of --error, such as "X=1mm". Returns false after an error (reported). */
static bool read_limit(subsets *s, const char *text) {
    const size_t length = strcspn(text, "=");
    char *name = alloc_trimmed(text, length);
    double si = 0.0;
    const int column = column_of(s, name);
    bool good = column > 0;
    if (good && text[length] == '\0') {
        good = options_fail("effects", "--error %s has no value\nhint: --error \"%s=1e-3 [%s]\"",
                            text, name, s->columns->column[column].unit->shown);
    }
    if (good && isfinite(s->limit[column])) {
        good = options_fail("effects", "--error: '%s' is given twice\nhint: leave one out", name);
    }
    good = good && pricing_quantity("effects", s->of, name, "--error", text, dim_none(), &si);
    if (good) {
        s->limit[column] = image_shown(s->columns->column[column].unit, si);
    }
    free(name);
    return good;
}

static bool read_error(subsets *s, const char *error) {
    bool good = true;
    for (int i = 1; i < s->columns->columns; i++) {
        s->limit[i] = (double)INFINITY;
    }
    for (char *limit; good && (limit = alloc_entry(&error)) != NULL; free(limit)) {
        good = read_limit(s, limit);
    }
    return good;
}

static void print_cell(const char *head, bool is_head, const char *format, double number) {
    enum { LEAST = 9 };
    const int length = (int)strlen(head);
    char *text = is_head            ? alloc_words("%s", head)
                 : isfinite(number) ? alloc_words(format, number_shown(number))
                                    : alloc_words("-");
    printf("  %*s", length > LEAST ? length : LEAST, text);
    free(text);
}

/* Prints a row, or the headings if `moved` is NULL. If `contacts` is not 0, only the evaluations are known. */
static void print_row(const subsets *s, const char *name, const double *moved, const double *figure,
                      int contacts, const char *verdict) {
    const char *const words[SUBSET_FIGURES] = {
        [SUBSET_STEP] = s->board->cycles == COST_RANGE ? "instructions" : "cycles",
        [SUBSET_WORST] = "evaluations",
        [SUBSET_FLASH] = "flash [B]",
        [SUBSET_RAM] = "RAM [B]"};
    int width = (int)strlen("smallest set");
    for (int k = 0; k < s->effects; k++) {
        const int length = (int)strlen(s->of->effects[s->effect[k]].name);
        width = length > width ? length : width;
    }
    printf("%-*s", width, name);
    for (int i = 1; i < s->columns->columns; i++) {
        const record_column *c = &s->columns->column[i];
        if (is_coordinate(c) || isfinite(s->limit[i])) {
            const bool bare = strcmp(c->unit->shown, "1") == 0;
            char *head = alloc_words("%s%.*s%s%s%s", c->name, c->primes, primes, bare ? "" : " [",
                                     bare ? "" : c->unit->shown, bare ? "" : "]");
            print_cell(head, moved == NULL, "%.4g", moved == NULL ? 0.0 : moved[i]);
            free(head);
        }
    }
    for (int i = 0; i < SUBSET_FIGURES; i++) {
        const bool known = figure != NULL && (i == SUBSET_WORST || contacts == 0);
        print_cell(words[i], moved == NULL, "%.0f", known ? figure[i] : (double)NAN);
    }
    printf("%s%s\n", verdict[0] == '\0' ? "" : "  ", verdict);
}

static void print_effect(const subsets *s, int k) {
    const subset *all = s->list[0];
    const subset *without = s->list[k + 1];
    double figure[SUBSET_FIGURES];
    for (int i = 0; i < SUBSET_FIGURES; i++) {
        figure[i] = all->figure[i] - without->figure[i];
    }
    print_row(s, s->of->effects[s->effect[k]].name, without->moved, figure,
              all->contacts - without->contacts,
              !s->acted[k]                ? "not tested: the effect did not act in this run"
              : without->failed != NULL   ? without->failed
              : subsets_keeps(s, without) ? "may be left out"
                                          : "needed");
}

static void print_names(const subsets *s, const char *head, uint64_t bits, const char *between) {
    for (int k = 0; k < s->effects; k++) {
        if ((bits >> (unsigned)k & 1U) != 0) {
            printf("%s%s", head, s->of->effects[s->effect[k]].name);
            head = between;
        }
    }
}

/* Does --set name a parameter of an omitted effect? `whirl run` would refuse such a --set. */
static bool is_for_left_out(const subsets *s, uint64_t out, const char *set) {
    struct arena *memory = arena_new();
    diags *unsaid = diags_new();
    assignment change;
    bool is = false;
    if (override_parse(s->of, OVERRIDE_SET, set, NULL, memory, unsaid, &change)) {
        for (int k = 0; k < s->effects; k++) {
            is = is || (change.symbol->effect == s->effect[k] && (out >> (unsigned)k & 1U) != 0);
        }
    }
    diags_free(unsaid);
    arena_free(memory);
    return is;
}

static void leave_out(const subsets *s, overrides *given, const char **names, uint64_t *out) {
    bool all = false;
    given->with = names;
    given->with_count = 0;
    for (int i = 0; i < s->changes->with_count; i++) {
        const char *name = s->changes->with[i];
        bool is_out = false;
        all = all || strcmp(name, "all") == 0;
        for (int k = 0; k < s->effects; k++) {
            is_out = is_out || ((*out >> (unsigned)k & 1U) != 0 &&
                                strcmp(name, s->of->effects[s->effect[k]].name) == 0);
        }
        if (!is_out) {
            names[given->with_count++] = name;
        }
    }
    for (int k = 0; k < s->effects; k++) {
        if (!all && (s->in == NULL || !s->in->with[s->effect[k]])) {
            *out &= ~((uint64_t)1 << (unsigned)k);
        }
    }
}

static void print_run(const effects_options *o, const subsets *s, uint64_t out) {
    overrides given = *s->changes;
    const char **names = alloc(given.with_count, sizeof *names);
    const char **sets = alloc(given.set_count, sizeof *sets);
    given.sets = sets;
    given.set_count = 0;
    for (int i = 0; i < s->changes->set_count; i++) {
        if (!is_for_left_out(s, out, s->changes->sets[i])) {
            sets[given.set_count++] = s->changes->sets[i];
        }
    }
    leave_out(s, &given, names, &out);
    char *words = pricing_words(&given, false);
    char *target = pricing_quoted(o->target);
    printf("  whirl run %s%s", target, words);
    print_names(s, " --without ", out, ",");
    putchar('\n');
    free(target);
    free(words);
    free(names);
    free(sets);
}

static void print_answer(const effects_options *o, subsets *s) {
    const image *im = s->image;
    const subset *all = s->list[0];
    const uint64_t every = ~(uint64_t)0 >> (unsigned)(SUBSETS_EFFECTS_MAX - s->effects);
    uint64_t untested = 0;
    bool greedy;
    const subset *best = subsets_smallest(s, &greedy);
    printf("%s%s%s\n%llu steps to t = %.9g s, %s, double; price on %s (%s), float, predicted\n\n",
           im->name, im->title[0] != '\0' ? ": " : "", im->title, (unsigned long long)im->steps,
           ratio_times(im->steps, im->step), image_stepper(im), s->board->name, s->board->core);
    print_row(s, "effect", NULL, NULL, 0, "verdict");
    for (int k = 0; k < s->effects; k++) {
        print_effect(s, k);
        untested |= s->acted[k] ? 0 : (uint64_t)1 << (unsigned)k;
    }
    print_row(s, "allowed", s->limit, NULL, 0, o->error != NULL ? "" : "0.1 % of the range");
    print_row(s, "all", all->moved, all->figure, all->contacts, "");
    print_row(s, "smallest set", best->moved, best->figure, best->contacts, "");
    printf("\nsmallest set within the error%s: ",
           greedy ? ", found by leaving out one more effect at a time" : "");
    print_names(s, "", every & ~best->out, ", ");
    print_names(s, "\nkept, because this run does not test them: ", untested, ", ");
    puts(best->out == every ? "no effect" : "");
    print_run(o, s, best->out);
}

static int effects_of(const effects_options *o, subsets *s, diags *errors) {
    s->board = pricing_board("effects", o->board);
    if (s->board == NULL || !subsets_open(s, errors)) {
        return EXIT_BAD_INPUT;
    }
    if (s->effects == 0) {
        fprintf(stderr, "whirl effects: error: no effect is selected in '%s'\nhint: %s%s\n",
                s->image->name, s->of->effect_count > 0 ? "--with all, or --with " : "",
                s->of->effect_count > 0 ? s->of->effects[0].name
                                        : "docs/effects.md shows how to write one");
        return EXIT_BAD_INPUT;
    }
    if (s->image->steps == 0) {
        fputs("whirl effects: error: the run has no steps, so there is nothing to compare\nhint: "
              "--until 1s\n",
              stderr);
        return EXIT_BAD_INPUT;
    }
    if (!read_error(s, o->error)) {
        return EXIT_BAD_INPUT;
    }
    if (!subsets_run(s, errors)) {
        return EXIT_RUN_FAILED;
    }
    for (int i = 1; i < s->columns->columns && o->error == NULL; i++) {
        const record_column *c = &s->columns->column[i];
        if (is_coordinate(c)) {
            s->limit[i] = number_most(ERROR_PART * s->range[i], image_shown(c->unit, ERROR_LEAST));
        }
    }
    print_answer(o, s);
    return EXIT_DONE;
}

static int effects_source(source_model *from, void *options) {
    const effects_options *o = options;
    subsets s = {.changes = &o->common.changes};
    int code = source_pick(from, true, &s.of, &s.in);
    if (code == EXIT_DONE) {
        code = effects_of(o, &s, from->errors);
        diags_flush(from->errors, stderr);
    }
    subsets_close(&s);
    return code;
}

int command_effects(int count, char **words) {
    effects_options o = {.common = options_defaults(), .board = "mps2-an386"};
    const own_option own[] = {{.word = "--error", .text = &o.error},
                              {.word = "--board", .text = &o.board},
                              {.word = NULL}};
    const target_reader reader = {
        .command = "effects", .usage = &usage, .table = own, .work_on = effects_source};
    return target_command(&reader, count, words, &o.common, &o, &o.target);
}

/* pricing.c: the options of `whirl price` and `whirl choose` (pricing.h). */
#include "pricing.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/room.h"

typedef struct pricing_row {
    const char *word;
    const char *value;
    const char *text;
} pricing_row;

#define ROW(id, word, value, text) [id] = {word, value, text},
static const pricing_row rows[PRICING_OPTIONS] = {PRICING_OPTION_ROWS(ROW)};
#undef ROW

enum { TEXT_COLUMN = 23 };

pricing_options pricing_defaults(const char *command, int word_count) {
    return (pricing_options){.command = command,
                             .common = options_defaults(),
                             .value = {[PRICING_BOARD] = COST_BOARD_DEFAULT},
                             .vary = room(word_count, sizeof(const char *))};
}

void pricing_forget(pricing_options *o) {
    options_forget(&o->common);
    free(o->vary);
}

void pricing_describe(FILE *out) {
    for (int i = 0; i < PRICING_OPTIONS; i++) {
        const int width = fprintf(out, "  %s %s", rows[i].word, rows[i].value);
        fprintf(out, "%*s", TEXT_COLUMN - width, "");
        options_text(out, rows[i].text, TEXT_COLUMN, TEXT_COLUMN, TEXT_COLUMN + OPTION_TEXT_WIDTH);
    }
}

bool pricing_take(int count, char **words, int *at, pricing_options *o, bool *bad) {
    for (int i = 0; i < PRICING_OPTIONS && !*bad; i++) {
        const char *value = options_value(count, words, at, rows[i].word, bad);
        if (value != NULL) {
            o->value[i] = value;
            if (i == PRICING_VARY) {
                o->vary[o->vary_count++] = value;
            }
            return true;
        }
    }
    if (!*bad && strcmp(words[*at], "--quiet") == 0) {
        o->quiet = true;
        ++*at;
        return true;
    }
    return false;
}

bool pricing_read(int count, char **words, const char *const *own, target_take *take, void *options,
                  pricing_options *o) {
    enum { WORDS_MOST = PRICING_OPTIONS + 32 };
    const char *all[WORDS_MOST] = {"--quiet"};
    int all_count = 1;
    for (int i = 0; i < PRICING_OPTIONS; i++) {
        all[all_count++] = rows[i].word;
    }
    for (; *own != NULL && all_count < WORDS_MOST - 1; own++) {
        all[all_count++] = *own;
    }
    const target_reader reader = {
        .command = o->command, .groups = PRICING_GROUPS, .own = all, .take = take};
    if (!target_read(&reader, count, words, &o->common, options, &o->target)) {
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

void pricing_says_missing(const pricing *p, const char *why) {
    fprintf(
        stderr,
        "whirl %s: error: --measure: nothing can be counted on %s: %s\n"
        "hint: without --measure prices are predicted; `make deps` installs compilers and emulators\n",
        p->options->command, p->board->name, why);
}

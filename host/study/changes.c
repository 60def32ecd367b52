/* changes.c: see changes.h. */
#include "changes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/lang/shown.h"

overrides changes_at(const grid *g, const overrides *base, uint64_t point) {
    overrides changes = *base;
    double *value = alloc(g->count, sizeof *value);
    const char **texts = alloc(g->count, sizeof(const char *));
    grid_values(g, point, value);
    changes.value_count = 0;
    for (int i = 0; i < g->count; i++) {
        const axis *a = &g->axes[i];
        char number[NUMBER_SIZE];
        snprintf(number, sizeof number, "%.17g", value[i]);
        if (a->symbol == NULL) {
            if (changes.step != base->step) {
                free((void *)(uintptr_t)changes.step); /* a step swept twice: the last holds */
            }
            changes.step = alloc_words("%s", number);
        } else {
            texts[changes.value_count++] = shown_assignment(a->symbol, a->primes, number);
        }
    }
    changes.values = texts;
    free(value);
    return changes;
}

void changes_forget(const overrides *base, overrides *changes) {
    for (int i = 0; i < changes->value_count; i++) {
        free((void *)(uintptr_t)changes->values[i]);
    }
    free((void *)(uintptr_t)changes->values);
    if (changes->step != base->step) {
        free((void *)(uintptr_t)changes->step);
    }
}

static const char *command_of(const grid *g) { return g->command != NULL ? g->command : "sweep"; }

bool changes_take_part(const grid *g, const instance *base) {
    for (int i = 0; i < g->count; i++) {
        const symbol *swept = g->axes[i].symbol;
        const effect *missing = swept != NULL ? instance_lacks(base, swept) : NULL;
        if (missing != NULL) {
            fprintf(stderr,
                    "whirl %s: error: '%s' belongs to the effect '%s', which takes no part here\n"
                    "hint: add --with %s\n",
                    command_of(g), swept->name, missing->name, missing->name);
            return false;
        }
    }
    return true;
}

/* Does one of texts[count], NAME=VALUE, have this name? */
static bool names(const char *const *texts, int count, const char *name) {
    for (int i = 0; i < count; i++) {
        const char *from = texts[i] + strspn(texts[i], " \t");
        const char *rest = from + strcspn(from, " \t=");
        if (strlen(name) == (size_t)(rest - from) && strncmp(from, name, strlen(name)) == 0) {
            return true;
        }
    }
    return false;
}

bool changes_are_apart(const grid *g, const overrides *base) {
    for (int i = 0; i < g->count; i++) {
        const axis *a = &g->axes[i];
        const char *option = a->symbol == NULL ? (base->step != NULL ? "--step" : NULL)
                             : names(base->sets, base->set_count, a->name)     ? "--set"
                             : names(base->starts, base->start_count, a->name) ? "--start"
                                                                               : NULL;
        if (option != NULL) {
            fprintf(stderr,
                    "whirl %s: error: '%s' is swept by --over and given by %s\nhint: leave out one "
                    "of them\n",
                    command_of(g), a->name, option);
            return false;
        }
    }
    return true;
}

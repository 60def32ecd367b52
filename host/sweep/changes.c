/* changes.c: see changes.h. */
#include "changes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/room.h"

overrides changes_at(const grid *g, const overrides *base, uint64_t point) {
    overrides changes = *base;
    double *value = room(g->count, sizeof *value);
    const char **texts = room(g->count, sizeof(const char *));
    grid_values(g, point, value);
    changes.value_count = 0;
    for (int i = 0; i < g->count; i++) {
        const axis *a = &g->axes[i];
        const size_t size = strlen(a->name) + NUMBER_SIZE;
        char *text = room((int64_t)size, 1);
        if (a->symbol == NULL) {
            snprintf(text, size, "%.17g", value[i]);
            if (changes.step != base->step) {
                free((void *)(uintptr_t)changes.step); /* a step swept twice: the last holds */
            }
            changes.step = text;
        } else {
            snprintf(text, size, "%s=%.17g", a->name, value[i]);
            texts[changes.value_count++] = text;
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

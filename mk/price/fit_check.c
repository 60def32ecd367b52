/* fit_check.c: `price_fit --check`: predictions against rows that they were not fitted to. */
#include <stdio.h>
#include <stdlib.h>

#include "counted.h"

typedef struct checked {
    double off[ROWS_MAX];
    int count;
    int beyond;
    int unknown;
} checked;

static void check_figure(const cost_figure *told, double value, const counted *r, const char *what,
                         checked *to) {
    if (value <= 0.0) {
        return;
    }
    if (told->basis != COST_PREDICTED) {
        to->unknown++;
        return;
    }
    to->off[to->count++] = told->value > value ? told->value / value : value / told->value;
    if (value > told->most * (1.0 + 1e-9) || value < told->least * (1.0 - 1e-9)) {
        to->beyond++;
        printf(
            "not within its bound: %s %s %s %s %s: predicted %.0f (%.0f to %.0f), counted %.0f\n",
            r->column[3], r->column[5], r->column[4], r->column[6], what, told->value, told->least,
            told->most, value);
    }
}

int check_all(void) {
    static checked to[COST_QUANTITIES];
    int beyond = 0;
    for (int i = 0; i < row_count; i++) {
        const counted *r = &rows[i];
        const cost *p = &r->predicted;
        check_figure(&p->instructions, r->value[COST_OF_INSTRUCTIONS], r, "instructions",
                     &to[COST_OF_INSTRUCTIONS]);
        check_figure(&p->cycles, r->value[COST_OF_CYCLES], r, "cycles", &to[COST_OF_CYCLES]);
        check_figure(&p->flash_bytes, r->value[COST_OF_FLASH], r, "flash", &to[COST_OF_FLASH]);
        check_figure(&p->ram_bytes, r->value[COST_OF_RAM], r, "RAM", &to[COST_OF_RAM]);
        check_figure(&p->stack_bytes, r->value[COST_OF_STACK], r, "stack", &to[COST_OF_STACK]);
        check_figure(&p->instructions, r->value[COST_OF_CONTACT_MEAN], r, "mean with contacts",
                     &to[COST_OF_CONTACT_MEAN]);
    }
    for (int q = 0; q < COST_QUANTITIES; q++) {
        checked *t = &to[q];
        qsort(t->off, (size_t)t->count, sizeof t->off[0], by_size);
        if (t->count > 0) {
            printf(
                "%s: %d predictions, off by %.1f %% (median), %.1f %% (nine of ten), %.1f %% (largest); %d beyond their bound, %d not predicted\n",
                quantity_words[q], t->count, 100.0 * (t->off[t->count / 2] - 1.0),
                100.0 * (t->off[t->count * 9 / 10] - 1.0), 100.0 * (t->off[t->count - 1] - 1.0),
                t->beyond, t->unknown);
        }
        beyond += t->beyond;
    }
    return row_count == 0 || beyond > 0;
}

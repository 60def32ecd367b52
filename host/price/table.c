/* table.c: see table.h. */
#include "table.h"

#include <stdlib.h>

#include "host/base/room.h"
#include "host/number/functions.h"

/* Steps grow finer by 1, 2, 5, 10, 20, 50, ... in a record's spacing, up to so many. */
static const uint64_t mantissa[] = {1, 2, 5};
enum { MANTISSAS = 3, LADDER = 3 * 8 };

static uint64_t ladder(int rung) {
    uint64_t steps = mantissa[rung % MANTISSAS];
    for (int i = rung / MANTISSAS; i > 0; i--) {
        steps *= 10;
    }
    return steps;
}

/* A finer step helps no more when twice in a row it took off less than this part of the error. */
#define FALLS 0.7
enum { PATIENCE = 2 };

table_price table_price_of(const cost *c, double step_s, bool *known) {
    const bool cycles = c->cycles.basis != COST_RANGE && c->cycles.basis != COST_NOT_KNOWN;
    const cost_figure *f = cycles ? &c->cycles : &c->instructions;
    *known = f->basis != COST_NOT_KNOWN && f->basis != COST_RANGE;
    return (table_price){cycles, f->value / step_s, f->least / step_s, f->most / step_s};
}

static void add(table *made, table_row row) {
    made->row = room_more(made->row, made->count + 1, sizeof *made->row);
    made->row[made->count++] = row;
}

/* One setting by ever finer steps; `each`: operations that one trial may take. */
static void climb(trial *t, table *made, const setting *s, double each) {
    int stalled = 0;
    double before = (double)INFINITY;
    for (int rung = 0; rung < LADDER && stalled < PATIENCE; rung++) {
        table_row row = {.setting = *s, .steps = ladder(rung)};
        bool own;
        bool known;
        row.cost = trial_cost(t, s, row.steps, &own);
        row.price = table_price_of(&row.cost, ratio_times(1, trial_step(t, row.steps)), &known);
        if (!known) {
            made->unpriced++;
            made->why = row.cost.why;
            return;
        }
        const double started = t->operations;
        row.result = trial_run(t, s, row.steps);
        if (!row.result.ran) {
            return;
        }
        if (row.result.usable) {
            add(made, row);
            stalled = row.result.error > FALLS * before ? stalled + 1 : 0;
            before = number_least(before, row.result.error);
        } else {
            made->coarse++;
        }
        if ((t->operations - started) * 2.5 > each && row.result.usable) {
            made->broken_off += stalled < PATIENCE ? 1 : 0;
            return;
        }
    }
}

static int by_price(const void *left, const void *right) {
    const table_row *a = left;
    const table_row *b = right;
    if (a->price.value != b->price.value) {
        return a->price.value < b->price.value ? -1 : 1;
    }
    return (a->result.error > b->result.error) - (a->result.error < b->result.error);
}

static void mark_front(table *made) {
    double best = (double)INFINITY;
    for (int i = 0; i < made->count; i++) {
        table_row *row = &made->row[i];
        row->on_front = row->result.error < best;
        best = number_least(best, row->result.error);
    }
}

table *table_new(trial *t, const table_wish *w) {
    table *made = room(1, sizeof *made);
    const int count = setting_count();
    bool *own = room(count, sizeof *own);
    made->why = "";
    for (int i = 0; i < count && !t->stopped; i++) {
        const setting s = setting_at(i);
        (void)trial_cost(t, &s, 1, &own[i]);
        made->settings += own[i] ? 1 : 0;
    }
    int done = 0;
    for (int i = 0; i < count && !t->stopped; i++) {
        if (own[i]) {
            const setting s = setting_at(i);
            if (w->progress != NULL) {
                w->progress(w->context, done, made->settings);
            }
            climb(t, made, &s, w->operations / (2.0 * made->settings));
            done++;
        }
    }
    free(own);
    if (made->count > 0) {
        qsort(made->row, (size_t)made->count, sizeof *made->row, by_price);
    }
    mark_front(made);
    return made;
}

void table_free(table *made) {
    if (made != NULL) {
        free(made->row);
        free(made);
    }
}

/* price_table.c: see price_table.h. */
#include "price_table.h"

#include <math.h>
#include <stdlib.h>

#include "host/base/room.h"
#include "host/number/functions.h"

/* By 1, 2, 5, 10, 20, 50, ... */
deviation_pace table_ladder(int rung) {
    static const uint64_t mantissa[] = {1, 2, 5};
    const int i = rung < TABLE_COARSEST ? TABLE_COARSEST - rung : rung - TABLE_COARSEST;
    uint64_t many = mantissa[i % 3];
    for (int k = i / 3; k > 0; k--) {
        many *= 10;
    }
    return rung < TABLE_COARSEST ? (deviation_pace){1, many} : (deviation_pace){many, 1};
}

/* A finer step helps no more when twice in a row it took off less than this part of the error. */
#define FALLS 0.7
enum { PATIENCE = 2 };

const char *const table_unit_words[] = {[PRICE_CYCLES] = "cycles",
                                        [PRICE_INSTRUCTIONS] = "instructions",
                                        [PRICE_EVALUATIONS] = "evaluations"};

table_price table_price_of(const cost *c, double step_s, bool *known) {
    const bool cycles = c->cycles.basis != COST_RANGE && c->cycles.basis != COST_NOT_KNOWN;
    const cost_figure *f = cycles ? &c->cycles : &c->instructions;
    *known = f->basis != COST_NOT_KNOWN && f->basis != COST_RANGE;
    return (table_price){cycles ? PRICE_CYCLES : PRICE_INSTRUCTIONS, f->basis, f->value / step_s,
                         f->least / step_s, f->most / step_s};
}

static table_price price_by_evaluations(const trial_result *r) {
    return (table_price){PRICE_EVALUATIONS, COST_MEASURED, r->evaluations, r->evaluations,
                         r->evaluations};
}

static void add(table *made, table_row row) {
    row.order = made->count;
    made->row = room_more(made->row, made->count + 1, sizeof *made->row);
    made->row[made->count++] = row;
}

/* One setting by ever finer steps, each of them as dear but for a matrix's; `each`: operations that one trial may take. */
static void climb(trials *t, table *made, const setting *s, const cost *each_step, double each) {
    int stalled = 0;
    double before = (double)INFINITY;
    for (int rung = 0; rung < TABLE_LADDER && stalled < PATIENCE; rung++) {
        table_row row = {.setting = *s, .pace = table_ladder(rung), .cost = *each_step};
        if (row.pace.records > (uint64_t)t->records) {
            continue;
        }
        bool known;
        const double started = t->operations;
        if (setting_is_fixed(s) && trial_operations(t, s, row.pace) > each) {
            made->broken_off++; /* its price alone takes a run */
            return;
        }
        if (setting_price_varies(s)) {
            bool own;
            row.cost = trial_cost(t, s, row.pace, &own);
            if (!own) {
                made->coarse++;
                continue; /* in fixed point a step may be too long */
            }
        }
        row.price = table_price_of(&row.cost, ratio_times(1, trial_step(t, row.pace)), &known);
        if (!known && !made->counted) {
            made->unpriced++;
            made->why = row.cost.why;
            return;
        }
        row.result = trial_run(t, s, row.pace);
        if (!row.result.ran && !t->stopped && setting_price_varies(s)) {
            made->coarse++; /* the numbers of its matrix are too large */
            continue;
        }
        if (!row.result.ran) {
            return;
        }
        if (made->counted) {
            row.price = price_by_evaluations(&row.result);
        }
        if (row.result.usable) {
            add(made, row);
            stalled = row.result.error > FALLS * before ? stalled + 1 : 0;
            before = number_least(before, row.result.error);
        } else {
            made->coarse++;
        }
        if ((t->operations - started) * 2.5 > each) {
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
    if (a->result.error != b->result.error) {
        return a->result.error < b->result.error ? -1 : 1;
    }
    return a->order - b->order;
}

static void mark_front(table *made) {
    double best = (double)INFINITY;
    for (int i = 0; i < made->count; i++) {
        table_row *row = &made->row[i];
        row->on_front = row->result.error < best;
        best = number_least(best, row->result.error);
    }
}

void table_sort(table *made) {
    if (made->count > 0) {
        qsort(made->row, (size_t)made->count, sizeof *made->row, by_price);
    }
    mark_front(made);
}

table *table_new(trials *t, const table_wish *w) {
    table *made = room(1, sizeof *made);
    const int count = setting_count();
    bool *own = room(count, sizeof *own);
    cost *price = room(count, sizeof *price);
    made->why = "";
    t->planned_most = w->operations / (2.0 * count);
    int priced = 0;
    for (int i = 0; i < count && !t->stopped; i++) {
        const setting s = setting_at(i);
        price[i] = trial_any_cost(t, &s, table_ladder(TABLE_COARSEST), &own[i]);
        made->settings += own[i] ? 1 : 0;
        bool known;
        (void)table_price_of(&price[i], 1.0, &known);
        priced += own[i] && known ? 1 : 0;
        made->why = own[i] && !known ? price[i].why : made->why;
    }
    made->counted = priced == 0;
    int done = 0;
    for (int i = 0; i < count && !t->stopped; i++) {
        if (own[i]) {
            const setting s = setting_at(i);
            if (w->progress != NULL) {
                w->progress(w->context, done, made->settings);
            }
            climb(t, made, &s, &price[i], w->operations / (2.0 * made->settings));
            done++;
        }
    }
    free(own);
    free(price);
    table_sort(made);
    return made;
}

void table_free(table *made) {
    if (made != NULL) {
        free(made->row);
        free(made);
    }
}

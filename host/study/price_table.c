#include "price_table.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/number/functions.h"
#include "host/study/jobs.h"

/* A finer step helps no more after it took off less than this part of the error, twice in a row. */
#define FALLS 0.7
enum { PATIENCE = 2, COARSEST = 5, LADDER = COARSEST + 3 * 8, SUBSTEPS = 10 + 9 * 5 };

const char *const table_unit_words[] = {[PRICE_CYCLES] = "cycles",
                                        [PRICE_INSTRUCTIONS] = "instructions",
                                        [PRICE_EVALUATIONS] = "evaluations"};

bool table_pace(const table_wish *w, int rung, deviation_pace *pace) {
    static const uint64_t tens[] = {12, 15, 20, 25, 30, 40, 50, 60, 80};
    static const uint64_t mantissa[] = {1, 2, 5};
    const bool rated = w->rate_Hz > 0.0;
    const int from = rated ? rung - 10 : rung < COARSEST ? COARSEST - rung : rung - COARSEST;
    uint64_t many = !rated ? mantissa[from % 3] : from < 0 ? (uint64_t)rung + 1 : tens[from % 9];
    for (int k = from < 0 ? 0 : from / (rated ? 9 : 3); k > 0; k--) {
        many *= 10;
    }
    const bool longer = !rated && rung < COARSEST;
    *pace =
        longer ? (deviation_pace){1, many} : (deviation_pace){(rated ? w->periods : 1) * many, 1};
    return rung < (rated ? SUBSTEPS : LADDER);
}

uint64_t table_substeps(const table_wish *w, const table_row *row) {
    return w->rate_Hz > 0.0 ? row->pace.steps / w->periods : 0;
}

table_price table_price_of(const cost *c, double step_s, bool *known) {
    const bool cycles = c->cycles.basis != COST_RANGE && c->cycles.basis != COST_NOT_KNOWN;
    const cost_figure *f = cycles ? &c->cycles : &c->instructions;
    *known = f->basis != COST_NOT_KNOWN && f->basis != COST_RANGE;
    return (table_price){cycles ? PRICE_CYCLES : PRICE_INSTRUCTIONS, f->basis, f->value / step_s,
                         f->least / step_s, f->most / step_s};
}

/* --- one setting -----------------------------------------------------------------------------------*/

typedef enum ending { TRIED, NOT_OWN, UNPRICED, BROKEN_OFF } ending;

typedef struct climbed {
    ending end;
    const char *why; /* UNPRICED */
    double operations;
    int count;
    table_row row[SUBSTEPS];
} climbed;

/* With contacts rows are sorted by the evaluations of their runs. */
static void price_by_evaluations(table_row *row) {
    const double each = row->result.evaluations;
    row->price = (table_price){PRICE_EVALUATIONS, COST_MEASURED, each, each, each};
}

/* By ever finer steps, each of the same cost, except for a matrix and in fixed point. */
static void climb(trials *t, const table_wish *w, const setting *s, double each, climbed *c) {
    const bool contacts = t->image[0]->contacts > 0;
    deviation_pace first;
    bool own;
    bool known;
    (void)table_pace(w, w->rate_Hz > 0.0 ? 0 : COARSEST, &first);
    t->planned_most = each;
    const cost plain = trial_any_cost(t, s, first, &own);
    (void)table_price_of(&plain, 1.0, &known);
    if (!own || (!known && !contacts)) {
        c->end = own ? UNPRICED : NOT_OWN;
        c->why = plain.why;
        return;
    }
    int stalled = 0;
    double before = (double)INFINITY;
    table_row row = {.setting = *s};
    for (int rung = 0; table_pace(w, rung, &row.pace) && stalled < PATIENCE && !t->stopped;
         rung++) {
        if (row.pace.records > (uint64_t)t->records) {
            continue;
        }
        if (trial_operations(t, s, row.pace) > each) {
            c->end = BROKEN_OFF;
            return;
        }
        row.cost = setting_price_varies(s) ? trial_cost(t, s, row.pace, &own) : plain;
        row.price = table_price_of(&row.cost, ratio_times(1, trial_step(t, row.pace)), &known);
        row.result =
            own && (known || contacts) ? trial_run(t, s, row.pace) : (trial_result){.ran = false};
        if (!row.result.ran || !row.result.usable) {
            continue; /* also in fixed point and as a matrix, which take no step that long */
        }
        if (contacts) {
            price_by_evaluations(&row);
        }
        c->row[c->count++] = row;
        if (w->error > 0.0 && row.result.error * TABLE_MARGIN <= w->error) {
            return;
        }
        stalled = row.result.error > FALLS * before ? stalled + 1 : 0;
        before = number_least(before, row.result.error);
    }
}

/* --- all of them -------------------------------------------------------------------------------------*/

typedef struct table_work {
    trials *trials;
    const table_wish *wish;
    table *made;
    setting *setting; /* [count] */
    int count;
} table_work;

/* In a worker: its result goes to the parent as it lies in memory. */
static bool work(void *context, uint64_t point, FILE *out, FILE *reason) {
    const table_work *w = context;
    climbed *c = alloc(1, sizeof *c);
    (void)reason;
    const double before = w->trials->operations;
    climb(w->trials, w->wish, &w->setting[point], w->wish->operations / w->count, c);
    c->operations = w->trials->operations - before;
    const size_t size = offsetof(climbed, row) + (size_t)c->count * sizeof c->row[0];
    const bool good = fwrite(c, 1, size, out) == size;
    free(c);
    return good;
}

static bool deliver(void *context, uint64_t point, bool good, const char *row, const char *reason) {
    const table_work *w = context;
    table *made = w->made;
    climbed *c = alloc(1, sizeof *c);
    (void)point;
    (void)reason;
    memcpy(c, row, offsetof(climbed, row));
    made->row = alloc_more(made->row, made->count + c->count + 1, sizeof *made->row);
    memcpy(made->row + made->count, row + offsetof(climbed, row),
           (size_t)c->count * sizeof *made->row);
    made->count += c->count;
    made->settings += c->end != NOT_OWN;
    made->broken_off += c->end == BROKEN_OFF;
    made->unpriced += c->end == UNPRICED;
    made->why = c->end == UNPRICED ? c->why : made->why;
    w->trials->operations += c->operations;
    free(c);
    return good;
}

static bool tell_progress(void *context, uint64_t next) {
    const table_work *w = context;
    if (w->wish->progress != NULL) {
        w->wish->progress(w->wish->context, (int)next, w->count);
    }
    return true;
}

table *table_new(trials *t, const table_wish *w) {
    table *made = alloc(1, sizeof *made);
    table_work all = {t, w, made, alloc(setting_count(), sizeof(setting)), 0};
    made->why = "";
    for (int i = 0; i < setting_count(); i++) {
        const setting s = setting_at(i);
        if (setting_is_asked(&s, w->method)) {
            all.setting[all.count++] = s;
        }
    }
    const jobs j = {.workers = w->workers,
                    .end = (uint64_t)all.count,
                    .context = &all,
                    .work = work,
                    .deliver = deliver,
                    .pause = tell_progress};
    t->stopped = jobs_run(&j) != JOBS_DONE || t->stopped;
    free(all.setting);
    table_sort(made);
    return made;
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
    const int words = setting_order(&a->setting) - setting_order(&b->setting);
    return words != 0 ? words : (int)a->pace.steps - (int)b->pace.steps;
}

void table_sort(table *made) {
    double best = (double)INFINITY;
    if (made->count > 0) {
        qsort(made->row, (size_t)made->count, sizeof *made->row, by_price);
    }
    for (int i = 0; i < made->count; i++) {
        made->row[i].on_front = made->row[i].result.error < best;
        best = number_least(best, made->row[i].result.error);
    }
}

void table_free(table *made) {
    if (made != NULL) {
        free(made->row);
        free(made);
    }
}

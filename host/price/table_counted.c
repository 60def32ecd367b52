/* table_counted.c: see table_counted.h. */
#include "table_counted.h"

static int uncounted(const table *made, const measured_prices *m) {
    for (int i = 0; i < made->count; i++) {
        const table_row *row = &made->row[i];
        if (row->on_front && !measured_has(m, &row->setting, row->pace)) {
            return i;
        }
    }
    return made->count;
}

/* What was counted stands in all rows of its setting; what could not be built has none. */
static void enter(const trials *t, table *made, const measured_prices *m) {
    int kept = 0;
    for (int i = 0; i < made->count; i++) {
        table_row row = made->row[i];
        bool known;
        measured_tell(m, &row.setting, row.pace, &row.cost);
        row.price = table_price_of(&row.cost, ratio_times(1, trial_step(t, row.pace)), &known);
        if (known) {
            made->row[kept++] = row;
        } else {
            made->unpriced++;
            made->why = row.cost.why;
        }
    }
    made->count = kept;
    table_sort(made);
}

measured_end table_counted(trials *t, table *made, measured_prices *m, const table_wish *w) {
    for (int i = made->counted ? made->count : uncounted(made, m); i < made->count && !t->stopped;
         i = uncounted(made, m)) {
        const table_row *row = &made->row[i];
        if (w->progress != NULL) {
            w->progress(w->context, i, made->count);
        }
        if (measured_count(m, t, &row->setting, row->pace, row->result.point, &row->cost) ==
            MEASURED_MISSING) {
            return MEASURED_MISSING;
        }
        enter(t, made, m);
    }
    return MEASURED_COUNTED;
}

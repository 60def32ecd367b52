/* choice_counted.c: see choice_counted.h. */
#include "choice_counted.h"

#include "choice_price.h"

/* What an answer is made of that was not counted yet; NULL: it all was. */
static const choice_row *uncounted(const measured_prices *m, const choice *c) {
    const choice_row *rows[] = {c->found ? &c->best : NULL,
                                c->found && c->has_second ? &c->second : NULL,
                                !c->found && c->has_dearer ? &c->dearer : NULL,
                                !c->found && c->has_larger ? &c->larger : NULL,
                                !c->found && c->has_any ? &c->any : NULL,
                                !c->found && c->has_weaker ? &c->weaker : NULL};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        if (rows[i] != NULL && !measured_has(m, &rows[i]->setting, rows[i]->pace)) {
            return rows[i];
        }
    }
    return NULL;
}

choice choice_counted(trials *t, choice_wish *w, measured_prices *m, measured_end *end) {
    trial_memo memo = {.count = 0};
    m->by_run = t->without_events = t->image[0]->contacts > 0;
    w->counted = m;
    w->memo = &memo;
    *end = MEASURED_COUNTED;
    choice c = choice_make(t, w);
    const choice_row *next = uncounted(m, &c);
    while (next != NULL && !t->stopped && *end != MEASURED_MISSING) {
        if (w->counting != NULL) {
            w->counting(w->context, m->count);
        }
        *end = measured_count(m, t, &next->setting, next->pace, next->result.point, &next->cost);
        t->stopped = t->stopped || (t->wish.stop != NULL && *t->wish.stop);
        if (*end != MEASURED_MISSING) {
            choice_learn_run(m, next);
            c = choice_make(t, w);
            next = uncounted(m, &c);
        }
    }
    w->memo = NULL;
    trial_memo_free(&memo);
    return c;
}

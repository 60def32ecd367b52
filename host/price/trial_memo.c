/* trial_memo.c: see trial_memo.h. */
#include "trial_memo.h"

#include <stdlib.h>
#include <string.h>

#include "host/base/room.h"

void trial_memo_free(trial_memo *m) { free(m->known); }

static const trial_known *find(const trial_memo *m, const char *options, deviation_pace pace) {
    for (int i = 0; i < m->count; i++) {
        const trial_known *k = &m->known[i];
        if (k->pace.steps == pace.steps && k->pace.records == pace.records &&
            strcmp(k->options, options) == 0) {
            return k;
        }
    }
    return NULL;
}

trial_result trial_memo_run(trial_memo *m, trials *t, const setting *s, deviation_pace pace) {
    if (m == NULL) {
        return trial_run(t, s, pace);
    }
    trial_known next = {.pace = pace};
    setting_options(s, true, next.options);
    const trial_known *known = find(m, next.options, pace);
    if (known != NULL) {
        t->operations += known->operations;
        return known->result;
    }
    const double before = t->operations;
    next.result = trial_run(t, s, pace);
    next.operations = t->operations - before;
    if (!t->stopped) {
        m->known = room_more(m->known, m->count + 1, sizeof *m->known);
        m->known[m->count++] = next;
    }
    return next.result;
}

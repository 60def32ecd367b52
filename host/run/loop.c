/* loop.c: see loop.h. */
#include "loop.h"

#include <stddef.h>

static bool see(const loop *l, uint64_t step) {
    bool on = true;
    for (int i = 0; i < LOOP_OBSERVERS; i++) {
        const loop_observer *each = &l->see[i];
        on = (each->see == NULL || each->see(each->of, step)) && on;
    }
    return on;
}

loop_end loop_run(const loop *l, wh_status *status) {
    *status = WH_OK;
    for (uint64_t step = l->kind->steps(l->run);; step++) {
        if (!see(l, step)) {
            return LOOP_ENOUGH;
        }
        if (step == l->steps) {
            return LOOP_DONE;
        }
        if (l->stop != NULL && *l->stop) {
            return LOOP_INTERRUPTED;
        }
        *status = loop_steps(l->kind, l->run, 1);
        if (*status != WH_OK) {
            return LOOP_FAILED;
        }
    }
}

wh_status loop_steps(const engine_kind *kind, void *run, uint64_t count) {
    wh_status status = WH_OK;
    for (uint64_t i = 0; i < count && status == WH_OK; i++) {
        status = kind->step(run);
    }
    return status;
}

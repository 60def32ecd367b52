#include "loop.h"

#include <stddef.h>

#include "host/os/system.h"

void budget_begin(budget *b) {
    if (b->depth++ == 0) {
        b->since = engine_operations;
    }
}

void budget_end(budget *b) {
    if (--b->depth == 0) {
        b->spent += engine_operations - b->since;
    }
}

double budget_left(const budget *b) {
    const uint64_t now = b->depth > 0 ? engine_operations - b->since : 0;
    const double own = (double)b->own;
    return (own > BUDGET_LEAST ? own : BUDGET_LEAST) - (double)(b->spent + now);
}

loop_end loop_run(const loop *l, wh_status *status) {
    *status = WH_OK;
    for (uint64_t step = l->kind->steps(l->run);; step++) {
        if (l->see != NULL && !l->see(l->of, step)) {
            return LOOP_ENOUGH;
        }
        if (step == l->steps) {
            return LOOP_DONE;
        }
        if (interrupted) {
            return LOOP_INTERRUPTED;
        }
        if (l->pays != NULL && budget_left(l->pays) < 0.0) {
            return LOOP_SPENT;
        }
        const uint64_t before = engine_operations;
        *status = loop_steps(l->kind, l->run, 1);
        if (l->own != NULL) {
            l->own->own += engine_operations - before;
        }
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

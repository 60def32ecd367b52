/* loop.h: the one loop that steps a run. Its observers see the state at the start and after each step.
 *
 * Only host/pil/plant.c steps by itself: firmware paces it. tests/house.sh refuses other loops.
 */
#ifndef RUN_LOOP_H
#define RUN_LOOP_H

#include <signal.h>

#include "engine.h"

typedef struct loop_observer {
    bool (*see)(void *of, uint64_t step); /* after this many steps; false: enough */
    void *of;
} loop_observer;

enum { LOOP_OBSERVERS = 4 };

typedef struct loop {
    const engine_kind *kind;
    void *run; /* started, and stopped, by the caller */
    uint64_t steps;
    const volatile sig_atomic_t *stop; /* an interrupt; NULL: none is asked for */
    loop_observer see[LOOP_OBSERVERS]; /* in this order; those without a function are left out */
} loop;

typedef enum loop_end {
    LOOP_DONE,
    LOOP_FAILED, /* the step's status says why */
    LOOP_ENOUGH, /* for an observer */
    LOOP_INTERRUPTED
} loop_end;

/* From the present step to the last. */
loop_end loop_run(const loop *l, wh_status *status);

/* So many steps on, unseen, as far as they are good. */
wh_status loop_steps(const engine_kind *kind, void *run, uint64_t count);

#endif

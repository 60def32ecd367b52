/* loop.h: the loop that steps a run, and the budget of the run's checks. Only host/pil/plant.c has its own loop,
 * because there the firmware determines when a step is made. */
#ifndef ENGINE_LOOP_H
#define ENGINE_LOOP_H

#include "engine.h"

/* All checks of a run share one budget of operations: the larger of BUDGET_LEAST and the run's own operations. A check
 * ends when the budget is exhausted. */
typedef struct budget {
    uint64_t own;   /* operations of the run's steps so far */
    uint64_t spent; /* operations of completed checks */
    uint64_t since; /* engine_operations at the begin of the present check */
    int depth;      /* number of open checks, which may be nested */
} budget;

#define BUDGET_LEAST 2.4e8 /* operations in about a second */

void budget_begin(budget *b);
void budget_end(budget *b);
/* The remaining operations; below 0, the budget is exhausted. */
double budget_left(const budget *b);

typedef struct loop {
    const engine_kind *kind;
    void *run; /* started, and stopped, by the caller */
    uint64_t steps;
    budget *own;        /* counts the operations of the steps; NULL: unused */
    const budget *pays; /* the loop ends when this budget is exhausted; NULL: no limit */
    /* Called at the start and after each step; false ends the loop. NULL: no call. */
    bool (*see)(void *of, uint64_t step);
    void *of;
} loop;

typedef enum loop_end {
    LOOP_DONE,
    LOOP_FAILED, /* a step failed: the reason is in loop_run()'s *status */
    LOOP_ENOUGH, /* the callback see() returned false */
    LOOP_INTERRUPTED,
    LOOP_SPENT /* the budget is empty */
} loop_end;

/* Steps the run from the present step to the last, or to an interrupt (host/os/system.h). */
loop_end loop_run(const loop *l, wh_status *status);

/* Makes `count` steps, without callbacks. Stops at the first failure. */
wh_status loop_steps(const engine_kind *kind, void *run, uint64_t count);

#endif

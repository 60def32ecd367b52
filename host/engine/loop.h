/* loop.h: the one loop that steps a run, and what looks at a run may spend. Only host/pil/plant.c steps by itself: firmware
 * paces it. tests/house.sh refuses other loops. */
#ifndef ENGINE_LOOP_H
#define ENGINE_LOOP_H

#include "engine.h"

/* All looks at a run draw on one budget, counted in operations (engine_operations): together as many as its own steps
 * take, or a fixed number, which takes about a second, whichever is more. A look that finds it empty ends. The looks in order
 * of importance: books, and what is watched beside them, at each step; the finer run; poles and missed contacts; the third
 * run of aliasing; remedies; the rows of accuracy and cost. */
typedef struct budget {
    uint64_t own;   /* operations of the run's steps so far */
    uint64_t spent; /* by looks that have ended */
    uint64_t since; /* engine_operations when the present one began */
    int depth;      /* looks that are open: one may take another */
} budget;

#define BUDGET_LEAST 2.4e8 /* about a second's */

/* A look begins, and ends. */
void budget_begin(budget *b);
void budget_end(budget *b);
/* Operations that are left. Below 0: none. */
double budget_left(const budget *b);

typedef struct loop {
    const engine_kind *kind;
    void *run; /* started, and stopped, by the caller */
    uint64_t steps;
    budget *own;        /* takes what the steps are; NULL: nobody asks */
    const budget *pays; /* for them; NULL: nobody does */
    /* At the start and after each step; false: enough. NULL: nobody sees. */
    bool (*see)(void *of, uint64_t step);
    void *of;
} loop;

typedef enum loop_end {
    LOOP_DONE,
    LOOP_FAILED, /* the step's status says why */
    LOOP_ENOUGH, /* for an observer */
    LOOP_INTERRUPTED,
    LOOP_SPENT /* the budget is empty */
} loop_end;

/* From the present step to the last, or to an interrupt (host/base/interrupts.h). */
loop_end loop_run(const loop *l, wh_status *status);

/* So many steps on, unseen, as far as they are good. */
wh_status loop_steps(const engine_kind *kind, void *run, uint64_t count);

#endif

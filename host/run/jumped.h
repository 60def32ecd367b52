/* jumped.h: steps that jump over a pole, or through something (missed.h). Where an expression of the file grows without bound, as x'/(v0 + x') does at
 * x' = -v0, no motion gets through, but a step that is longer than the way there never sees it; nor does one of half the
 * length, so that the two agree.
 *
 * What changes its sign at a pole (divisors.h) is looked at after each step. Where one has, the way between the two states
 * is asked for a pole there (pole.h). In steps with events the divisors that depend on places alone are asked: rates that an
 * impact turns pass nothing, nor does what a crossing sets. */
#ifndef RUN_JUMPED_H
#define RUN_JUMPED_H

#include "missed.h"

typedef struct jumped jumped;

/* NULL where nothing that moves is divided by, and nothing is to be touched. */
jumped *jumped_open(const image *im);
void jumped_close(jumped *j); /* NULL is fine */
/* Enter the state after each step, the start included. Nothing is looked for behind the first pole. */
void jumped_enter(jumped *j, const engine_kind *kind, const void *run);
/* A step that is not looked at; nor is the next one entered. And how many were not. */
void jumped_pass(jumped *j);
uint64_t jumped_unseen(const jumped *j);
/* Has the run jumped over one? */
bool jumped_some(const jumped *j);
/* The contact that it passed through, as missed_enter() tells, and when that step began; nothing: it was a pole. */
missed_found jumped_through(const jumped *j, double *begin_s);
/* The expression whose pole it was, and when that step began. */
const blame_question *jumped_over(const jumped *j, double *begin_s);

#endif

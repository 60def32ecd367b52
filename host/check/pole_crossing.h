/* pole_crossing.h: steps that jump over a pole, or through something (missed.h). Where an expression of the file grows without bound, as x'/(v0 + x') does at
 * x' = -v0, no motion gets through, but a step that is longer than the way there never sees it; nor does one of half the
 * length, so that the two agree.
 *
 * What changes its sign at a pole (denominators.h) is looked at after each step. Where one has, the way between the two states
 * is asked for a pole there (pole.h). In steps with events the divisors that depend on places alone are asked: rates that an
 * impact turns pass nothing, nor does what a crossing sets. */
#ifndef CHECK_POLE_CROSSING_H
#define CHECK_POLE_CROSSING_H

#include "missed.h"

typedef struct pole_crossing pole_crossing;

/* NULL where nothing that moves is divided by, and nothing is to be touched. */
pole_crossing *pole_crossing_open(const image *im);
void pole_crossing_close(pole_crossing *j); /* NULL is fine */
/* Enter the state after each step, the start included. Nothing is looked for behind the first pole. */
void pole_crossing_enter(pole_crossing *j, const engine_kind *kind, const void *run);
/* A step that is not looked at; nor is the next one entered. And how many were not. */
void pole_crossing_pass(pole_crossing *j);
uint64_t pole_crossing_unseen(const pole_crossing *j);
/* Has the run jumped over one? */
bool pole_crossing_some(const pole_crossing *j);
/* The contact that it passed through, as missed_enter() tells, and when that step began; nothing: it was a pole. */
missed_found pole_crossing_through(const pole_crossing *j, double *begin_s);
/* The expression whose pole it was, and when that step began. */
const diagnostics_question *pole_crossing_over(const pole_crossing *j, double *begin_s);

#endif

/* jumped.h: steps that jump over a pole. Where an expression of the file grows without bound, as x'/(v0 + x') does at
 * x' = -v0, no motion gets through, but a step that is longer than the way there never sees it; nor does one of half the
 * length, so that the two agree.
 *
 * What is divided by, or raised to less than nothing, is looked at after each step. Where its sign has changed, the way
 * between the two states is halved again and again about that place: a pole is where the expression as a whole grows as
 * one over the distance does, on both sides, or faster. What has a limit there (sin x/x, a sine times a tangent), or may
 * be integrated (one over a root), is none. Steps with events are left out: rates that an impact turns pass nothing. */
#ifndef RUN_JUMPED_H
#define RUN_JUMPED_H

#include "engine.h"

typedef struct jumped jumped;

/* NULL where nothing that moves is divided by. */
jumped *jumped_open(const image *im);
void jumped_close(jumped *j); /* NULL is fine */
/* Enter the state after each step, the start included. Nothing is looked for behind the first pole. */
void jumped_enter(jumped *j, const engine_kind *kind, const void *run);
/* Has the run jumped over one? */
bool jumped_some(const jumped *j);
/* The expression whose pole it was, and when that step began. */
const blame_question *jumped_over(const jumped *j, double *begin_s);

#endif

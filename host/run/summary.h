/* summary.h: what a run came to, in words. */
#ifndef RUN_SUMMARY_H
#define RUN_SUMMARY_H

#include <stdio.h>

#include "belief.h"
#include "books.h"
#include "engine.h"

/* The scene, its effects, how it was integrated. */
void summary_head(FILE *out, const image *im, const engine_kind *kind, const void *run);

/* The numbers. `books` may be NULL; `balance` is theirs. The same run has the same summary: nothing in it is timed. */
void summary_print(FILE *out, const image *im, const engine_kind *kind, void *run, const books *b,
                   const belief *balance);

#endif

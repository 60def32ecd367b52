/* summary.h: what a run came to, in words. */
#ifndef RUN_SUMMARY_H
#define RUN_SUMMARY_H

#include <stdio.h>

#include "belief.h"
#include "simulate.h"

/* `books` may be NULL; `balance` is theirs. `step_ns` is the wall time of a step (sampled). */
void summary_print(FILE *out, const image *im, const simulation_settings *s, void *run,
                   const books *b, const belief *balance, double step_ns);

#endif

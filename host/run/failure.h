/* failure.h: why a run has ended before its time, in words, and what would do. */
#ifndef RUN_FAILURE_H
#define RUN_FAILURE_H

#include "verdict.h"

/* A step came back with `status`: the expression that was no number there, or the coordinate that left all bounds. */
void failure_say(FILE *out, const engine_kind *kind, const void *run, wh_status status,
                 const verdict *about, const image *plain, const volatile sig_atomic_t *stop);

#endif

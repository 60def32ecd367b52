/* progress.h: a bar with rate and time to go, on one line that is drawn over again. */
#ifndef SWEEP_PROGRESS_H
#define SWEEP_PROGRESS_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

typedef struct progress {
    FILE *out;     /* NULL: nothing is drawn */
    uint64_t from; /* points done before it began */
    uint64_t end;
    double start_s;
    double shown_s;
    bool drawn;
} progress;

progress progress_start(FILE *out, uint64_t from, uint64_t end);
/* Draw, at most five times a second. */
void progress_show(progress *p, uint64_t done);
/* Take the line away, so that something else can be written. */
void progress_clear(progress *p);
double progress_elapsed_s(const progress *p);

#endif

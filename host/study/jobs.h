/* jobs.h: points worked on by several processes, delivered in order.
 *
 * The parent hands numbers out over one pipe; whichever worker is free takes the next. Rows come
 * back over a pipe for each worker and are delivered by rising number, at once when their turn has
 * come. What a worker does for a point must depend on nothing but the point: then what is delivered does
 * not depend on the number of workers. Workers end when the parent does, however it ends. */
#ifndef STUDY_JOBS_H
#define STUDY_JOBS_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

typedef struct jobs {
    int workers; /* >= 1 */
    uint64_t first;
    uint64_t end;
    void *context;
    /* In a worker: write the point's row, and in `reason` what else deliver() is to know of it,
     * as one line or nothing. False when it failed. */
    bool (*work)(void *context, uint64_t point, FILE *row, FILE *reason);
    /* In the parent, in order. False ends it all. */
    bool (*deliver)(void *context, uint64_t point, bool good, const char *row, const char *reason);
    /* In the parent, after some rows or a moment: write out what was delivered, show progress. */
    bool (*pause)(void *context, uint64_t next);
} jobs;

typedef enum jobs_result {
    JOBS_DONE,
    JOBS_STOPPED,    /* interrupted */
    JOBS_REFUSED,    /* deliver or pause said so */
    JOBS_WORKER_LOST /* a worker ended early, or none could be started (said) */
} jobs_result;

#define JOBS_WORKERS_MAX 1024

jobs_result jobs_run(const jobs *j);

#endif

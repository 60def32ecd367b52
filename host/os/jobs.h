/* jobs.h: points computed by several processes, the workers. A free worker takes the next point's number from a pipe,
 * and sends the point's row over its own pipe. The parent delivers rows in the order of points. A row must depend only
 * on its point: then the output is the same for any number of workers. Workers end if their parent ends. */
#ifndef OS_JOBS_H
#define OS_JOBS_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

typedef struct jobs {
    int workers; /* >= 1 */
    uint64_t first;
    uint64_t end;
    void *context;
    /* In a worker: writes the point's row, and one line or nothing to `reason`. Returns false if the point failed. */
    bool (*work)(void *context, uint64_t point, FILE *row, FILE *reason);
    /* Runs in the parent, for one point after another. If deliver() returns false, all work ends. */
    bool (*deliver)(void *context, uint64_t point, bool good, const char *row, const char *reason);
    /* In the parent, after some rows or a short time: writes delivered rows to disk, and shows the progress. */
    bool (*pause)(void *context, uint64_t next);
} jobs;

typedef enum jobs_result {
    JOBS_DONE,
    JOBS_STOPPED,    /* interrupted */
    JOBS_REFUSED,    /* deliver() or pause() returned false */
    JOBS_WORKER_LOST /* a worker ended early, or could not be started (reported) */
} jobs_result;

#define JOBS_WORKERS_MAX 1024
int jobs_workers(void);

jobs_result jobs_run(const jobs *j);

#endif

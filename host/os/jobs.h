/* jobs.h: points computed by several processes and delivered in order.
 *
 * The parent hands out numbers over one pipe, and the next free worker takes one. Rows come back over a
 * pipe per worker and are delivered by rising number, as soon as possible. A worker's result for a point
 * must depend on the point alone. Then the delivery does not depend on the number of workers. Workers
 * end when the parent does, even after a crash. */
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
    /* Called in a worker: writes the point's row, and into `reason` one line or nothing for deliver(). Returns false if
     * it failed. */
    bool (*work)(void *context, uint64_t point, FILE *row, FILE *reason);
    /* Called in the parent, in order of the points: takes a row. Returning false ends all work. */
    bool (*deliver)(void *context, uint64_t point, bool good, const char *row, const char *reason);
    /* Called in the parent, after some rows or a short time: writes out the delivered rows, and shows the
     * progress. */
    bool (*pause)(void *context, uint64_t next);
} jobs;

typedef enum jobs_result {
    JOBS_DONE,
    JOBS_STOPPED,    /* interrupted */
    JOBS_REFUSED,    /* deliver or pause returned false */
    JOBS_WORKER_LOST /* a worker ended early, or could not be started (reported) */
} jobs_result;

#define JOBS_WORKERS_MAX 1024
/* The number of processors. */
int jobs_workers(void);

jobs_result jobs_run(const jobs *j);

#endif

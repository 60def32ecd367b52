/* recorded.h: records of the plant of a run in the loop as comma-separated values, in the columns of
 * host/io/records.h. */
#ifndef PIL_RECORDED_H
#define PIL_RECORDED_H

#include "host/io/records.h"

typedef struct recorded {
    const char *name; /* of the file; "-": standard output */
    FILE *file;
    records *rows;
    uint64_t every; /* steps between rows */
} recorded;

/* A row every every_s seconds. Below 0: every millisecond, or each step if a millisecond is not a whole number of
 * steps. False, reported, if every_s is not a whole number of steps, or the file cannot be written. With `name` NULL
 * nothing is recorded. */
bool recorded_open(recorded *r, const char *name, const image *im, double every_s);
void recorded_enter(recorded *r, void *run, uint64_t steps);
/* False, reported, if the file is incomplete. */
bool recorded_close(recorded *r);

#endif

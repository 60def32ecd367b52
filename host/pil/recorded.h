/* recorded.h: the plant of a run in the loop as comma-separated values, in the columns of host/run/records.h. */
#ifndef PIL_RECORDED_H
#define PIL_RECORDED_H

#include "host/run/records.h"

typedef struct recorded {
    const char *name; /* of the file; "-": standard output */
    FILE *file;
    records *rows;
    uint64_t every; /* steps from one row to the next */
} recorded;

/* Every every_s seconds; below 0: every millisecond, or each step where a millisecond is no whole number of them. False, reported:
 * every_s is no whole number of steps, or the file cannot be written. `name` NULL: nothing is recorded. */
bool recorded_open(recorded *r, const char *name, const image *im, double every_s);
void recorded_enter(recorded *r, void *run, uint64_t steps);
/* False, reported: not all could be written. */
bool recorded_close(recorded *r);

#endif

/* minmax_decimation.h: min–max decimation of a run for a picture, in bounded memory. Each stretch of steps
 * ("bucket") has the least and the greatest value of every column, in their order of time. No peak is lost, and a
 * vibration faster than the picture's resolution appears as a band, not as a slower vibration.
 *
 * A bucket is one step at first: a run with fewer steps than the room is stored completely. When the room is full,
 * buckets are merged by two, and from then on each takes twice as many steps. So the buckets always cover the whole
 * run so far, in at least half of the room. */
#ifndef IO_MINMAX_DECIMATION_H
#define IO_MINMAX_DECIMATION_H

#include <stdbool.h>
#include <stdint.h>

/* Most buckets. */
#define DECIMATION_ROOM 4000U

typedef struct decimation decimation;

/* For rows with `columns` columns (> 0). `samples`: each bucket has its first row instead of extremes. This is for
 * columns that belong together, as in a path of one column over another. */
decimation *decimation_new(int columns, bool samples);
void decimation_free(decimation *v); /* NULL is allowed */

/* Enters the row[columns] of the next step. Non-finite values are kept while a bucket is one step; a longer
 * bucket drops them if it has finite ones. */
void decimation_enter(decimation *v, const double *row);

/* The rows to draw: one for a bucket of one step, else two. Each column has its least and its greatest value
 * in their order of time; a rising column, such as the time, has its first and its last. Free the result. */
double *decimation_rows(const decimation *v, int *rows);

#endif

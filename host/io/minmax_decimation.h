/* minmax_decimation.h: the course of a run for a picture, in bounded memory: of each stretch of steps ("bucket") the
 * least and the greatest value of every column, in the order in which they came. No peak is lost, and what swings
 * faster than the picture can show is drawn as the band that it fills, not as a slower swing.
 *
 * A bucket is one step at first: a run with fewer steps than there is room for is kept whole, number by number.
 * When the room is full, buckets are merged by two and take twice as many steps each from then on, so that at
 * every moment what there is covers the whole run so far, in half as many buckets or more. */
#ifndef IO_MINMAX_DECIMATION_H
#define IO_MINMAX_DECIMATION_H

#include <stdbool.h>
#include <stdint.h>

/* Buckets at most. */
#define DECIMATION_ROOM 4000U

typedef struct decimation decimation;

/* Of rows with so many columns (> 0). `samples`: the first row of each bucket in place of extremes, whose columns belong
 * together: for a path of one column over another. */
decimation *decimation_new(int columns, bool samples);
void decimation_free(decimation *v); /* NULL is allowed */

/* Enter the row[columns] of the next step. Values that are no finite numbers are kept while a bucket is one
 * step, and pass over where it is more and has others. */
void decimation_enter(decimation *v, const double *row);

/* The rows to draw, row by row: one a bucket of one step, else two, of which each column has its least and its
 * greatest value in the order in which they came; a column that only rises, as the time does, has its first
 * and its last. Free the result. */
double *decimation_rows(const decimation *v, int *rows);

#endif

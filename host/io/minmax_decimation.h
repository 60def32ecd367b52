/* minmax_decimation.h: min–max decimation of a run for a picture, in bounded memory. A "bucket" of consecutive steps
 * keeps the least and the greatest value of every column, in their order of time. So the picture shows each peak. If
 * all buckets are full, pairs of buckets are merged. */
#ifndef IO_MINMAX_DECIMATION_H
#define IO_MINMAX_DECIMATION_H

#include <stdbool.h>
#include <stdint.h>

#define DECIMATION_ROOM 4000U

typedef struct decimation decimation;

/* Each row has `columns` (> 0) columns. If `samples`, each bucket keeps its first row instead of extremes: a path of
 * one column over another needs values of the same time. */
decimation *decimation_new(int columns, bool samples);
void decimation_free(decimation *v); /* NULL is allowed */

/* Adds row[columns] of the next step. A bucket ignores a column's non-finite values if it also has finite ones. */
void decimation_enter(decimation *v, const double *row);

/* Returns the rows to draw, which the caller frees. If buckets have one step, or if decimation_new() had
 * `samples`, each bucket gives one row. If not, each bucket gives two: each column's extremes, in order of time. */
double *decimation_rows(const decimation *v, int *rows);

#endif

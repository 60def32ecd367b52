/* gauss.h: Gauss elimination of matrices of doubles, stored by rows. */
#ifndef NUMBER_GAUSS_H
#define NUMBER_GAUSS_H

#include <stdbool.h>

/* Reduces m[rows * columns] until each pivot is the only nonzero entry of its column. The rows with a pivot come first,
 * and are not divided by it. If `full` is false, the first `pivots` columns are searched one after the other, and the
 * largest entry of a column is its pivot. If `full` is true, the next pivot is the largest entry in any of these
 * columns. An entry with a size of at most `zero` is no pivot. Returns the rank. lead[rank]: the columns of the pivots,
 * in rising order if `full` is false. */
int gauss_reduce(double *m, int rows, int columns, int pivots, bool full, double zero, int *lead);

/* Eliminates below the diagonal of m[n * n] without exchanging rows. The pivots are then on the diagonal. Below a pivot
 * that is zero, nothing is eliminated. */
void gauss_pivots(double *m, int n);

#endif

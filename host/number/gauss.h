/* gauss.h: Gauss elimination of matrices of doubles, stored by rows. */
#ifndef NUMBER_GAUSS_H
#define NUMBER_GAUSS_H

#include <stdbool.h>

/* Reduces m[rows * columns] until each pivot is the only nonzero entry of its column. Each next pivot is the largest
 * entry of the rows that have none: in the next of the first `pivots` columns, or, if `full`, in any of them. Entries
 * up to `zero` in size are no pivots. Rows with a pivot come first, and are not divided by it. Returns the rank.
 * lead[rank]: the pivots' columns, in rising order if not `full`. */
int gauss_reduce(double *m, int rows, int columns, int pivots, bool full, double zero, int *lead);

/* Eliminates below the diagonal of m[n * n] without exchanging rows. Columns with a zero pivot are skipped. */
void gauss_pivots(double *m, int n);

#endif

/* gauss.h: Gauss's elimination of matrices of doubles, by rows. */
#ifndef NUMBER_GAUSS_H
#define NUMBER_GAUSS_H

#include <stdbool.h>

/* Reduces m[rows * columns] until each pivot is the only nonzero entry of its column. Rows with a pivot come first, and are not
 * divided by it. Pivots are searched in the first `pivots` columns, one column after the other, or with `full` in all of them for
 * the largest entry. An entry of at most `zero` in size is no pivot. Returns the rank; lead[rank] has the pivots' columns, in rising
 * order except with `full`. */
int gauss_reduce(double *m, int rows, int columns, int pivots, bool full, double zero, int *lead);

/* Eliminates below the diagonal of m[n * n] without exchanging rows, which leaves the pivots on the diagonal. A zero pivot eliminates
 * nothing. */
void gauss_pivots(double *m, int n);

#endif

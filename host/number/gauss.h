/* gauss.h: Gauss elimination of matrices of doubles, stored by rows. */
#ifndef NUMBER_GAUSS_H
#define NUMBER_GAUSS_H

#include <stdbool.h>

/* Gauss-Jordan elimination of m[rows * columns], with pivots in the first `pivots` columns. Pivots exceed `zero` in
 * absolute value. Pivoting is partial, or complete if `full`. Rows with a pivot come first, and are not divided by the
 * pivot. lead[row] is the column of the row's pivot, and rises with `row` if not `full`. Returns the rank. */
int gauss_reduce(double *m, int rows, int columns, int pivots, bool full, double zero, int *lead);

/* Eliminates below the diagonal of m[n * n] without exchanging rows. Columns with a zero pivot are skipped. */
void gauss_pivots(double *m, int n);

#endif

/* gauss.h: Gauss elimination of matrices of doubles, stored by rows. */
#ifndef NUMBER_GAUSS_H
#define NUMBER_GAUSS_H

#include <stdbool.h>

/* Reduces m[rows * columns] until each pivot is the only nonzero entry of its column. Pivots lie in the first `pivots`
 * columns, and exceed `zero` in absolute value. In one column after the other, the largest entry in a row without a
 * pivot becomes one. If `full`, the next pivot is the largest entry of all these columns. Rows with a pivot come first,
 * and are not divided by it. Sets lead[row] to the pivot's column (rising if not `full`). Returns the rank. */
int gauss_reduce(double *m, int rows, int columns, int pivots, bool full, double zero, int *lead);

/* Eliminates below the diagonal of m[n * n] without exchanging rows. Columns with a zero pivot are skipped. */
void gauss_pivots(double *m, int n);

#endif

/* gauss.h: Gauss elimination of matrices of doubles, stored by rows. */
#ifndef NUMBER_GAUSS_H
#define NUMBER_GAUSS_H

#include <stdbool.h>

/* Reduces m[rows * columns] until each pivot is the only nonzero entry of its column. Only the first `pivots` columns
 * have pivots. A column's pivot is its largest entry in the rows without a pivot, if |entry| > `zero`. If `full`, each
 * pivot is the largest such entry of all these columns. Rows with a pivot are moved to the top, and are not divided by
 * it. Sets lead[row] to the column of the row's pivot (rising if not `full`). Returns the rank. */
int gauss_reduce(double *m, int rows, int columns, int pivots, bool full, double zero, int *lead);

/* Eliminates below the diagonal of m[n * n] without exchanging rows. Columns with a zero pivot are skipped. */
void gauss_pivots(double *m, int n);

#endif

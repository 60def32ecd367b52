/* gauss.h: Gauss's elimination of matrices of doubles, by rows. */
#ifndef NUMBER_GAUSS_H
#define NUMBER_GAUSS_H

#include <stdbool.h>

/* Eliminates from m[rows * columns] until each pivot stands alone in its column; rows with a pivot come first and are not divided
 * by it. The columns are searched in order, the first `pivots` of them; `full`: all at once for the largest entry. An entry of
 * at most `zero` in size is no pivot. Returns the rank; lead[rank] are the pivots' columns, rising but for `full`. */
int gauss_reduce(double *m, int rows, int columns, int pivots, bool full, double zero, int *lead);

/* Eliminates below the diagonal of m[n * n] in the given order, which leaves the pivots on the diagonal. Nothing is eliminated with
 * a pivot of zero. */
void gauss_pivots(double *m, int n);

#endif

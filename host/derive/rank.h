/* rank.h: the rank of a matrix of numbers, independent of its units. */
#ifndef DERIVE_RANK_H
#define DERIVE_RANK_H

#include <stdbool.h>

/* The rank of m[n * n], by rows, with entries known to within error[n * n] >= 0. Both are overwritten: a
 * regular matrix leaves its pivots, one in each row, and zeros.
 *
 * Rows and columns are first scaled by powers of two. With a positive diagonal and `symmetric`, the diagonal
 * becomes about one (van der Sluis, "Condition numbers and equilibration of matrices", 1969: no scaling of a
 * positive definite matrix does much better). Otherwise the largest entries become about one (Ruiz, 2001). So
 * the units of coordinates and the ratios of masses do not matter, only the independence of the directions. A
 * pivot counts as zero if it is within the error bound of its elimination. */
int rank_of(double *m, double *error, int n, bool symmetric);

/* Is a regular symmetric matrix positive definite? Destroys m. */
bool rank_is_positive(double *m, int n);

#endif

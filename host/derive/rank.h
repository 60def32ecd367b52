/* rank.h: is a matrix of numbers singular, whatever its units? */
#ifndef DERIVE_RANK_H
#define DERIVE_RANK_H

#include <stdbool.h>

/* The rank of m[n * n], by rows, whose entries are known to within error[n * n] >= 0. Both are destroyed: of a
 * regular matrix the pivots are left, one in each row, and zeros.
 *
 * Rows and columns are scaled first, by powers of two: with a positive diagonal and `symmetric`, to a
 * diagonal of about one (van der Sluis, "Condition numbers and equilibration of matrices", 1969: no scaling of
 * a positive definite matrix does much better), else to largest entries of about one (Ruiz, 2001). So the
 * units of coordinates and the ratios of masses do not decide; what is left is how much of a direction the
 * others already have. A pivot that is not above what the errors of the entries can make of nothing counts as
 * zero. */
int rank_of(double *m, double *error, int n, bool symmetric);

/* Is a regular symmetric matrix positive definite? Destroys m. */
bool rank_is_positive(double *m, int n);

#endif

/* lagrange.h: derivation of the equations of motion of an instance. */
#ifndef DERIVE_LAGRANGE_H
#define DERIVE_LAGRANGE_H

#include <stdbool.h>

#include "host/derive/equations.h"

/* === the rank of a matrix of numbers, independent of its units ================================ */

/* Returns the rank of m[n * n], stored row by row. error[n * n] >= 0 are the error bounds of m's entries. Overwrites m
 * and error. If the rank is n, each row of the overwritten m has one nonzero entry, the row's pivot.
 *
 * Rows and columns are scaled by powers of two, because the rank must not depend on units. If `symmetric` and the
 * diagonal is positive, the diagonal becomes about one (van der Sluis, "Condition numbers and equilibration of
 * matrices", 1969). Otherwise the largest entry of each row and column becomes about one (Ruiz, 2001). A pivot counts
 * as zero if it is round-off, or at most n times the largest scaled error. */
int rank_of(double *m, double *error, int n, bool symmetric);

/* Is a regular symmetric matrix positive definite? m is overwritten. */
bool rank_is_positive(double *m, int n);

/* Returns NULL after an error (reported): a coordinate without kinetic energy, a singular mass matrix, an equation that
 * is nonlinear in the highest derivative, or an expression above the limit of size. */
equations *equations_derive(const instance *inst, diags *errors);

#endif

/* null_space.h: the null space of many linear conditions: a triangular factor, and its singular values by one-sided Jacobi
 * rotations (Hestenes, "Inversion of matrices by biorthogonalization", 1958). */
#ifndef DERIVE_NULL_SPACE_H
#define DERIVE_NULL_SPACE_H

/* The triangular factor of all conditions taken. */
typedef struct conditions {
    int columns;
    double *r; /* [columns * columns] */
} conditions;

/* An entry of a tidy vector below this is rounding, and so is the rest of a vector that others span. */
#define NULL_SPACE_ROUNDING 1e-8

/* Free r. */
conditions conditions_none(int columns);
/* Takes a condition row . v = 0, scaled to length 1; the row is destroyed. */
void conditions_take(conditions *c, double *row);
/* All conditions of `more`, in the size that they have there: some of its rows are rounding. */
void conditions_add(conditions *c, const conditions *more);

double vector_length(const double *row, int columns);

/* The orthonormal vectors that meet all conditions, as rows of basis[columns * columns]; returns how many. Singular values below
 * `zero` times the largest count as zero. */
int null_space(const conditions *c, double zero, double *basis);

/* The same space by vectors that are easy to read: reduced echelon form, from the last columns on. */
void null_space_tidy(double *basis, int count, int columns);

#endif

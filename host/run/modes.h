/* modes.h: eigenvalues and eigenvectors of a real matrix that has no symmetry, small: the frequencies and time constants
 * of a linearised scene. */
#ifndef RUN_MODES_H
#define RUN_MODES_H

#include <stdbool.h>

typedef struct complex_number {
    double re, im;
} complex_number;

double complex_size(complex_number z);

/* value[n] of matrix[n * n], row by row, in no order. Balanced, brought to Hessenberg's form by elimination, then QR
 * steps with Wilkinson's shift in complex numbers (Golub & Van Loan, Matrix Computations, 4th ed., chapter 7). False:
 * none within the steps that any matrix takes, or entries that are no numbers. */
bool modes_values(int n, const double *matrix, complex_number *value);

/* Of the motion x' = A x at `slope[n]`, what the eigenvalue `value` contributes to it: part[n], complex: the projection
 * of the slope on its eigenvectors, by inverse iteration from the slope. share[n]: each component's participation factor,
 * |left_i right_i|, in sum one: whose motion it is, whatever the units. False where it cannot be told apart, and where the
 * slope has nothing of it to the bit: what stands still beside it, and takes no part. */
bool modes_part(int n, const double *matrix, complex_number value, const double *slope,
                complex_number *part, double *share);

#endif

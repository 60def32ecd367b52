/* modes.h: eigenvalues and eigenvectors of a real matrix that has no symmetry, small: the frequencies and time constants
 * of a linearised scene. */
#ifndef RUN_MODES_H
#define RUN_MODES_H

#include <stdbool.h>

typedef struct complex_number {
    double re, im;
} complex_number;

double complex_size(complex_number z);
complex_number complex_plus_times(complex_number a, complex_number b,
                                  complex_number c); /* a + b c */
complex_number complex_over(complex_number a, complex_number b);
complex_number complex_root(complex_number z); /* that with re >= 0 */

/* value[n] of matrix[n * n], row by row, in no order. Balanced, brought to Hessenberg's form by elimination, then QR
 * steps with Wilkinson's shift in complex numbers (Golub & Van Loan, Matrix Computations, 4th ed., chapter 7). False:
 * none within the steps that any matrix takes, or entries that are no numbers. */
bool modes_values(int n, const double *matrix, complex_number *value);

/* Of the motion x' = A x at `slope[n]`, what the eigenvalue `value` contributes to it: part[n], complex: the projection
 * of the slope on its eigenvectors, by inverse iteration from the slope. left[n]: of a state x the sum of left_i x_i is its part of
 * it, but for a factor. share[n]: each component's participation factor,
 * |left_i right_i|, in sum one: whose motion it is, whatever the units. False where it cannot be told apart, and where the
 * slope has nothing of it to the bit: what stands still beside it, and takes no part. */
bool modes_part(int n, const double *matrix, complex_number value, const double *slope,
                complex_number *part, complex_number *left, double *share);

#endif

/* matrix_make.h: the whole step of a linear scene as one constant matrix (core/step/matrix_step.h). */
#ifndef IMAGE_MATRIX_MAKE_H
#define IMAGE_MATRIX_MAKE_H

#include "host/derive/equations.h"
#include "host/image/image.h"
#include "host/image/image_parts.h"
#include "host/number/double_double.h"

/* === an affine right-hand side ================================================================ */

/* Number of columns of x' = A x + B u + c: states (angles first), inputs, and the constant. */
int affine_columns(const image *im);

/* Computes rates[states * columns] = A | B | c, row by row. Because rates[] is double-double, its only round-off is
 * that of the list's constants. Returns false without setting rates[] if the list is not affine. */
bool affine_rates(const image *im, double_double *rates);

/* Makes the matrix and its list. The rest of the image must be complete. Returns false, and reports the reason, if
 * a matrix cannot step the image. `e` locates a nonlinear term. `e` may be NULL if the image is affine. */
bool matrix_make(image_draft *d, const equations *e, diags *errors);

#endif

/* matrix_make.h: the whole step of a linear scene as one constant matrix (core/step/matrix_step.h). */
#ifndef DERIVE_MATRIX_MAKE_H
#define DERIVE_MATRIX_MAKE_H

#include "host/derive/image_parts.h"
#include "host/image/image.h"
#include "host/number/double_double.h"

/* === an affine right-hand side ================================================================ */

/* Number of columns of an affine right-hand side x' = A x + B u + c: states (angles first), inputs, and the
 * constant. */
int affine_columns(const image *im);

/* Computes rates[states * columns], the coefficients of the states' rates, row by row. Each operation of the list is
 * repeated on the coefficients of its operands, so the round-off is that of the list. Returns -1, or the first
 * operation that is not affine; then rates[] is unchanged. */
int affine_rates(const image *im, twofold *rates);

/* Makes the matrix and its list, as the image's settings require; the image must be otherwise complete. Returns false,
 * reported, if there is no such matrix: because of events, a ledger, another method, a nonlinear term, or numbers that
 * grow too large. `has_blame`: the image has its blame list, which locates the nonlinear term. Without that list a
 * nonlinear term is not reported; *wants_blame is set instead. */
bool matrix_make(image_draft *d, bool has_blame, bool *wants_blame, diags *errors);

#endif

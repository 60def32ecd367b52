/* matrix_make.h: the whole step of a linear scene as one constant matrix (core/step/matrix_step.h). */
#ifndef DERIVE_MATRIX_MAKE_H
#define DERIVE_MATRIX_MAKE_H

#include "host/derive/image_parts.h"

/* Make the matrix and its list, as the image's settings require; the image must be otherwise complete. Returns false,
 * reported, if there is no such matrix: events, a ledger, another method, a nonlinear term, or numbers that grow too
 * large. `has_blame`: the image has its blame list, which locates the nonlinear term. Without it that error is not
 * reported: *wants_blame is set instead. */
bool matrix_make(image_draft *d, bool has_blame, bool *wants_blame, diags *errors);

#endif

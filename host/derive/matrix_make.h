/* matrix_make.h: a whole step as one constant matrix (core/matrix_step.h), where a scene is linear. */
#ifndef DERIVE_MATRIX_MAKE_H
#define DERIVE_MATRIX_MAKE_H

#include "host/derive/image_parts.h"

/* Makes the matrix and its list that the image's settings ask for; of an image that is complete but for them. Returns true;
 * or false, reported, where there is none: events, books, another method, what is not linear, numbers that grow too large.
 * `has_blame`: the image has its blame list, which tells the place of what is not linear; else that is not reported but
 * *wants_blame set. */
bool matrix_make(image_draft *d, bool has_blame, bool *wants_blame, diags *errors);

#endif

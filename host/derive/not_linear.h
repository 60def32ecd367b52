/* not_linear.h: the report of the nonlinear term of a mechanism, with its place. */
#ifndef DERIVE_NOT_LINEAR_H
#define DERIVE_NOT_LINEAR_H

#include "host/image/image.h"

/* Report it for an image with a blame list. `operation` of the step's list is not linear (host/derive/affine.h). */
void not_linear_report(const image *im, int operation, diags *errors);

#endif

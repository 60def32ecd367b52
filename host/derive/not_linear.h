/* not_linear.h: saying what makes a mechanism not linear, and where that stands. */
#ifndef DERIVE_NOT_LINEAR_H
#define DERIVE_NOT_LINEAR_H

#include "host/image/image.h"

/* Reports it of an image that has its blame list; `operation` of the step's list is not linear (host/derive/affine.h). */
void not_linear_report(const image *im, int operation, diags *errors);

#endif

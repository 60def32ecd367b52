/* diagnostic_expressions.h: expressions of image_diagnostics (host/image/image.h). */
#ifndef IMAGE_DIAGNOSTIC_EXPRESSIONS_H
#define IMAGE_DIAGNOSTIC_EXPRESSIONS_H

#include "host/derive/equations.h"
#include "image_parts.h"

/* Makes the diagnostics of the image d->made. Its inputs and contacts must already exist. */
void diagnostics_make(image_draft *d, const equations *e);

#endif

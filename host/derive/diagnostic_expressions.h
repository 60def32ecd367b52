/* diagnostic_expressions.h: the expressions that may be undefined, for messages (image_diagnostics in host/image/image.h). */
#ifndef DERIVE_DIAGNOSTIC_EXPRESSIONS_H
#define DERIVE_DIAGNOSTIC_EXPRESSIONS_H

#include "host/derive/equations.h"
#include "image_parts.h"

/* Enters the expressions and the contacts' conditions into the image. Its inputs and contacts must already exist. */
void diagnostics_make(image_draft *d, const equations *e);

#endif

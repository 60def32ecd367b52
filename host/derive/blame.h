/* blame.h: the expressions that may be undefined, for messages (image_blame in host/image/image.h). */
#ifndef DERIVE_BLAME_H
#define DERIVE_BLAME_H

#include "host/derive/equations.h"
#include "image_parts.h"

/* Enter them, with the conditions of each contact. The image must have its inputs and contacts. */
void blame_make(image_draft *d, const equations *e);

#endif

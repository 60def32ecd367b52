/* blame.h: the expressions that may have no value, for messages (image_blame in host/image/image.h). */
#ifndef DERIVE_BLAME_H
#define DERIVE_BLAME_H

#include "host/derive/equations.h"
#include "image_parts.h"

/* Enter them, with the questions of each contact. The image has its inputs and contacts. */
void blame_make(image_draft *d, const equations *e);

#endif

/* image_once.h: one image, whose numbers are folded in the way that holds (host/number/folding.h). For image_make() only, which
 * asks for more of them. */
#ifndef DERIVE_IMAGE_ONCE_H
#define DERIVE_IMAGE_ONCE_H

#include "image_make.h"

/* As image_make(), but for what other ways of folding make of it. */
image *image_once(const equations *e, const bool *conserve, const image_settings *settings,
                  image_use use, diags *errors);

#endif

/* image_make.h: the end of every derivation: the image (host/image/image.h). */
#ifndef DERIVE_IMAGE_MAKE_H
#define DERIVE_IMAGE_MAKE_H

#include "image_once.h"

/* The image of an instance whose equations are `e`; `conserve` [count] names the coordinates to recover from their
 * momentum, or is NULL. Nothing in it points to `e`, to the instance or to the model: all may be freed. NULL on error,
 * reported (see program_make()). */
image *image_make(const equations *e, const bool *conserve, const image_settings *settings,
                  image_use use, diags *errors);

#endif

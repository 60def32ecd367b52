/* image_make.h: construction of the image (host/image/image.h) of an instance from its equations. */
#ifndef IMAGE_IMAGE_MAKE_H
#define IMAGE_IMAGE_MAKE_H

#include "host/derive/equations.h"
#include "host/image/image.h"

/* IMAGE_TO_RUN and IMAGE_TO_CHECK make image.diagnostics, which messages about undefined expressions need.
 * IMAGE_TO_CHECK also makes image.finer, the image of the finer run. */
typedef enum image_use { IMAGE_TO_WRITE, IMAGE_TO_RUN, IMAGE_TO_CHECK } image_use;

/* Returns an image with the lists of `base`. Starts, inputs, step and end are those of `inst`, which must have the same
 * mechanism, scene and parameters as `base`. If the step differs, the matrix (if any) is made again. Returns NULL
 * (reported) if that fails. Free `base` last. */
image *image_again(const image *base, const instance *inst, diags *errors);

/* Returns the image of e->instance, with its variants, or NULL after an error (reported). If conserve[i] is true,
 * coordinate i is recovered from its momentum. `conserve` may be NULL. The image has no pointers to `e`, the instance
 * or the model. */
image *image_make(const equations *e, const bool *conserve, const image_settings *settings,
                  image_use use, diags *errors);

#endif

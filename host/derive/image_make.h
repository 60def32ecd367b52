/* image_make.h: construction of the image (host/image/image.h) of an instance from its equations. */
#ifndef DERIVE_IMAGE_MAKE_H
#define DERIVE_IMAGE_MAKE_H

#include "host/derive/equations.h"
#include "host/image/image.h"

/* Images to run and to check have image.diagnostics, so that messages can point at an undefined expression. An image to
 * check also has the image of its finer run (image.finer). */
typedef enum image_use { IMAGE_TO_WRITE, IMAGE_TO_RUN, IMAGE_TO_CHECK } image_use;

/* Returns an image with the lists of `base`, and the starts, inputs, step and end of `inst`, an instance of the same
 * mechanism and scene with the same parameters. If the step differs, makes another matrix, or returns NULL (reported).
 * Free `base` last. */
image *image_again(const image *base, const instance *inst, diags *errors);

/* Returns the image of an instance with the equations `e`, and its variants; NULL after an error (reported, see
 * program_make()). `conserve` [count] selects the coordinates to recover from their momentum, or is NULL. The image has
 * no pointers to `e`, the instance or the model. */
image *image_make(const equations *e, const bool *conserve, const image_settings *settings,
                  image_use use, diags *errors);

#endif

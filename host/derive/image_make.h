/* image_make.h: the last stage of every derivation: the image (host/image/image.h). */
#ifndef DERIVE_IMAGE_MAKE_H
#define DERIVE_IMAGE_MAKE_H

#include "host/derive/equations.h"
#include "host/image/image.h"

/* === one image ================================================================================ */
/* One image, with its numbers folded in the current way (host/number/folding.h). image_make() makes variants, too. */

/* The purpose of an image. One to run also has the expressions that may be undefined, in the spelling of the file, so
 * that a message can quote the failed one (host/check/nonfinite.h). */
typedef enum image_use { IMAGE_TO_WRITE, IMAGE_TO_RUN } image_use;

/* The same lists with the starts, inputs, step and end of `inst`. It must be an instance of the same mechanism and
 * scene with the same parameters. Another step gets a matrix of its own. Free `base` last. NULL, reported, if there is
 * no such matrix. */
image *image_again(const image *base, const instance *inst, diags *errors);

/* The image of an instance with the equations `e`. `conserve` [count] names the coordinates to recover from their
 * momentum, or is NULL. The image has no pointers to `e`, the instance or the model: all may be freed. NULL after an
 * error, reported (see program_make()). */
image *image_make(const equations *e, const bool *conserve, const image_settings *settings,
                  image_use use, diags *errors);

#endif

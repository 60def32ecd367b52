/* image_make.h: the end of every derivation: the image (host/image/image.h). */
#ifndef DERIVE_IMAGE_MAKE_H
#define DERIVE_IMAGE_MAKE_H

#include "host/derive/equations.h"
#include "host/image/image.h"

/* === image_once =============================================================================== */
/* One image, whose numbers are folded in the way that holds (host/number/folding.h); image_make() asks for more of
 * them. */

/* What it is for. One that is to run also has the expressions that may have no value, as they were written, so that
 * a message can tell which one it was (host/run/undefined.h). */
typedef enum image_use { IMAGE_TO_WRITE, IMAGE_TO_RUN } image_use;

/* As image_make(), but for what other ways of folding make of it. */
image *image_once(const equations *e, const bool *conserve, const image_settings *settings,
                  image_use use, diags *errors);

/* The same lists from other starts, inputs, step and end: those of `inst`, an instance of the same mechanism and
 * scene with the same parameters; of another step, a matrix of its own. `base` must not be freed before it. NULL, reported,
 * where there is no such matrix. */
image *image_again(const image *base, const instance *inst, diags *errors);

/* The image of an instance whose equations are `e`; `conserve` [count] names the coordinates to recover from their
 * momentum, or is NULL. Nothing in it points to `e`, to the instance or to the model: all may be freed. NULL on error,
 * reported (see program_make()). */
image *image_make(const equations *e, const bool *conserve, const image_settings *settings,
                  image_use use, diags *errors);

#endif

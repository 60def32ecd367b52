/* image_once.h: one image, whose numbers are folded in the way that holds (host/number/folding.h); image_make() asks for more of
 * them. */
#ifndef DERIVE_IMAGE_ONCE_H
#define DERIVE_IMAGE_ONCE_H

#include "equations.h"
#include "host/image/image.h"

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

#endif

/* constant_sensitivity.h: sensitivity of a scene's accelerations to the folding of its constants to double. Compares the scene's
 * lists with those that fold constants in other ways (host/number/folding.h). Most scenes have no such lists. */
#ifndef CHECK_CONSTANT_SENSITIVITY_H
#define CHECK_CONSTANT_SENSITIVITY_H

#include "host/image/image.h"

/* The image of the way with the largest difference near the scene's start; NULL if there is no other way. */
const image *constant_sensitivity_furthest(const image *im);

#endif

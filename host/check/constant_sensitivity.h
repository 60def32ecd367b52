/* constant_sensitivity.h: what folding a scene's constants to double makes of its accelerations: the scene's own lists beside those whose
 * constants were folded in other ways (host/number/folding.h). Of most scenes there are none. */
#ifndef CHECK_CONSTANT_SENSITIVITY_H
#define CHECK_CONSTANT_SENSITIVITY_H

#include "host/image/image.h"

/* The image of the way that leads furthest from the scene's own, about where it starts; NULL where there is none. */
const image *constant_sensitivity_furthest(const image *im);

#endif

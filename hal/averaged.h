/* averaged.h: corrects samples that are means over time, for drivers that average a changing force. */
#ifndef HAL_AVERAGED_H
#define HAL_AVERAGED_H

#include <stdint.h>

#include "core/linkage.h"

WH_C_BEGIN

/* Estimates the force F at the centre of an interval of length T. `mean` is the mean of F over that interval, `before`
 * and `behind` are the means over its neighbours, all below 2^28 in magnitude. `mean` exceeds F by about T^2/24 F'',
 * which is subtracted. The correction increases the noise by 9 %. */
static inline int32_t hal_averaged_middle(int32_t before, int32_t mean, int32_t behind) {
    const int32_t bends = before - 2 * mean + behind;
    return mean - (bends + (bends < 0 ? -12 : 12)) / 24;
}

WH_C_END

#endif

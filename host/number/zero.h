/* zero.h: zeros for readers. */
#ifndef NUMBER_ZERO_H
#define NUMBER_ZERO_H

#include <math.h>

/* The value for printing: zeros and NaNs have no sign, since "-0" says no more than "0". States and their
 * hashes keep their signs, because only printed values go through here. */
static inline double number_shown(double value) {
    return isnan(value) ? (double)NAN : value + 0.0; /* -0 + 0 is 0, by IEEE 754 */
}

#endif

/* zero.h: zeros for readers. */
#ifndef NUMBER_ZERO_H
#define NUMBER_ZERO_H

#include <math.h>

/* The value as everything that prints it shall have it: a zero has no sign, since "-0" says nothing that "0"
 * does not, and neither has what is no number. States and their hashes keep theirs: only what is printed goes
 * through here. */
static inline double number_shown(double value) {
    return isnan(value) ? (double)NAN : value + 0.0; /* -0 + 0 is 0, by IEEE 754 */
}

#endif

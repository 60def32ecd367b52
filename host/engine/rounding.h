/* rounding.h: how far off a list's results may be for the rounding of its own operations. */
#ifndef ENGINE_ROUNDING_H
#define ENGINE_ROUNDING_H

#include "host/image/op_list.h"

/* A list as it was just evaluated in double. Sine and cosine are those of the phases. */
typedef struct rounding_values {
    const double *value;     /* [t->count] */
    const double *sine;      /* [t->count] */
    const double *cosine;    /* [t->count] */
    const double *phase_rad; /* [t->angles] */
    const double *angle_rad; /* [t->angles] */
    double
        least; /* results below this size are rounded as one of it: float's smallest normal one, and beyond its largest infinite; 0: none are */
} rounding_values;

/* error[t->results], in units of the numbers' rounding (2^-53 in double, 2^-24 in float): what all roundings can
 * come to, if they are so small that their products do not count. A running error analysis (Higham, Accuracy and
 * Stability of Numerical Algorithms, 2nd ed., section 3.3): each operation's result is rounded once, what
 * its operands are off goes on into it by its slopes, and so a small difference of large terms is known to
 * be off by parts of these. The state itself counts as exact. Infinite or NaN where an operation has no slope. */
void rounding_of(const op_list *t, const rounding_values *at, double *error);

#endif

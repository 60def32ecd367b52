/* rounding.h: bounds on the round-off of a list's results by its own operations. */
#ifndef ENGINE_ROUNDING_H
#define ENGINE_ROUNDING_H

#include "host/image/op_list.h"

/* A list as it was just evaluated in double. `sine` and `cosine` are those of its phases. */
typedef struct rounding_values {
    const double *value;     /* [t->count] */
    const double *sine;      /* [t->count] */
    const double *cosine;    /* [t->count] */
    const double *phase_rad; /* [t->angles] */
    const double *angle_rad; /* [t->angles] */
    double least;            /* float's smallest normal number; 0: ignore underflow and overflow */
} rounding_values;

/* Computes bounds on the round-off of the results: error[t->results], in units of the unit round-off (2^-53 in double,
 * 2^-24 in float). Products of errors are neglected.
 *
 * This is a running error analysis (Higham, Accuracy and Stability of Numerical Algorithms, 2nd ed., section 3.3).
 * An operation multiplies its operands' errors by its partial derivatives, and adds its own round-off. The state is
 * assumed to be exact. The bound is infinite or NaN if a derivative is not finite. */
void rounding_of(const op_list *t, const rounding_values *at, double *error);

#endif

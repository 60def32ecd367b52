/* double_double.h: numbers of some 106 bits: the unevaluated sum of two doubles (Dekker; Muller et al., Handbook of
 * Floating-Point Arithmetic, chapter 14). For constants that are to be right to the last bit of a double though many
 * operations lead to them. Nothing but IEEE additions, products and divisions: the same bits on every host. */
#ifndef NUMBER_DOUBLE_DOUBLE_H
#define NUMBER_DOUBLE_DOUBLE_H

#include <stdbool.h>
#include <stdint.h>

#include "core/function_double.h"

/* high is the double nearest to the whole, low what is left of it. */
typedef wh_pair twofold;

twofold double_double_of(double value);
twofold double_double_ratio(uint64_t numerator, uint64_t denominator);

/* Relative error a few times 2^-104; no subnormals, no infinities, sizes below 2^990 or so: else the result is not
 * finite or has a double's digits. */
twofold double_double_add(twofold a, twofold b);
twofold double_double_sub(twofold a, twofold b);
twofold double_double_mul(twofold a, twofold b);
twofold double_double_div(twofold a, twofold b);
twofold double_double_neg(twofold a);
/* a times a power of two, exactly. */
twofold double_double_scale(twofold a, double power_of_two);

bool double_double_is_zero(twofold a);
bool double_double_is_finite(twofold a);

/* The double that a scene's constants are made of: the nearest one to `a`. Only where that stands in the middle between
 * two floats, and `a` does not, it is the next double on the side of `a`: then (float) of it is the float nearest to `a`,
 * as if `a` had been rounded once. */
double double_double_constant(twofold a);

/* What is left of `a` when the float nearest to it has been taken away, as a double. */
double double_double_beyond_float(twofold a);

#endif

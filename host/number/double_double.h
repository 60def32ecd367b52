/* double_double.h: numbers of some 106 bits, the unevaluated sum of two doubles (Dekker; Muller et al., Handbook of
 * Floating-Point Arithmetic, chapter 14). A constant is correct to the last bit of a double even after many operations.
 * Only IEEE additions, products and divisions are used, so results have the same bits on every host. */
#ifndef NUMBER_DOUBLE_DOUBLE_H
#define NUMBER_DOUBLE_DOUBLE_H

#include <stdbool.h>
#include <stdint.h>

#include "core/function_double.h"

/* `high` is the double nearest to the sum, `low` the remainder. */
typedef wh_pair twofold;

twofold double_double_of(double value);
twofold double_double_ratio(uint64_t numerator, uint64_t denominator);

/* Sum, difference, product and quotient have a relative error of a few times 2^-104 for normal numbers below about
 * 2^990. For larger numbers the result is not finite; for subnormal ones it has only the digits of a double. */
twofold double_double_add(twofold a, twofold b);
twofold double_double_sub(twofold a, twofold b);
twofold double_double_mul(twofold a, twofold b);
twofold double_double_div(twofold a, twofold b);
/* `a` times a power of two, exactly. */
twofold double_double_scale(twofold a, double power_of_two);

bool double_double_is_zero(twofold a);
bool double_double_is_finite(twofold a);

/* Returns the double nearest to `a`. If that double is the midpoint of two floats, and `a` is not, returns the next
 * double on the side of `a`. So (float) of the result is the float nearest to `a`, as after a single rounding. */
double double_double_constant(twofold a);

/* `a` minus the float nearest to `a`, as a double. */
double double_double_beyond_float(twofold a);

#endif

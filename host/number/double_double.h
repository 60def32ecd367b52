/* double_double.h: numbers of some 106 bits, the unevaluated sum of two doubles (Dekker; Muller et al., Handbook of
 * Floating-Point Arithmetic, chapter 14). A constant is correct to the last bit of a double even after many operations.
 * Only IEEE additions, products and divisions are used, so results have the same bits on every host. */
#ifndef NUMBER_DOUBLE_DOUBLE_H
#define NUMBER_DOUBLE_DOUBLE_H

#include <stdbool.h>
#include <stdint.h>

#include "core/function_double.h"

/* The number is high + low. `high` is the double nearest to the number. */
typedef wh_pair double_double;

double_double double_double_of(double value);
double_double double_double_ratio(uint64_t numerator, uint64_t denominator);

/* Sum, difference, product and quotient have a relative error of a few times 2^-104 for normal numbers below about
 * 2^990. For larger numbers the result is not finite; for subnormal ones it has only the digits of a double. */
double_double double_double_add(double_double a, double_double b);
double_double double_double_sub(double_double a, double_double b);
double_double double_double_mul(double_double a, double_double b);
double_double double_double_div(double_double a, double_double b);
/* `a` times a power of two, exactly. */
double_double double_double_scale(double_double a, double power_of_two);

bool double_double_is_zero(double_double a);
bool double_double_is_finite(double_double a);

/* Returns the double nearest to `a`. If that double is the midpoint of two floats, and `a` is not, returns the next
 * double on the side of `a`. So (float) of the result is the float nearest to `a`, as after a single rounding. */
double double_double_constant(double_double a);

/* `a` minus the float nearest to `a`, as a double. */
double double_double_beyond_float(double_double a);

#endif

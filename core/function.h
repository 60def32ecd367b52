/* function.h: the language's functions other than sine, cosine and square root, in the core's own arithmetic.
 *
 * Every operation is an IEEE 754 addition, multiplication, division, root or conversion of wh_real, or an integer
 * operation. So the bits are the same on every machine, and no library is needed. The float build computes in float alone.
 *
 * Special cases as in C's Annex F: infinities, NaN, signed zeros and subnormals included. */
#ifndef WH_FUNCTION_H
#define WH_FUNCTION_H

#include "real.h"

#ifdef __cplusplus
extern "C" {
#endif

#define wh_exp WH_NAME(wh_exp)
#define wh_log WH_NAME(wh_log)
#define wh_tan WH_NAME(wh_tan)
#define wh_asin WH_NAME(wh_asin)
#define wh_acos WH_NAME(wh_acos)
#define wh_atan WH_NAME(wh_atan)
#define wh_atan2 WH_NAME(wh_atan2)
#define wh_pow WH_NAME(wh_pow)
#define wh_sinh WH_NAME(wh_sinh)
#define wh_cosh WH_NAME(wh_cosh)
#define wh_tanh WH_NAME(wh_tanh)

/* X-macro of all functions: ONE(name) of one argument, TWO(name) of two. */
#define WH_FUNCTIONS(ONE, TWO) \
    ONE(exp) \
    ONE(log) \
    ONE(tan) ONE(asin) ONE(acos) ONE(atan) TWO(atan2) TWO(pow) ONE(sinh) ONE(cosh) ONE(tanh)

/* e^x, the natural logarithm, the inverse trigonometric functions in radians, and the hyperbolic sine, cosine and
 * tangent. The error is within one unit in the last place. */
wh_real wh_exp(wh_real x);
wh_real wh_log(wh_real x);
wh_real wh_asin(wh_real x);
wh_real wh_acos(wh_real x);
wh_real wh_atan(wh_real x);
wh_real wh_sinh(wh_real x);
wh_real wh_cosh(wh_real x);
wh_real wh_tanh(wh_real x);

/* tan(rad), for angles of any size. The error is within two units in the last place in float, one in double. */
wh_real wh_tan(wh_real rad);
/* The angle of the point (x, y), from -pi to pi. */
wh_real wh_atan2(wh_real y, wh_real x);
/* base^exponent; exact if the result is a wh_real. */
wh_real wh_pow(wh_real base, wh_real exponent);

#ifdef __cplusplus
}
#endif

#endif

/* function.h: the language's functions other than sine, cosine and square root, computed without a library.
 *
 * Every operation is an integer operation, or an IEEE 754 addition, multiplication, division, root or conversion of
 * wh_real, so the result has the same bits on every machine. The float build uses no double.
 *
 * Special cases (infinities, NaN, signed zeros, subnormals) follow Annex F of the C standard. */
#ifndef WH_FUNCTION_H
#define WH_FUNCTION_H

#include "real.h"

WH_C_BEGIN

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

/* X-macro of all functions: ONE(name) if the function has one argument, TWO(name) if it has two. */
#define WH_FUNCTIONS(ONE, TWO) \
    ONE(exp) \
    ONE(log) \
    ONE(tan) ONE(asin) ONE(acos) ONE(atan) TWO(atan2) TWO(pow) ONE(sinh) ONE(cosh) ONE(tanh)

/* For these functions the error is within one unit in the last place. Angles are in radians. */
wh_real wh_exp(wh_real x);
wh_real wh_log(wh_real x);
wh_real wh_asin(wh_real x);
wh_real wh_acos(wh_real x);
wh_real wh_atan(wh_real x);
wh_real wh_sinh(wh_real x);
wh_real wh_cosh(wh_real x);
wh_real wh_tanh(wh_real x);

/* For any angle, the error is within two units in the last place in float, one in double. */
wh_real wh_tan(wh_real rad);
/* The angle of the point (x, y), from -pi to pi rad. */
wh_real wh_atan2(wh_real y, wh_real x);
/* base^exponent. If wh_real can represent the true result, it is returned exactly. */
wh_real wh_pow(wh_real base, wh_real exponent);

WH_C_END

#endif

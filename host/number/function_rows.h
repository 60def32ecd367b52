/* function_rows.h: the language's functions, a row each. All lists of functions are made of these rows, or
 * switch over function_id with -Wswitch-enum. A new function is a new row, at the end. If a part of it is
 * missing, the build fails.
 *
 * X(id, word, arguments, dimensions, range, latex, value, slope by x, slope by y)
 *
 *   id           FN_id of functions.h. The order enters the hashes of models and the order of expressions.
 *   word         its name in the language and in text, in Octave, and after wh_ in C
 *   arguments    1: x, 2: x and y, in the order in which they are written
 *   dimensions   TAKES_... of functions.h: dimensions of the arguments and the result
 *   range        EVERYWHERE: real for all real numbers. SOMEWHERE: NaN elsewhere, where Octave's result is complex.
 *   latex        the text before the parenthesis
 *   value        FUNCTION_CORE(...): a function of core/function.h, in both numbers, on every board.
 *                FUNCTION_OWN(operation, ...): its own operation in the operation list, and its value in double.
 *                The users of this column define the two macros.
 *   slopes       in double. In symbols: host/algebra/calculus.c, which has a function for each row */
#ifndef NUMBER_FUNCTION_ROWS_H
#define NUMBER_FUNCTION_ROWS_H

/* clang-format off */
#define FUNCTION_ROWS(X) \
    X(SIN,   sin,   1, ANGLE,   EVERYWHERE, "\\sin", \
      FUNCTION_OWN(SIN, wh_sine(x)), wh_cosine(x), 0.0) \
    X(COS,   cos,   1, ANGLE,   EVERYWHERE, "\\cos", \
      FUNCTION_OWN(COS, wh_cosine(x)), -wh_sine(x), 0.0) \
    X(TAN,   tan,   1, ANGLE,   EVERYWHERE, "\\tan", \
      FUNCTION_CORE(wh_tan(x)), 1.0 + wh_tan(x) * wh_tan(x), 0.0) \
    X(ASIN,  asin,  1, NUMBER,  SOMEWHERE,  "\\operatorname{asin}", \
      FUNCTION_CORE(wh_asin(x)), 1.0 / number_root(1.0 - x * x), 0.0) \
    X(ACOS,  acos,  1, NUMBER,  SOMEWHERE,  "\\operatorname{acos}", \
      FUNCTION_CORE(wh_acos(x)), -1.0 / number_root(1.0 - x * x), 0.0) \
    X(ATAN,  atan,  1, NUMBER,  EVERYWHERE, "\\operatorname{atan}", \
      FUNCTION_CORE(wh_atan(x)), 1.0 / (1.0 + x * x), 0.0) \
    X(ATAN2, atan2, 2, RATIO,   EVERYWHERE, "\\operatorname{atan2}", \
      FUNCTION_CORE(wh_atan2(x, y)), y / (x * x + y * y), -x / (x * x + y * y)) \
    X(SQRT,  sqrt,  1, SQUARE,  SOMEWHERE,  "\\operatorname{sqrt}", \
      FUNCTION_OWN(SQRT, number_root(x)), 0.5 / number_root(x), 0.0) \
    X(EXP,   exp,   1, NUMBER,  EVERYWHERE, "\\exp", \
      FUNCTION_CORE(wh_exp(x)), wh_exp(x), 0.0) \
    X(LOG,   log,   1, NUMBER,  SOMEWHERE,  "\\operatorname{log}", \
      FUNCTION_CORE(wh_log(x)), 1.0 / x, 0.0) \
    X(ABS,   abs,   1, SIZE,    EVERYWHERE, "\\operatorname{abs}", \
      FUNCTION_OWN(ABS, WH_ABS(x)), sign_of(x), 0.0) \
    X(SIGN,  sign,  1, ANY,     EVERYWHERE, "\\operatorname{sign}", \
      FUNCTION_OWN(SIGN, sign_of(x)), 0.0, 0.0) \
    X(MIN,   min,   2, CHOICE,  EVERYWHERE, "\\min", \
      FUNCTION_OWN(MIN, y < x || wh_is_nan(y) ? y : x), share_of(y - x), share_of(x - y)) \
    X(MAX,   max,   2, CHOICE,  EVERYWHERE, "\\max", \
      FUNCTION_OWN(MAX, y > x || wh_is_nan(y) ? y : x), share_of(x - y), share_of(y - x)) \
    X(SINH,  sinh,  1, NUMBER,  EVERYWHERE, "\\sinh", \
      FUNCTION_CORE(wh_sinh(x)), wh_cosh(x), 0.0) \
    X(COSH,  cosh,  1, NUMBER,  EVERYWHERE, "\\cosh", \
      FUNCTION_CORE(wh_cosh(x)), wh_sinh(x), 0.0) \
    X(TANH,  tanh,  1, NUMBER,  EVERYWHERE, "\\tanh", \
      FUNCTION_CORE(wh_tanh(x)), 1.0 / (wh_cosh(x) * wh_cosh(x)), 0.0)
/* clang-format on */

#endif

/* functions.h: functions of the language, rounding and remainders. The file depends only on the core.
 *
 * The machine's library is not used, so results have the same bits on every host. The functions of core/function.h,
 * such as sines, logarithms and powers, err by less than 0.6 ulp over the whole range. The root is correctly rounded.
 * Whole parts, remainders, minima and maxima are exact. Special cases are as in C's Annex F. */
#ifndef NUMBER_FUNCTIONS_H
#define NUMBER_FUNCTIONS_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* === rows of functions ================================================================== */
/* The language's functions. Code that lists them uses these rows, or switches over function_id with -Wswitch-enum. So
 * the build fails if a new function lacks code. Add a row at the end: the order affects expressions and models' hashes.
 *
 * X(id, word, arguments, dimensions, range, latex, value, slope by x, slope by y)
 *
 *   id           its constant is FN_id
 *   word         its name in the language, in text and in Octave; its name in C is wh_word
 *   arguments    1: x, 2: x and y, in the order in which they are written
 *   dimensions   the name after TAKES_: dimensions of the arguments and the result
 *   range        EVERYWHERE: real for all real arguments. SOMEWHERE: for some, the result is NaN (Octave: complex).
 *   latex        the text before the parenthesis
 *   value        FUNCTION_CORE(...): a function of core/function.h, in float and double, on every board.
 *                FUNCTION_OWN(operation, ...): its own operation in the operation list, and its value in double.
 *                The code that uses this column defines the two macros.
 *   slopes       in double. Symbolic slopes: function_slope() in host/algebra/calculus.c, with a case for each row */

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

/* === printed zeros ============================================================================ */

/* Removes the sign of zeros and NaNs. Only printed values go through here: states and their hashes keep their signs. */
static inline double number_shown(double value) {
    return isnan(value) ? (double)NAN : value + 0.0; /* -0 + 0 is 0, by IEEE 754 */
}

#define FUNCTION_ID(id, ...) FN_##id,
typedef enum function_id { FUNCTION_ROWS(FUNCTION_ID) } function_id;
#undef FUNCTION_ID

#define FUNCTION_ONE(...) +1
enum { FUNCTIONS = 0 FUNCTION_ROWS(FUNCTION_ONE) }; /* number of functions */
#undef FUNCTION_ONE

#define FUNCTION_NONE ((function_id)FUNCTIONS) /* no function */

/* The dimensions of the arguments, and the dimension of the result. */
typedef enum function_dimensions {
    TAKES_ANGLE,  /* an angle in radians -> a number */
    TAKES_NUMBER, /* a number -> a number */
    TAKES_SQUARE, /* any dimension -> its square root */
    TAKES_SIZE,   /* any dimension -> the same dimension */
    TAKES_ANY,    /* any dimension -> a number */
    TAKES_RATIO,  /* two arguments of one dimension -> a number */
    TAKES_CHOICE  /* two arguments of one dimension -> the same dimension */
} function_dimensions;

/* The function's name in the language, in text and in Octave; its name in C is wh_NAME. */
const char *function_name(function_id function);
const char *function_latex(function_id function); /* such as "\\sin" */
int function_arguments(function_id function);     /* 1 or 2 */
function_dimensions function_takes(function_id function);
bool function_is_real(function_id function); /* false if the result is NaN for some arguments */
/* Sets *function to the function with that name. Returns false if there is none. */
bool function_find(const char *text, size_t length, function_id *function);

/* The function at x, or at (x, y). With a NaN argument the result is NaN, also for min() and max(). */
double number_call(function_id function, double x, double y);
/* The partial derivative by x (which = 0) or y (which = 1). If the arguments of min() or max() are equal, it is 1/2. */
double number_slope(function_id function, int which, double x, double y);

double number_sine(double rad);
double number_cosine(double rad);
double number_root(double x);
double number_power(double base, double exponent);

/* Rounding to a whole number: down, up, to nearest with ties away from zero, and to nearest with ties to even. */
double number_floor(double x);
double number_ceiling(double x);
double number_nearest(double x);
double number_even(double x);

/* number_remainder() subtracts whole multiples of y from x; the result has the sign of x and is smaller than y in
 * size. number_centred() subtracts the multiple nearest to x; the result lies within y/2 of zero. */
double number_remainder(double x, double y);
double number_centred(double x, double y);

/* number_scaled() returns x times 2^exponent. number_split() returns the mantissa y and *exponent: x = y 2^*exponent
 * and 0.5 <= |y| < 1. Both return zeros, infinities and NaN unchanged. */
double number_scaled(double x, int exponent);
double number_split(double x, int *exponent);

static inline uint64_t number_bits(double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

/* The smaller and the larger number. If one is NaN, the result is the other. If both are zero, the result is `a`. */
double number_least(double a, double b);
double number_most(double a, double b);

#endif

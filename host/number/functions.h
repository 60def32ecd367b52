/* functions.h: the program's own numerics: the language's functions (function_rows.h) and a few others. It
 * depends only on the core, and all of the host may use it.
 *
 * The machine's library is not used, so results have the same bits on every host. Sine, cosine, tangent,
 * logarithm and the like err by less than 0.6 units of the last place over the whole range (core/function.h).
 * The root is correctly rounded; all others here are exact. Special cases are as in C's Annex F. */
#ifndef NUMBER_FUNCTIONS_H
#define NUMBER_FUNCTIONS_H

#include <stdbool.h>
#include <stddef.h>

#include "function_rows.h"

/* The language's functions: FN_SIN, FN_COS, ... */
#define FUNCTION_ID(id, ...) FN_##id,
typedef enum function_id { FUNCTION_ROWS(FUNCTION_ID) } function_id;
#undef FUNCTION_ID

#define FUNCTION_ONE(...) +1
enum { FUNCTIONS = 0 FUNCTION_ROWS(FUNCTION_ONE) }; /* how many there are, from FN_SIN on */
#undef FUNCTION_ONE

#define FUNCTION_NONE ((function_id)FUNCTIONS) /* no function */

typedef enum function_dimensions {
    TAKES_ANGLE,  /* a number that is an angle in radians: a number */
    TAKES_NUMBER, /* a number: a number */
    TAKES_SQUARE, /* any: its root */
    TAKES_SIZE,   /* any: the same */
    TAKES_ANY,    /* any: a number */
    TAKES_RATIO,  /* two of one dimension: a number */
    TAKES_CHOICE  /* two of one dimension: the same */
} function_dimensions;

const char *
function_name(function_id function); /* in the language, in text, in Octave; wh_... in C */
const char *function_latex(function_id function); /* "\\sin" */
int function_arguments(function_id function);     /* 1 or 2 */
function_dimensions function_takes(function_id function);
bool function_is_real(function_id function); /* real for all real arguments */
/* The function with that name, in *function; false: unknown. */
bool function_find(const char *text, size_t length, function_id *function);

/* The function at x, or at (x, y). NaN goes through, by min() and max(), too. */
double number_call(function_id function, double x, double y);
/* Its slope by x (which = 0) or y (1) there. min() and max() of two that are equal: one half of each. */
double number_slope(function_id function, int which, double x, double y);

double number_sine(double rad);
double number_cosine(double rad);
double number_root(double x);
double number_power(double base, double exponent);

/* Whole numbers: the next below and above, the nearest with halves away from zero, and with halves to even. */
double number_floor(double x);
double number_ceiling(double x);
double number_nearest(double x);
double number_even(double x);

/* The remainder of x after whole multiples of y: with the sign of x, and within y/2. */
double number_remainder(double x, double y);
double number_centred(double x, double y);

/* x 2^exponent; and x as a number of 0.5 to below 1 times 2^*exponent, with zeros, infinities and NaN unchanged. */
double number_scaled(double x, int exponent);
double number_split(double x, int *exponent);

/* The lesser and the larger of two; the other one if one is NaN. Of two zeros, a. */
double number_least(double a, double b);
double number_most(double a, double b);

#endif

/* functions.h: what the program computes numbers with: the language's functions and the few others that it
 * needs, by itself. Below everything else of the host; above it only the core.
 *
 * No library of the machine takes part, so that what is folded, judged or written comes out in the same bits
 * on every host. Sine and cosine, tangent, logarithm and so on err by less than 0.6 units of the last place
 * over the whole range (core/function.h); the root is correctly rounded; all others here are exact. Special
 * cases as in C's Annex F.
 */
#ifndef NUMBER_FUNCTIONS_H
#define NUMBER_FUNCTIONS_H

/* The language's functions. */
typedef enum function_id {
    FN_SIN,
    FN_COS,
    FN_TAN,
    FN_ASIN,
    FN_ACOS,
    FN_ATAN,
    FN_ATAN2,
    FN_SQRT,
    FN_EXP,
    FN_LOG,
    FN_ABS,
    FN_SIGN,
    FN_MIN,
    FN_MAX,
    FN_COUNT
} function_id;

/* The function at x, or at (x, y). NaN goes through, by min() and max(), too; FN_COUNT gives NaN. */
double number_call(function_id function, double x, double y);

double number_sine(double rad);
double number_cosine(double rad);
double number_root(double x);
double number_power(double base, double exponent);

/* Whole numbers: the next below and above, the nearest with halves away from zero, and with halves to even. */
double number_floor(double x);
double number_ceiling(double x);
double number_nearest(double x);
double number_even(double x);

/* What is left of x after whole multiples of y: with the sign of x, and within y/2. */
double number_remainder(double x, double y);
double number_centred(double x, double y);

/* x 2^exponent; and x as a number of 0.5 to below 1 times 2^*exponent, zeros, infinities and NaN as they are. */
double number_scaled(double x, int exponent);
double number_split(double x, int *exponent);

/* The lesser and the larger of two; the other one where one is no number. Of two zeros, a. */
double number_least(double a, double b);
double number_most(double a, double b);

#endif

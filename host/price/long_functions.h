/* long_functions.h: the language's functions in long double, for the reference (reference_run.h): the machine's widest
 * number, 64 binary digits on x86 and 113 on AArch64. By themselves: no library takes part, and nothing of the core that
 * the reference is to judge. Where a double's value begins an iteration, what it lacks is computed here.
 *
 * Errors are a few units of the last place, of powers some |exponent log(base)| of them. */
#ifndef PRICE_LONG_FUNCTIONS_H
#define PRICE_LONG_FUNCTIONS_H

#include <float.h>

#include "host/number/functions.h"

/* Does long double hold more than a double here? Where it does not, the reference says so. */
#define LONG_IS_LONGER (LDBL_MANT_DIG > DBL_MANT_DIG)

static inline long double long_size(long double x) { return x < 0.0L ? -x : x; }

/* Angles of up to 2^31 quarter turns. */
void long_sincos(long double rad, long double *sine, long double *cosine);
long double long_root(long double x);
long double long_power(long double base, long double exponent);
/* A function of function_rows.h at x, or at (x, y). */
long double long_call(function_id function, long double x, long double y);

#endif

/* long_list.h: the language's functions, and an operation list, in long double: 64 binary digits on x86, 113 on AArch64.
 * The reference (reference_run.h) is computed with them. They share no code with the core or with a library. If a double's
 * value begins an iteration, the missing digits are computed here.
 *
 * Errors are a few units of the last place; of powers some |exponent log(base)| of them. */
#ifndef STUDY_LONG_LIST_H
#define STUDY_LONG_LIST_H

#include <float.h>

#include "host/image/op_list.h"
#include "host/number/functions.h"

/* Does long double have more digits than double? If not, the reference reports that. */
#define LONG_IS_LONGER (LDBL_MANT_DIG > DBL_MANT_DIG)

static inline long double long_size(long double x) { return x < 0.0L ? -x : x; }

/* Angles of up to 2^31 quarter turns. */
void long_sincos(long double rad, long double *sine, long double *cosine);
long double long_root(long double x);
long double long_power(long double base, long double exponent);
/* A function of function_rows.h at x, or at (x, y). */
long double long_call(function_id function, long double x, long double y);

typedef struct long_list long_list;

/* The inputs of a list. Noise and accelerations of contacts are not available: both are 0. */
typedef struct long_leaves {
    const long double *angle_rad; /* unwrapped */
    const long double *linear;
    const long double *rate;
    const double *input;
    long double time_s;
} long_leaves;

long_list *long_list_new(const op_list *t); /* `t` must outlive it */
void long_list_free(long_list *l);          /* NULL is fine */
/* result[t->results] */
void long_list_run(long_list *l, const long_leaves *in, long double *result);

/* Does a result depend on an operation of this code? */
bool long_list_asks(const op_list *t, int result, op_code code);

#endif

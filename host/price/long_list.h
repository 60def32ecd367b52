/* long_list.h: evaluating an operation list in long double: what it says, in another arithmetic than those that run it. */
#ifndef PRICE_LONG_LIST_H
#define PRICE_LONG_LIST_H

#include "host/image/tape.h"

typedef struct long_list long_list;

/* What a list may ask for. Noise is none, and accelerations of contacts are not known: both are 0. */
typedef struct long_leaves {
    const long double *angle_rad; /* unwrapped */
    const long double *linear;
    const long double *rate;
    const double *input;
    long double time_s;
} long_leaves;

long_list *long_list_new(const tape *t); /* `t` must outlive it */
void long_list_free(long_list *l);       /* NULL is fine */
/* result[t->results] */
void long_list_run(long_list *l, const long_leaves *in, long double *result);

/* Does a result depend on an operation of this code? */
bool long_list_asks(const tape *t, int result, op_code code);

#endif

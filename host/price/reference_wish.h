/* reference_wish.h: what a reference is wanted of. */
#ifndef PRICE_REFERENCE_WISH_H
#define PRICE_REFERENCE_WISH_H

#include <signal.h>

#include "host/run/records.h"

/* A cheap reference: a run in double with compensated sums, compared with one of twice its step. */
typedef struct reference_steps {
    uint64_t steps; /* in a record's spacing, even; 0: not wanted, but the best reference */
    wh_method method;
    int order;    /* by which its error falls as the step gets shorter */
    double limit; /* it is trusted while the two differ by less of a component's largest value */
} reference_steps;

typedef struct reference_wish {
    const image *image;  /* whatever its step and end are */
    whole_ratio spacing; /* of the records, s */
    int records;         /* behind the start */
    double operations;   /* most that each of the two computations may evaluate */
    reference_steps by;
    const volatile sig_atomic_t *stop; /* may be NULL */
} reference_wish;

#endif

/* reference_wish.h: what a reference is wanted of. */
#ifndef PRICE_REFERENCE_WISH_H
#define PRICE_REFERENCE_WISH_H

#include <signal.h>

#include "host/run/records.h"

typedef struct reference_wish {
    const image *image;                /* whatever its step and end are */
    whole_ratio spacing;               /* of the records, s */
    int records;                       /* behind the start */
    double operations;                 /* most that each of the two computations may evaluate */
    const volatile sig_atomic_t *stop; /* may be NULL */
} reference_wish;

#endif

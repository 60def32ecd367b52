/* table_check.h: compares the float tables of a step (--tables) with the exact functions, phase by phase. For the
 * suite `tables` and tests/tools/tables_exhaustive.c. */
#ifndef TESTS_HOST_TABLE_CHECK_H
#define TESTS_HOST_TABLE_CHECK_H

#include "host/image/image.h"

enum { TABLE_CHECK_MOST = 16 };

typedef struct table_error {
    double worst;      /* largest |float table - function in double| */
    uint32_t worst_at; /* phase of the largest difference */
    double square;     /* sum of the squared differences */
    double bound;      /* interpolation error that the image states, plus round-off */
} table_error;

/* Compares the tables of several images of one scene with the same function values. Divides the 2^32 phases into
 * parts of `stride` phases and samples a random phase of each part. Returns the number of samples. Fills
 * error[images][TABLE_CHECK_MOST]. */
uint64_t table_check(const image *const *im, int images, uint64_t stride,
                     table_error (*error)[TABLE_CHECK_MOST]);

#endif

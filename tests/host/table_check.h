/* table_check.h: the tables of a step (--tables) in float compared with the exact functions, phase by phase. For the
 * suite and tests/tools/tables_exhaustive.c. */
#ifndef TESTS_HOST_TABLE_CHECK_H
#define TESTS_HOST_TABLE_CHECK_H

#include "host/image/image.h"

enum { TABLE_CHECK_MOST = 16 };

typedef struct table_error {
    double worst;      /* |float table - function in double| */
    uint32_t worst_at; /* phase */
    double square;     /* sum of squares */
    double bound;      /* bound: interpolation error from the image, plus round-off */
} table_error;

/* Checks tables of several images of one scene against the same function values. Samples one phase in every `stride` of
 * 2^32, at a random place in each. Returns their number. error[images][TABLE_CHECK_MOST]. */
uint64_t table_check(const image *const *im, int images, uint64_t stride,
                     table_error (*error)[TABLE_CHECK_MOST]);

#endif

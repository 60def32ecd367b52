/* table_check.h: the tables of a step (--tables) in float, beside the exact functions that they hold, phase by phase: for
 * the suite and for tests/tools/tables_exhaustive.c. */
#ifndef TESTS_HOST_TABLE_CHECK_H
#define TESTS_HOST_TABLE_CHECK_H

#include "host/image/image.h"

enum { TABLE_CHECK_MOST = 16 };

typedef struct table_error {
    double worst;      /* |float table - function in double| */
    uint32_t worst_at; /* phase */
    double square;     /* sum of squares */
    double bound;      /* what it may be: interpolation as the image states it, and rounding */
} table_error;

/* Tables of images of one scene, several forms of them: all are held against the same function values. One phase out of
 * every `stride`, at a scattered place in each, of 2^32; returns how many. error[images][TABLE_CHECK_MOST]. */
uint64_t table_check(const image *const *im, int images, uint64_t stride,
                     table_error (*error)[TABLE_CHECK_MOST]);

#endif

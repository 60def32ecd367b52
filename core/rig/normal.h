/* normal.h: linear least squares: normal equations that grow row by row, solved by Cholesky factorization.
 *
 * The unit of each unknown is its initial uncertainty, and a row of its own states it. So the matrix is the unit matrix
 * plus the other rows, and never singular. */
#ifndef WH_RIG_NORMAL_H
#define WH_RIG_NORMAL_H

#include "core/real.h"

#ifdef __cplusplus
extern "C" {
#endif

#define WH_NORMAL_UNKNOWNS 7

typedef struct wh_normal {
    wh_real matrix[WH_NORMAL_UNKNOWNS]
                  [WH_NORMAL_UNKNOWNS]; /* its lower triangle; then its factors */
    wh_real right[WH_NORMAL_UNKNOWNS];  /* right side; then the solution */
    /* sum of squared residuals over their variances at the guess; the solution reduces it */
    wh_real misfit;
} wh_normal;

#define wh_normal_start WH_NAME(wh_normal_start)
#define wh_normal_add WH_NAME(wh_normal_add)
#define wh_normal_factor WH_NAME(wh_normal_factor)
#define wh_normal_solve WH_NAME(wh_normal_solve)
#define wh_normal_deviation WH_NAME(wh_normal_deviation)

/* Only the prior: each unknown is `guess`, with a standard deviation of 1. */
void wh_normal_start(wh_normal *normal, const wh_real guess[WH_NORMAL_UNKNOWNS]);

/* A measurement: `off` is the sum of row times unknowns, with this weight (one over its variance). */
void wh_normal_add(wh_normal *normal, const wh_real row[WH_NORMAL_UNKNOWNS], wh_real off,
                   wh_real weight);

/* First the factors, some 1,000 instructions; then the unknowns, into normal->right. */
void wh_normal_factor(wh_normal *normal);
void wh_normal_solve(wh_normal *normal);

/* After the solution: the standard deviation of an unknown. */
wh_real wh_normal_deviation(const wh_normal *normal, unsigned which);

#ifdef __cplusplus
}
#endif

#endif

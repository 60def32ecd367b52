/* tare.h: the load cell's reading at rest, from noisy samples, and whether the rig was at rest.
 *
 * Noise is no motion: from one sample to the next it changes as much as over the whole time. What moves
 * slowly does not: the mean square of successive differences is then far below twice the variance (von
 * Neumann, Annals of Mathematical Statistics 12 (1941) 367). */
#ifndef WH_RIG_TARE_H
#define WH_RIG_TARE_H

#include "core/real.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct wh_tare_config {
    uint32_t samples; /* at least 2 */
    wh_real still_N;  /* slow motion with a standard deviation of this is none */
    wh_real most_N;   /* largest standard error of the mean */
} wh_tare_config;

typedef struct wh_tare {
    uint32_t count;
    wh_real mean_N;
    wh_real square_N2;  /* sum of squared deviations from the mean */
    wh_real changes_N2; /* sum of squared differences of successive samples */
    wh_real last_N;
} wh_tare;

#define wh_tare_add WH_NAME(wh_tare_add)
#define wh_tare_error_N WH_NAME(wh_tare_error_N)
#define wh_tare_is_still WH_NAME(wh_tare_is_still)

/* Take a sample; a tare of zeros has none. */
void wh_tare_add(wh_tare *tare, wh_real force_N);

/* Standard error of the mean; 0 with less than two samples. */
wh_real wh_tare_error_N(const wh_tare *tare);

/* True when what was seen is noise about one force, and little enough of it. */
bool wh_tare_is_still(const wh_tare_config *config, const wh_tare *tare);

#ifdef __cplusplus
}
#endif

#endif

/* tare.h: the load cell's reading at rest, from noisy samples, and a check that the rig was at rest.
 *
 * Motion is slow: a drift, a rotor that swings (1 to 3 Hz), a frame (up to some 10 Hz). Hum is fast, and its mean vanishes.
 * So the check uses means of 40 samples with triangular weights, one every 20 samples. With 2 ms a sample they span 80 ms.
 * They pass at most 1.6 % of hum from 45 to 65 Hz, nothing of 50 Hz, and 87 % of 5 Hz. White noise of variance s^2 leaves
 * s^2/30, and s^2 is half the mean square of successive differences (von Neumann, Annals of Mathematical Statistics 12
 * (1941) 367). The means may vary by four times that: eleven of them do so in less than one of 10,000 tares. */
#ifndef WH_RIG_TARE_H
#define WH_RIG_TARE_H

#include "core/real.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct wh_tare_config {
    uint32_t samples; /* at least 4 WH_TARE_BLOCK, for three means */
    wh_real still_N;  /* slow motion with a smaller standard deviation counts as rest */
    wh_real most_N;   /* largest standard error of the mean */
} wh_tare_config;

#define WH_TARE_BLOCK 20U /* samples */

typedef struct wh_tare {
    uint32_t count;
    wh_real mean_N;
    wh_real square_N2;  /* sum of squared deviations from the mean */
    wh_real changes_N2; /* sum of squared differences of successive samples */
    wh_real last_N;
    wh_real
        rises_N; /* this block's sum with rising and with falling weights; the last block's, rising */
    wh_real falls_N;
    wh_real before_N;
    uint32_t means; /* triangular, */
    wh_real slow_N; /* their mean, and sum of squared deviations */
    wh_real slow_N2;
} wh_tare;

#define wh_tare_add WH_NAME(wh_tare_add)
#define wh_tare_error_N WH_NAME(wh_tare_error_N)
#define wh_tare_is_still WH_NAME(wh_tare_is_still)

/* Add a sample; a zeroed tare has no samples. */
void wh_tare_add(wh_tare *tare, wh_real force_N);

/* Standard error of the mean; 0 with fewer than two samples. */
wh_real wh_tare_error_N(const wh_tare *tare);

/* True if the samples are noise and hum about one force, and small enough. */
bool wh_tare_is_still(const wh_tare_config *config, const wh_tare *tare);

#ifdef __cplusplus
}
#endif

#endif

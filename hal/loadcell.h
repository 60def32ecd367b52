/* loadcell.h: the load cell in the loading train and its converter. Raw counts are proportional to the rig's force on
 * the cell. Forces straight down (theta = 0) are positive. The rig's weight adds an offset to the counts, the tare. */
#ifndef HAL_LOADCELL_H
#define HAL_LOADCELL_H

#include <stdbool.h>
#include <stdint.h>

#include "core/linkage.h"

WH_C_BEGIN

/* Full scale of the 16-bit counts, for any converter: +-50 lbf (222.41 N), 6.79 mN per count. */
#define HAL_LOADCELL_FULL_SCALE_N 222.41108f
#define HAL_LOADCELL_RAW_MAX 32767
#define HAL_LOADCELL_N_PER_COUNT (HAL_LOADCELL_FULL_SCALE_N / 32768.0f)

/* Time between samples: a whole number of control steps. Default: 2 ms (Almesallmy 2006, I.3.2.1). */
#ifndef HAL_LOADCELL_PERIOD_TICKS
#define HAL_LOADCELL_PERIOD_TICKS 2000U
#endif

/* wh_load_status (core/rig/cell.h) has the same values and explains them. */
typedef enum hal_load_status {
    HAL_LOAD_OK,
    HAL_LOAD_SATURATED,
    HAL_LOAD_DISCONNECTED,
    HAL_LOAD_LATE,
    HAL_LOAD_REPEATED
} hal_load_status;

typedef struct hal_load_sample {
    uint32_t ticks; /* time of the averaging interval's middle, on the capture timer (clock.h) */
    int32_t raw;    /* counts of HAL_LOADCELL_N_PER_COUNT */
    uint8_t status; /* a hal_load_status */
} hal_load_sample;

/* Takes the oldest sample, or returns false. The queue has room for at least 4 samples; a full queue loses samples. Do
 * not call this function from an interrupt: the queue has one reader only. */
bool hal_loadcell_take(hal_load_sample *sample);

WH_C_END

#endif

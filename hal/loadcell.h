/* loadcell.h: the load cell in the loading train and its converter.
 * Raw counts are proportional to the force of the rig on the cell along the loading-train axis. They are positive towards
 * the mass at theta = 0, which is straight down. The force includes the rig's weight: the controller subtracts this tare. */
#ifndef HAL_LOADCELL_H
#define HAL_LOADCELL_H

#include <stdbool.h>
#include <stdint.h>

#include "core/linkage.h"

WH_C_BEGIN

/* Full scale of the 16-bit counts: +-50 lbf (222.41 N), 6.79 mN per count, for any converter. */
#define HAL_LOADCELL_FULL_SCALE_N 222.41108f
#define HAL_LOADCELL_RAW_MAX 32767
#define HAL_LOADCELL_N_PER_COUNT (HAL_LOADCELL_FULL_SCALE_N / 32768.0f)

/* Time between samples, as in Almesallmy (2006), I.3.2.1: 2 ms. It is a whole number of control steps. The build of
 * a slower chip sets another value. */
#ifndef HAL_LOADCELL_PERIOD_TICKS
#define HAL_LOADCELL_PERIOD_TICKS 2000U
#endif

/* The converter's status of a sample. wh_load_status of core/rig/cell.h has the same values. */
typedef enum hal_load_status {
    HAL_LOAD_OK,
    HAL_LOAD_SATURATED,
    HAL_LOAD_DISCONNECTED,
    HAL_LOAD_LATE,
    HAL_LOAD_REPEATED
} hal_load_status;

typedef struct hal_load_sample {
    uint32_t ticks; /* time on the capture timer (clock.h): middle of the averaging interval */
    int32_t raw;    /* counts; an overloaded cell gives plus or minus full scale */
    uint8_t status; /* a hal_load_status */
} hal_load_sample;

/* Take the oldest sample that was not taken before. Returns false if there is none. At least 4 samples are stored
 * between two calls; if more come, the newest are lost. Do not call it from an interrupt: the queue has one reader
 * only. */
bool hal_loadcell_take(hal_load_sample *sample);

WH_C_END

#endif

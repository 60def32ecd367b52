/* loadcell.h: the load cell in the loading train and its converter.
 *
 * Raw counts are proportional to the force that the rig exerts on the cell along the loading-train axis; positive towards
 * the mass at theta = 0, which is straight down. The rig's weight is part of it: the controller removes the tare. */
#ifndef HAL_LOADCELL_H
#define HAL_LOADCELL_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* 16-bit counts, full scale +-50 lbf (222.41 N): 6.79 mN a count, for any converter. Ticks are those of the force's
 * instant: if a converter averages samples, their middle (averaged.h). */
#define HAL_LOADCELL_FULL_SCALE_N 222.41108f
#define HAL_LOADCELL_RAW_MAX 32767
#define HAL_LOADCELL_N_PER_COUNT (HAL_LOADCELL_FULL_SCALE_N / 32768.0f)

/* Time between samples, as in Almesallmy (2006), I.3.2.1: 2 ms; a whole number of control steps. A slower chip sets
 * another one in its build. */
#ifndef HAL_LOADCELL_PERIOD_TICKS
#define HAL_LOADCELL_PERIOD_TICKS 2000U
#endif

/* The converter's status of a sample; wh_load_status of core/rig/cell.h has the same. */
typedef enum hal_load_status {
    HAL_LOAD_OK,
    HAL_LOAD_SATURATED,
    HAL_LOAD_DISCONNECTED,
    HAL_LOAD_LATE,
    HAL_LOAD_REPEATED
} hal_load_status;

typedef struct hal_load_sample {
    uint32_t ticks; /* of the capture timer (clock.h) at the force's instant */
    int32_t raw;    /* counts; +-full scale if the cell is overloaded */
    uint8_t status; /* a hal_load_status */
} hal_load_sample;

/* Take the oldest sample not yet taken. Returns false without one. Stores at least 4 samples between calls; if more
 * come, the newest are lost. Not from an interrupt: one reader only. */
bool hal_loadcell_take(hal_load_sample *sample);

#ifdef __cplusplus
}
#endif

#endif

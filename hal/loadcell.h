/* loadcell.h: the load cell in the loading train and its converter.
 *
 * Raw counts are proportional to the force that the rig exerts on the cell along the loading-train
 * axis; positive towards the mass at theta = 0, which is straight down. The rig's weight is part of
 * it: removing the tare is the controller's task. */
#ifndef HAL_LOADCELL_H
#define HAL_LOADCELL_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Counts of 16 bits, full scale +-50 lbf (222.41 N): 6.79 mN a count, whatever the converter has. Ticks are those of the
 * instant that the force was there: where a converter's samples are averaged, the middle of them (averaged.h). */
#define HAL_LOADCELL_FULL_SCALE_N 222.41108f
#define HAL_LOADCELL_RAW_MAX 32767
#define HAL_LOADCELL_N_PER_COUNT (HAL_LOADCELL_FULL_SCALE_N / 32768.0f)

/* Time between samples, as in Almesallmy (2006), I.3.2.1: 2 ms; a whole number of control steps. A chip that has no time for
 * so many says so in its build. */
#ifndef HAL_LOADCELL_PERIOD_TICKS
#define HAL_LOADCELL_PERIOD_TICKS 2000U
#endif

/* What the converter says of a sample; wh_load_status of core/rig/cell.h has the same. */
typedef enum hal_load_status {
    HAL_LOAD_OK,
    HAL_LOAD_SATURATED,
    HAL_LOAD_DISCONNECTED,
    HAL_LOAD_LATE,
    HAL_LOAD_REPEATED
} hal_load_status;

typedef struct hal_load_sample {
    uint32_t ticks; /* of the capture timer (clock.h) when the force was there */
    int32_t raw;    /* counts; +-full scale when the cell is overloaded */
    uint8_t status; /* a hal_load_status */
} hal_load_sample;

/* Take the oldest sample not yet taken. Returns false when there is none. At least 4 samples are
 * kept between calls; when more came, the newest are lost. Not from an interrupt: there is one who takes. */
bool hal_loadcell_take(hal_load_sample *sample);

#ifdef __cplusplus
}
#endif

#endif

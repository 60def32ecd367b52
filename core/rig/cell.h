/* cell.h: converts a load cell's samples to a time, a force and a status. Only this file applies gain, offset and the
 * delay of filter and converter. */
#ifndef WH_RIG_CELL_H
#define WH_RIG_CELL_H

#include "core/real.h"

WH_C_BEGIN

/* The converter's status of a sample. hal/loadcell.h has the same list in the same order. */
typedef enum wh_load_status {
    WH_LOAD_OK,
    WH_LOAD_SATURATED,
    WH_LOAD_DISCONNECTED,
    WH_LOAD_LATE,     /* converted at another time than its time stamp */
    WH_LOAD_REPEATED, /* there is no new value: the converter repeats the last one */
    WH_LOAD_STATUSES
} wh_load_status;

typedef struct wh_cell_config {
    wh_real newton_per_count; /* negative for a cell mounted in reverse */
    wh_real offset_N;         /* reading without force */
    uint32_t delay_ticks;     /* delay of filter and converter, from force to time stamp */
    uint32_t period_ticks;
    int32_t raw_max; /* a sample of this magnitude is at full scale */
} wh_cell_config;

typedef struct wh_load {
    uint32_t ticks; /* time of the force */
    wh_real force_N;
    wh_load_status status;
} wh_load;

/* Converts a sample with the time stamp `ticks`. A sample at full scale is saturated, even if its `status` is ok. */
WH_INLINE wh_load wh_cell_load(const wh_cell_config *config, uint32_t ticks, int32_t raw,
                               wh_load_status status) {
    wh_load load;
    load.ticks = ticks - config->delay_ticks;
    load.force_N = config->newton_per_count * (wh_real)raw - config->offset_N;
    load.status = status;
    if (status == WH_LOAD_OK && (raw >= config->raw_max || raw <= -config->raw_max)) {
        load.status = WH_LOAD_SATURATED;
    }
    return load;
}

WH_C_END

#endif

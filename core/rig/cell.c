/* cell.c: the load cell's counts as newtons, for the controller. */
#include "cell.h"

wh_load wh_cell_load(const wh_cell_config *config, uint32_t ticks, int32_t raw,
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

const char *wh_load_text(wh_load_status status) {
#define WH_LOAD_CASE(name, words) \
    case name: return words;
    switch (status) {
        WH_LOAD_ROWS(WH_LOAD_CASE)
    case WH_LOAD_STATUSES: break;
    }
    return "unknown status";
}

/* datasheet.c: time, as the rig counts it. */
#include "datasheet.h"

WH_CALLED wh_real wh_rig_since_s(uint32_t then_ticks, uint32_t now_ticks) {
    return (wh_real)(now_ticks - then_ticks) / (wh_real)WH_RIG_TICKS_PER_S;
}

WH_CALLED wh_real wh_rig_way_s(uint32_t from_ticks, uint32_t to_ticks) {
    return (wh_real)(int32_t)(to_ticks - from_ticks) / (wh_real)WH_RIG_TICKS_PER_S;
}

WH_CALLED bool wh_rig_is_over(uint32_t then_ticks, uint32_t now_ticks, wh_real most_s) {
    return wh_rig_since_s(then_ticks, now_ticks) > most_s;
}

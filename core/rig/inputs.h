/* inputs.h: what a control step sees beside pulses and samples, orders among it. */
#ifndef WH_RIG_INPUTS_H
#define WH_RIG_INPUTS_H

#include "life.h"
#include "phases.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What a control step sees beside pulses, samples and orders. */
typedef struct wh_rig_inputs {
    uint32_t now_ticks;
    wh_real supply_V;
    bool stop_pressed;
    bool clock_is_fallback; /* too inexact for a speed */
    bool watchdog_has_cut;
} wh_rig_inputs;

typedef struct wh_rig_order {
    wh_rig_event event;
    wh_real value;
} wh_rig_order;

#ifdef __cplusplus
}
#endif

#endif

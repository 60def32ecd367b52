/* inputs.h: a control step's inputs other than pulses and samples, including orders. */
#ifndef WH_RIG_INPUTS_H
#define WH_RIG_INPUTS_H

#include "phases.h"
#include "state_machine.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The source of a stop request: the drive stage's fault may share the stop input's line. */
typedef enum wh_stop_by { WH_STOP_BY_EITHER, WH_STOP_BY_INPUT, WH_STOP_BY_DRIVE } wh_stop_by;

/* A control step's inputs other than pulses, samples and orders. */
typedef struct wh_rig_inputs {
    uint32_t now_ticks;
    wh_real supply_V;
    bool stop_pressed;
    wh_stop_by stop_by;     /* when it is */
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

/* orders.h: what an order asks for, beside the state that life.h has: a supply, a rig at rest, a cause that is gone. */
#ifndef WH_RIG_ORDERS_H
#define WH_RIG_ORDERS_H

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

/* What an order is looked at with. */
typedef struct wh_order_sight {
    const wh_guard_config *guarding;
    const wh_run_config *running;
    const wh_guard *guard;
    const wh_rig_inputs *inputs;
    bool at_rest;  /* the rotor, behind a trip */
    bool can_feed; /* gravity's torque forward: slower set-points can be held */
} wh_order_sight;

#define wh_order_refused WH_NAME(wh_order_refused)

/* What is against an order that the state allows; WH_ALLOWED: nothing. */
wh_refusal wh_order_refused(const wh_order_sight *sight, const wh_rig_order *order);

#ifdef __cplusplus
}
#endif

#endif

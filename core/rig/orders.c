/* orders.c: what an order asks for, beside the state that life.c has. */
#include "orders.h"

static wh_refusal may_arm(const wh_order_sight *sight) {
    const wh_rig_inputs *inputs = sight->inputs;
    if (inputs->stop_pressed) {
        return WH_REFUSED_STOP_INPUT;
    }
    if (inputs->watchdog_has_cut) {
        return WH_REFUSED_WATCHDOG;
    }
    if (inputs->clock_is_fallback) {
        return WH_REFUSED_CLOCK;
    }
    if (!wh_guard_supply(sight->guarding, inputs->supply_V)) {
        return WH_REFUSED_SUPPLY;
    }
    if (!sight->guard->load_good ||
        !wh_guard_load_comes(sight->guarding, sight->guard, inputs->now_ticks)) {
        return WH_REFUSED_LOAD_CELL;
    }
    return sight->guard->quiet ? WH_ALLOWED : WH_REFUSED_TURNING;
}

static wh_refusal may_turn(const wh_order_sight *sight, wh_real target_radps) {
    if (!wh_guard_allows(sight->guarding, target_radps, sight->can_feed)) {
        return WH_REFUSED_TARGET;
    }
    return wh_run_needs_V(sight->running, target_radps) <= sight->inputs->supply_V
               ? WH_ALLOWED
               : WH_REFUSED_VOLTAGE;
}

/* Rest, and the cause gone. Without pulses that can be believed rest is a matter of time. */
static wh_refusal may_clear(const wh_order_sight *sight) {
    const wh_rig_inputs *inputs = sight->inputs;
    if (!sight->at_rest || !sight->guard->quiet) {
        return WH_REFUSED_TURNING;
    }
    switch (sight->guard->trip) {
    case WH_TRIP_WATCHDOG: return inputs->watchdog_has_cut ? WH_REFUSED_WATCHDOG : WH_ALLOWED;
    case WH_TRIP_SUPPLY:
        return wh_guard_supply(sight->guarding, inputs->supply_V) ? WH_ALLOWED : WH_REFUSED_SUPPLY;
    case WH_TRIP_LOAD_CELL:
        return sight->guard->load_good &&
                       wh_guard_load_comes(sight->guarding, sight->guard, inputs->now_ticks)
                   ? WH_ALLOWED
                   : WH_REFUSED_LOAD_CELL;
    case WH_TRIP_NONE:
    case WH_TRIP_OVERSPEED:
    case WH_TRIP_PULSES:
    case WH_TRIP_STALLED:
    case WH_TRIP_MOVING:
    case WH_TRIP_UNSETTLED:
    case WH_TRIP_RECORD:
    case WH_TRIP_RUNS_ON: break;
    }
    return WH_ALLOWED;
}

wh_refusal wh_order_refused(const wh_order_sight *sight, const wh_rig_order *order) {
    switch (order->event) {
    case WH_EVENT_ARM: return may_arm(sight);
    case WH_EVENT_START:
        return sight->inputs->stop_pressed ? WH_REFUSED_STOP_INPUT : may_turn(sight, order->value);
    case WH_EVENT_SET: return may_turn(sight, order->value);
    case WH_EVENT_CLEAR: return may_clear(sight);
    case WH_EVENT_STOP:
    case WH_EVENT_HOST_LOST:
    case WH_EVENT_DONE:
    case WH_EVENT_RESTED:
    case WH_EVENT_EXPIRED:
    case WH_EVENT_TRIP:
    case WH_EVENTS: break;
    }
    return WH_ALLOWED;
}

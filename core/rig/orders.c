/* orders.c: conditions of an order beyond state_machine.c's states: a supply, a rig at rest, a removed cause. */
#include "rig.h"

static WH_CALLED bool cell_is_good(const wh_rig_config *config, const wh_rig *rig,
                                   const wh_rig_inputs *inputs) {
    return rig->guard.load_good &&
           wh_guard_load_comes(&config->guard, &rig->guard, inputs->now_ticks);
}

static wh_refusal may_arm(const wh_rig_config *config, const wh_rig *rig,
                          const wh_rig_inputs *inputs) {
    if (inputs->stop_pressed) {
        return WH_REFUSED_STOP_INPUT;
    }
    if (inputs->watchdog_has_cut) {
        return WH_REFUSED_WATCHDOG;
    }
    if (inputs->clock_is_fallback) {
        return WH_REFUSED_CLOCK;
    }
    if (!wh_guard_supply(&config->guard, inputs->supply_V)) {
        return WH_REFUSED_SUPPLY;
    }
    if (!cell_is_good(config, rig, inputs)) {
        return WH_REFUSED_LOAD_CELL;
    }
    return rig->guard.quiet ? WH_ALLOWED : WH_REFUSED_TURNING;
}

static wh_refusal may_turn(const wh_rig_config *config, const wh_rig *rig,
                           const wh_rig_inputs *inputs, wh_real target_radps) {
    /* slower set-points are possible if gravity's torque can be fed forward */
    const bool can_feed = config->feeds != WH_COMPENSATION_NEVER && rig->observer.status == WH_OK;
    const bool feeds = can_feed && (config->feeds == WH_COMPENSATION_ALWAYS ||
                                    target_radps < config->guard.target_min_radps);
    if (!wh_guard_allows(&config->guard, target_radps, feeds)) {
        return WH_REFUSED_TARGET;
    }
    return wh_run_needs_V(&config->run, target_radps) <= inputs->supply_V ? WH_ALLOWED
                                                                          : WH_REFUSED_VOLTAGE;
}

/* Rest, and the cause removed. With unreliable pulses, rest is a matter of time. */
static wh_refusal may_clear(const wh_rig_config *config, const wh_rig *rig,
                            const wh_rig_inputs *inputs) {
    if (!rig->at_rest || !rig->guard.quiet) {
        return WH_REFUSED_TURNING;
    }
    switch (rig->guard.trip) {
    case WH_TRIP_WATCHDOG: return inputs->watchdog_has_cut ? WH_REFUSED_WATCHDOG : WH_ALLOWED;
    case WH_TRIP_SUPPLY:
        return wh_guard_supply(&config->guard, inputs->supply_V) ? WH_ALLOWED : WH_REFUSED_SUPPLY;
    case WH_TRIP_LOAD_CELL:
        return cell_is_good(config, rig, inputs) ? WH_ALLOWED : WH_REFUSED_LOAD_CELL;
    case WH_TRIP_NONE:
    case WH_TRIP_OVERSPEED:
    case WH_TRIP_PULSES:
    case WH_TRIP_STALLED:
    case WH_TRIP_MOVING:
    case WH_TRIP_UNSETTLED:
    case WH_TRIP_RECORD:
    case WH_TRIP_RUNS_ON:
    case WH_TRIP_FASTER:
    case WH_TRIP_ORDER:
    case WH_TRIP_UNBRAKED: break;
    }
    return WH_ALLOWED;
}

wh_refusal wh_order_refused(const wh_rig_config *config, const wh_rig *rig,
                            const wh_rig_inputs *inputs, const wh_rig_order *order) {
    switch (order->event) {
    case WH_EVENT_ARM: return may_arm(config, rig, inputs);
    case WH_EVENT_START:
        return inputs->stop_pressed ? WH_REFUSED_STOP_INPUT
                                    : may_turn(config, rig, inputs, order->value);
    case WH_EVENT_SET: return may_turn(config, rig, inputs, order->value);
    case WH_EVENT_CLEAR: return may_clear(config, rig, inputs);
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

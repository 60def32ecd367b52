/* guard.c: what stops the rig. */
#include "guard.h"

void wh_guard_start(wh_guard *guard) { *guard = (wh_guard){.trip = WH_TRIP_NONE}; }

bool wh_guard_allows(const wh_guard_config *config, wh_real target_radps) {
    return target_radps >= WH_R(0.0) && target_radps <= config->target_max_radps;
}

void wh_guard_trip(wh_guard *guard, wh_trip reason) {
    if (guard->trip == WH_TRIP_NONE) {
        guard->trip = reason;
    }
}

void wh_guard_speed(const wh_guard_config *config, wh_guard *guard, const wh_speed *speed,
                    uint32_t now_ticks) {
    if (speed->taken != guard->pulses_seen) {
        guard->pulses_seen = speed->taken;
        const wh_real fast = config->limit_radps * (WH_R(1.0) + config->ripple);
        /* one early pulse may be a disturbance, two are a speed */
        guard->fast_intervals = speed->interval_radps > fast ? guard->fast_intervals + 1U : 0U;
    }
    if ((speed->known && speed->turn_radps > config->limit_radps) || guard->fast_intervals >= 2U) {
        wh_guard_trip(guard, WH_TRIP_OVERSPEED);
    }
    if (speed->lost - guard->lost_before > config->lost_max ||
        wh_speed_silence_s(speed, now_ticks) > config->silence_max_s) {
        wh_guard_trip(guard, WH_TRIP_PULSES);
    }
}

void wh_guard_load(const wh_guard_config *config, wh_guard *guard, int16_t raw, bool turning) {
    if (raw >= config->load_raw_max || raw <= -config->load_raw_max) {
        wh_guard_trip(guard, WH_TRIP_LOAD_CELL);
    }
    guard->equal_samples = turning && raw == guard->last_raw ? guard->equal_samples + 1U : 0U;
    guard->last_raw = raw;
    if (guard->equal_samples >= config->stuck_samples) {
        wh_guard_trip(guard, WH_TRIP_LOAD_CELL);
    }
}

const char *wh_trip_text(wh_trip reason) {
    switch (reason) {
    case WH_TRIP_NONE: return "no fault";
    case WH_TRIP_TARGET: return "the set-point is above what the shaft carries";
    case WH_TRIP_OVERSPEED: return "over-speed";
    case WH_TRIP_PULSES: return "slot pulses are missing";
    case WH_TRIP_STALLED: return "the rotor does not start";
    case WH_TRIP_LOAD_CELL: return "the load cell is stuck or overloaded";
    case WH_TRIP_WATCHDOG: return "the watchdog cut the motor";
    case WH_TRIP_MOVING: return "the rig was not at rest for the tare";
    case WH_TRIP_UNSETTLED: return "the speed does not settle";
    case WH_TRIP_RECORD: return "the record holds no whole turn";
    case WH_TRIP_RUNS_ON: return "the rotor does not come to rest";
    }
    return "unknown reason";
}

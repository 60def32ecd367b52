/* guard.c: what stops the rig. */
#include "guard.h"

#include "datasheet.h"

void wh_guard_start(wh_guard *guard, uint32_t now_ticks) {
    *guard = (wh_guard){.trip = WH_TRIP_NONE, .load_ticks = now_ticks};
}

bool wh_guard_allows(const wh_guard_config *config, wh_real target_radps) {
    return target_radps >= config->target_min_radps && target_radps <= config->target_max_radps;
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

void wh_guard_load(const wh_guard_config *config, wh_guard *guard, const wh_speed *speed,
                   const wh_load *load, bool turning) {
    if (load->status == WH_LOAD_REPEATED) {
        return;
    }
    guard->load_ticks = load->ticks;
    if (load->status == WH_LOAD_SATURATED || load->status == WH_LOAD_DISCONNECTED) {
        wh_guard_trip(guard, WH_TRIP_LOAD_CELL);
    }
    /* measured in turns, not in time: the load of a jammed rotor stands still as well. And one pulse a
     * sample: all that a late controller finds waiting are no turns of the samples behind them. */
    guard->still_pulses += speed->taken != guard->load_pulses ? 1U : 0U;
    guard->load_pulses = speed->taken;
    const wh_real still_N = config->load_still_kgm * speed->turn_radps * speed->turn_radps;
    if (!turning || !(WH_ABS(load->force_N - guard->still_N) <= still_N)) {
        guard->still_pulses = 0;
        guard->still_N = load->force_N;
    } else if (guard->still_pulses >= config->stuck_pulses) {
        wh_guard_trip(guard, WH_TRIP_LOAD_CELL);
    }
}

void wh_guard_load_silence(const wh_guard_config *config, wh_guard *guard, uint32_t now_ticks) {
    /* signed: a sample may be stamped later than the step's own reading of the timer */
    const int32_t age_ticks = (int32_t)(now_ticks - guard->load_ticks);
    if ((wh_real)age_ticks > config->load_silence_max_s * (wh_real)WH_RIG_TICKS_PER_S) {
        wh_guard_trip(guard, WH_TRIP_LOAD_CELL);
    }
}

const char *wh_trip_text(wh_trip reason) {
    switch (reason) {
    case WH_TRIP_NONE: return "no fault";
    case WH_TRIP_TARGET:
        return "the set-point is below what the loop can hold or above what the shaft carries";
    case WH_TRIP_OVERSPEED: return "over-speed";
    case WH_TRIP_PULSES: return "slot pulses are missing or out of order";
    case WH_TRIP_STALLED: return "the rotor does not start";
    case WH_TRIP_LOAD_CELL: return "the load cell is silent, stuck, overloaded or disconnected";
    case WH_TRIP_WATCHDOG: return "the watchdog cut the motor";
    case WH_TRIP_MOVING: return "the rig was not at rest for the tare";
    case WH_TRIP_UNSETTLED: return "the speed does not settle or stay";
    case WH_TRIP_RECORD: return "the record lacks load samples or counted turns";
    case WH_TRIP_RUNS_ON: return "the rotor does not come to rest";
    }
    return "unknown reason";
}

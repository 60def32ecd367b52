/* rig.c: the eccentric-mass rig's test run as a state machine, without hardware. */
#include "rig.h"

#include "datasheet.h"

#define RPM(x) (WH_R(x) * WH_RIG_RADPS_PER_RPM)

/* The loop: from duty to mean speed the rotor is a lag of about 0.24 s with a gain of 60 rad/s, and
 * a speed taken over the last turn is some 0.15 s old. The integral's zero cancels the lag, the gain
 * puts the crossover at 2.5 rad/s: 65 degrees of phase margin. docs/rig.md has the reasons. */
const wh_rig_config wh_rig_standard = {
    .step_s = WH_R(0.002),
    .drive = {.proportional_per_radps = WH_R(0.010),
              .integral_per_rad = WH_R(0.042),
              .ramp_radps2 = RPM(60.0),
              .duty_min = WH_R(0.0),
              .duty_max = WH_R(1.0)},
    .guard = {.target_min_radps = WH_RIG_TARGET_MIN_RPM * WH_RIG_RADPS_PER_RPM,
              .target_max_radps = WH_RIG_TARGET_MAX_RPM * WH_RIG_RADPS_PER_RPM,
              .limit_radps = WH_RIG_SHAFT_LIMIT_RPM * WH_RIG_RADPS_PER_RPM,
              .ripple = WH_R(0.1),
              .lost_max = 3,
              .silence_max_s = WH_R(0.5),
              .load_silence_max_s = WH_R(0.02), /* ten samples' periods */
              .load_still_raw = 8,
              .stuck_pulses = 3}, /* a whole turn from the first to the last */
    .impossible_radps = WH_RIG_IMPOSSIBLE_RPM * WH_RIG_RADPS_PER_RPM,
    .tare_samples = 250,
    .spin_up_duty = WH_R(0.4),
    .take_over_radps = RPM(150.0),
    .spin_up_max_s = WH_R(5.0),
    .settle_band_radps = RPM(0.5),
    .settle_s = WH_R(2.5),
    .settle_max_s = WH_R(20.0),
    .record_band_radps = RPM(2.0),
    .slow_radps = RPM(200.0),
    .rest_s = WH_R(1.5),
    .rest_max_s = WH_R(10.0),
};

static wh_real since_s(uint32_t then_ticks, uint32_t now_ticks) {
    return (wh_real)(now_ticks - then_ticks) / (wh_real)WH_RIG_TICKS_PER_S;
}

static void enter(wh_rig *rig, wh_rig_state state, uint32_t now_ticks) {
    rig->state = state;
    rig->since_ticks = now_ticks;
    rig->band_ticks = now_ticks;
}

static bool motor_drives(const wh_rig *rig) {
    return rig->state >= WH_RIG_SPIN_UP && rig->state <= WH_RIG_RAMP_DOWN;
}

void wh_rig_start(const wh_rig_config *config, wh_rig *rig, wh_real target_radps,
                  uint32_t now_ticks) {
    *rig = (wh_rig){.target_radps = target_radps};
    wh_speed_start(&rig->speed, config->impossible_radps);
    wh_guard_start(&rig->guard, now_ticks);
    enter(rig, WH_RIG_TARE, now_ticks);
    if (!wh_guard_allows(&config->guard, target_radps)) {
        wh_guard_trip(&rig->guard, WH_TRIP_TARGET);
    }
}

void wh_rig_pulse(wh_rig *rig, unsigned sensor, uint32_t ticks) {
    const uint32_t restarts = rig->speed.restarts;
    if (!wh_speed_pulse(&rig->speed, sensor, ticks) || rig->state != WH_RIG_RECORD) {
        return;
    }
    if (rig->speed.restarts != restarts) {
        rig->record_is_broken = true; /* nobody knows how many turns the gap had */
    } else if (rig->mark_count[sensor] < WH_RIG_MARKS_MAX) {
        rig->marks[sensor][rig->mark_count[sensor]++] =
            (wh_mark){.ticks = ticks, .quarter = rig->speed.quarter};
    }
}

/* Sample i of a record must have been taken i periods after the first: the lock-in counts on it. */
static void record(const wh_rig_config *config, wh_rig *rig, uint32_t ticks, int16_t raw) {
    if (rig->samples == 0) {
        rig->first_ticks = ticks;
    }
    const uint32_t due_ticks = rig->first_ticks + rig->samples * config->load_period_ticks;
    const uint32_t half = config->load_period_ticks / 2U;
    if (ticks - due_ticks + half > 2U * half) {
        rig->record_is_broken = true;
    }
    rig->raw[rig->samples++] = raw;
}

void wh_rig_load(const wh_rig_config *config, wh_rig *rig, uint32_t ticks, int16_t raw) {
    const bool turning = rig->state >= WH_RIG_RAMP && rig->state <= WH_RIG_RAMP_DOWN;
    wh_guard_load(&config->guard, &rig->guard, &rig->speed, ticks, raw, turning);
    if (rig->state == WH_RIG_TARE) {
        const bool first = rig->tare_count == 0;
        rig->tare_low_raw = first || raw < rig->tare_low_raw ? raw : rig->tare_low_raw;
        rig->tare_high_raw = first || raw > rig->tare_high_raw ? raw : rig->tare_high_raw;
        rig->tare_sum_raw += raw;
        rig->tare_count++;
    } else if (rig->state == WH_RIG_RECORD && rig->samples < WH_RIG_RECORD_SAMPLES) {
        record(config, rig, ticks, raw);
    }
}

/* The result of a full record; trips when there is no whole turn in it. */
static void evaluate(const wh_rig_config *config, wh_rig *rig) {
    const wh_load_record record = {rig->raw, rig->samples, rig->first_ticks,
                                   config->load_period_ticks};
    wh_lockin_result found;
    if (!wh_lockin(&record, rig->marks[0], rig->mark_count[0], -config->slot_lead_rad, &found)) {
        wh_guard_trip(&rig->guard, WH_TRIP_RECORD);
        return;
    }
    const wh_real gain = config->newton_per_count;
    wh_rig_result *result = &rig->result;
    result->turns = found.turns;
    result->speed_radps = WH_RIG_TWO_PI / found.turn_s;
    result->tare_N = gain * rig->tare_raw;
    result->mean_N = gain * (found.mean_counts - rig->tare_raw);
    result->amplitude_N = gain * found.amplitude_counts;
    result->phase_rad = found.phase_rad;

    int16_t low = rig->raw[0];
    int16_t high = rig->raw[0];
    for (unsigned i = 1; i < rig->samples; i++) {
        low = rig->raw[i] < low ? rig->raw[i] : low;
        high = rig->raw[i] > high ? rig->raw[i] : high;
    }
    result->low_N = gain * ((wh_real)low - rig->tare_raw);
    result->high_N = gain * ((wh_real)high - rig->tare_raw);

    for (unsigned sensor = 0; sensor < WH_SPEED_SENSORS; sensor++) {
        wh_real sum = WH_R(0.0);
        unsigned count = 0;
        for (unsigned i = 0; i < rig->mark_count[sensor]; i++) {
            wh_real counts;
            if (wh_load_at(&record, rig->marks[sensor][i].ticks, &counts)) {
                sum += counts - rig->tare_raw;
                count++;
            }
        }
        result->at_spike_N[sensor] = count == 0 ? WH_R(0.0) : gain * sum / (wh_real)count;
    }
    result->duty = rig->duty;
    result->lost = rig->speed.lost - rig->guard.lost_before;
    result->rejected = rig->speed.rejected;
}

static void tare(const wh_rig_config *config, wh_rig *rig, uint32_t now_ticks) {
    if (rig->tare_count < config->tare_samples) {
        return;
    }
    if (rig->tare_high_raw - rig->tare_low_raw > config->guard.load_still_raw) {
        wh_guard_trip(&rig->guard, WH_TRIP_MOVING);
        return;
    }
    rig->tare_raw = (wh_real)rig->tare_sum_raw / (wh_real)rig->tare_count;
    rig->duty = config->spin_up_duty;
    /* the slot of a hanging rotor stands at sensor 1: a shiver gives a pulse, and it grows old */
    wh_speed_start(&rig->speed, config->impossible_radps);
    enter(rig, WH_RIG_SPIN_UP, now_ticks);
}

static void spin_up(const wh_rig_config *config, wh_rig *rig, uint32_t now_ticks) {
    if (rig->speed.known && rig->speed.turn_radps >= config->take_over_radps) {
        wh_drive_start(&config->drive, &rig->drive, rig->speed.turn_radps, rig->duty);
        rig->drive.target_radps = rig->target_radps;
        /* the first turns swing so much that the count of lost pulses means nothing */
        rig->guard.lost_before = rig->speed.lost;
        enter(rig, WH_RIG_RAMP, now_ticks);
    } else if (since_s(rig->since_ticks, now_ticks) > config->spin_up_max_s) {
        wh_guard_trip(&rig->guard, WH_TRIP_STALLED);
    }
}

static wh_real off_target(const wh_rig *rig) {
    return WH_ABS(rig->speed.turn_radps - rig->target_radps);
}

static void settle(const wh_rig_config *config, wh_rig *rig, uint32_t now_ticks) {
    if (off_target(rig) > config->settle_band_radps) {
        rig->band_ticks = now_ticks;
    }
    if (since_s(rig->band_ticks, now_ticks) >= config->settle_s) {
        enter(rig, WH_RIG_RECORD, now_ticks);
    } else if (since_s(rig->since_ticks, now_ticks) > config->settle_max_s) {
        wh_guard_trip(&rig->guard, WH_TRIP_UNSETTLED);
    }
}

/* Motor off: wait for the pulses to stay away. When it is the pulses that failed, only time tells. */
static void coast(const wh_rig_config *config, wh_rig *rig, uint32_t now_ticks) {
    const bool blind = rig->guard.trip == WH_TRIP_PULSES;
    const bool waited = since_s(rig->since_ticks, now_ticks) >= config->rest_s;
    const bool silent =
        !rig->speed.running || wh_speed_silence_s(&rig->speed, now_ticks) >= config->rest_s;
    const bool late = since_s(rig->since_ticks, now_ticks) > config->rest_max_s;
    if (waited && silent && !blind) { /* and stays so: these times wrap every 71.6 minutes */
        rig->at_rest = true;
    }
    if (rig->state == WH_RIG_COAST && rig->at_rest) {
        enter(rig, WH_RIG_DONE, now_ticks);
    } else if (rig->state == WH_RIG_COAST && late) {
        wh_guard_trip(&rig->guard, WH_TRIP_RUNS_ON);
    } else if (late) {
        rig->at_rest = true; /* tripped, and nothing more can be done from here */
    }
}

static void close_loop(const wh_rig_config *config, wh_rig *rig, uint32_t now_ticks) {
    /* a speed that is no longer confirmed by pulses must not move the motor */
    if (!wh_speed_is_overdue(&rig->speed, now_ticks)) {
        rig->duty =
            wh_drive_step(&config->drive, &rig->drive, rig->speed.turn_radps, config->step_s);
    }
}

wh_real wh_rig_step(const wh_rig_config *config, wh_rig *rig, uint32_t now_ticks,
                    bool watchdog_has_cut) {
    if (watchdog_has_cut) {
        wh_guard_trip(&rig->guard, WH_TRIP_WATCHDOG);
    }
    if (rig->state < WH_RIG_COAST) {
        wh_guard_load_silence(&config->guard, &rig->guard, now_ticks);
    }
    if (motor_drives(rig)) {
        wh_guard_speed(&config->guard, &rig->guard, &rig->speed, now_ticks);
    }
    switch (rig->state) {
    case WH_RIG_TARE: tare(config, rig, now_ticks); break;
    case WH_RIG_SPIN_UP: spin_up(config, rig, now_ticks); break;
    case WH_RIG_RAMP:
        close_loop(config, rig, now_ticks);
        if (wh_drive_at_target(&rig->drive)) {
            enter(rig, WH_RIG_SETTLE, now_ticks);
        }
        break;
    case WH_RIG_SETTLE:
        close_loop(config, rig, now_ticks);
        settle(config, rig, now_ticks);
        break;
    case WH_RIG_RECORD:
        close_loop(config, rig, now_ticks);
        if (rig->record_is_broken) {
            wh_guard_trip(&rig->guard, WH_TRIP_RECORD);
        }
        if (off_target(rig) > config->record_band_radps) {
            wh_guard_trip(&rig->guard, WH_TRIP_UNSETTLED);
        }
        if (rig->samples == WH_RIG_RECORD_SAMPLES) {
            evaluate(config, rig);
            if (config->slow_radps < rig->target_radps) {
                rig->drive.target_radps = config->slow_radps;
            }
            enter(rig, WH_RIG_RAMP_DOWN, now_ticks);
        }
        break;
    case WH_RIG_RAMP_DOWN:
        close_loop(config, rig, now_ticks);
        if (wh_drive_at_target(&rig->drive)) {
            rig->duty = WH_R(0.0);
            enter(rig, WH_RIG_COAST, now_ticks);
        }
        break;
    case WH_RIG_COAST:
    case WH_RIG_TRIPPED: coast(config, rig, now_ticks); break;
    case WH_RIG_DONE: break;
    }
    if (rig->guard.trip != WH_TRIP_NONE && rig->state != WH_RIG_TRIPPED) {
        rig->at_rest = false;
        enter(rig, WH_RIG_TRIPPED, now_ticks);
    }
    if (rig->state == WH_RIG_TRIPPED) {
        rig->duty = WH_R(0.0);
    }
    return rig->duty;
}

bool wh_rig_is_over(const wh_rig *rig) {
    return rig->state == WH_RIG_DONE || (rig->state == WH_RIG_TRIPPED && rig->at_rest);
}

const char *wh_rig_state_text(wh_rig_state state) {
    switch (state) {
    case WH_RIG_TARE: return "tare";
    case WH_RIG_SPIN_UP: return "spin up";
    case WH_RIG_RAMP: return "ramp";
    case WH_RIG_SETTLE: return "settle";
    case WH_RIG_RECORD: return "record";
    case WH_RIG_RAMP_DOWN: return "ramp down";
    case WH_RIG_COAST: return "coast";
    case WH_RIG_DONE: return "done";
    case WH_RIG_TRIPPED: return "tripped";
    }
    return "unknown state";
}

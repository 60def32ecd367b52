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
              /* a tenth of what the masses' force moves it by */
              .load_still_kgm = WH_R(0.1) * WH_RIG_MASS_MOMENT_KGM,
              .stuck_pulses = 3}, /* a whole turn from the first to the last */
    .rotor = {.mass_moment_kgm = WH_RIG_MASS_MOMENT_KGM,
              .gravity_mps2 = WH_RIG_GRAVITY_MPS2,
              .damping_Nms = WH_RIG_DAMPING_NMS,
              .damping_tolerance = WH_R(0.03),
              .inertia_kgm2 = WH_RIG_INERTIA_KGM2},
    .tare = {.samples = 250, .still_N = WH_R(0.05), .most_N = WH_R(0.25)},
    .result = {.mount_factor = WH_R(1.0),
               .amplitude_floor = WH_R(1e-4),
               .phase_floor_rad = WH_R(0.01) / WH_RIG_DEG_PER_RAD,
               .amplitude_off = WH_R(0.05),
               .amplitude_wrong = WH_R(0.25),
               .phase_off_rad = WH_R(5.0) / WH_RIG_DEG_PER_RAD,
               .phase_wrong_rad = WH_R(20.0) / WH_RIG_DEG_PER_RAD,
               .residual_large = WH_R(0.25),
               .mean_off = WH_R(0.1),
               .inertia_off = WH_R(0.5)},
    .impossible_radps = WH_RIG_IMPOSSIBLE_RPM * WH_RIG_RADPS_PER_RPM,
    .spin_up_duty = WH_R(0.4),
    .take_over_radps = RPM(150.0),
    .spin_up_max_s = WH_R(5.0),
    .settle_band_radps = RPM(0.5),
    .settle_s = WH_R(2.5),
    .settle_max_s = WH_R(20.0),
    .record_s = WH_R(2.0),
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

void wh_rig_slots(wh_rig_config *config, wh_real lead_rad) {
    config->rotor.mark_rad[0] = -lead_rad;
    config->rotor.mark_rad[1] = WH_R(0.25) * WH_RIG_TWO_PI - lead_rad;
}

void wh_rig_start(const wh_rig_config *config, wh_rig *rig, wh_real target_radps,
                  uint32_t now_ticks) {
    *rig = (wh_rig){.target_radps = target_radps};
    wh_speed_start(&rig->speed, config->impossible_radps);
    wh_guard_start(&rig->guard, now_ticks);
    wh_lockin_start(&config->rotor, &rig->lockin);
    enter(rig, WH_RIG_TARE, now_ticks);
    if (!wh_guard_allows(&config->guard, target_radps)) {
        wh_guard_trip(&rig->guard, WH_TRIP_TARGET);
    }
}

void wh_rig_pulse(wh_rig *rig, unsigned sensor, uint32_t ticks) {
    const uint32_t restarts = rig->speed.restarts;
    if (!wh_speed_pulse(&rig->speed, sensor, ticks)) {
        return;
    }
    if (rig->state == WH_RIG_TARE) {
        rig->tare_pulses[sensor]++;
    }
    if (rig->speed.restarts != restarts) {
        wh_lockin_gap(&rig->lockin); /* nobody knows how many turns the gap had */
    }
    wh_lockin_mark(&rig->lockin, sensor, ticks, rig->speed.quarter);
}

static bool record_lasts(const wh_rig_config *config, const wh_rig *rig, uint32_t ticks) {
    return rig->state == WH_RIG_RECORD && since_s(rig->since_ticks, ticks) <= config->record_s;
}

static void see_peaks(wh_rig *rig, wh_real force_N) {
    wh_rig_result *result = &rig->result;
    result->low_N = rig->peaks && result->low_N < force_N ? result->low_N : force_N;
    result->high_N = rig->peaks && result->high_N > force_N ? result->high_N : force_N;
    rig->peaks = true;
}

void wh_rig_load(const wh_rig_config *config, wh_rig *rig, uint32_t ticks, int32_t raw,
                 wh_load_status status) {
    const wh_load load = wh_cell_load(&config->cell, ticks, raw, status);
    const bool turning = rig->state >= WH_RIG_RAMP && rig->state <= WH_RIG_RAMP_DOWN;
    wh_guard_load(&config->guard, &rig->guard, &rig->speed, &load, turning);
    if (rig->state != WH_RIG_TARE) {
        wh_lockin_load(&rig->lockin, &load);
    }
    if (load.status != WH_LOAD_OK) {
        return;
    }
    if (rig->state == WH_RIG_TARE) {
        wh_tare_add(&rig->tare, load.force_N);
    } else if (record_lasts(config, rig, load.ticks)) {
        see_peaks(rig, load.force_N - rig->tare.mean_N);
    }
}

/* A turn is measured: what follows from it, in pieces, one a control step. */
static void measure(const wh_rig_config *config, wh_rig *rig) {
    wh_measured *force = &rig->result.force;
    if (rig->due == 2U) {
        wh_merge_mean(&config->result, &config->rotor, &rig->merge, &rig->lockin.angle,
                      rig->tare.mean_N, force);
        force->left_out += rig->lockin.skipped - rig->skipped_before;
    } else if (rig->due == 1U) {
        wh_merge_judge(&config->result, &config->rotor, &rig->merge, force);
    }
    if (rig->due > 0) {
        rig->due--;
        return;
    }
    if (!wh_lockin_work(&config->rotor, &config->cell, &rig->lockin)) {
        return;
    }
    /* turns that lie within the record as a whole */
    const wh_lockin_turn *turn = &rig->lockin.turn;
    const bool begins_within = (int32_t)(turn->begin_ticks - rig->since_ticks) >= 0;
    if (begins_within && record_lasts(config, rig, turn->begin_ticks + turn->turn_ticks)) {
        wh_merge_add(&config->result, &config->rotor, &rig->merge, turn, &rig->lockin.angle);
        rig->due = 2;
    }
}

static void begin_record(wh_rig *rig, uint32_t now_ticks) {
    rig->merge = (wh_merge){.turns = 0};
    rig->due = 0;
    rig->peaks = false;
    rig->ends = false;
    rig->skipped_before = rig->lockin.skipped;
    enter(rig, WH_RIG_RECORD, now_ticks);
}

/* A turn's samples are through within a fraction of the next turn. */
#define LAST_TURN_MAX_S WH_R(0.5)

/* The record's time is over: the last whole turn may still be worked on, and then all are merged once more, with what
 * was skipped. */
static void end_record(const wh_rig_config *config, wh_rig *rig, uint32_t now_ticks) {
    const bool late = since_s(rig->since_ticks, now_ticks) > config->record_s + LAST_TURN_MAX_S;
    if (!rig->ends && (rig->lockin.stage == WH_LOCKIN_WAITS || late) && rig->due == 0) {
        rig->ends = true;
        rig->due = 2;
    }
    if (!rig->ends || rig->due > 0) {
        return;
    }
    if (rig->merge.turns == 0) {
        wh_guard_trip(&rig->guard, WH_TRIP_RECORD);
        return;
    }
    wh_rig_result *result = &rig->result;
    result->tare_N = rig->tare.mean_N;
    result->tare_error_N = wh_tare_error_N(&rig->tare);
    result->duty = rig->duty;
    result->lost = rig->speed.lost - rig->guard.lost_before;
    result->rejected = rig->speed.rejected;
    if (config->slow_radps < rig->target_radps) {
        rig->drive.target_radps = config->slow_radps;
    }
    enter(rig, WH_RIG_RAMP_DOWN, now_ticks);
}

/* The slot of a hanging rotor stands at sensor 1, where a shiver makes pulses; but one that passes sensor 2, or
 * passes sensor 1 again and again, is no hanging rotor. */
#define TARE_PULSES_MOST 2U

static void tare(const wh_rig_config *config, wh_rig *rig, uint32_t now_ticks) {
    if (rig->tare.count < config->tare.samples) {
        return;
    }
    if (rig->tare_pulses[0] > TARE_PULSES_MOST || rig->tare_pulses[1] > 0 ||
        !wh_tare_is_still(&config->tare, &rig->tare)) {
        wh_guard_trip(&rig->guard, WH_TRIP_MOVING);
        return;
    }
    rig->duty = config->spin_up_duty;
    /* what was seen so far is that shiver, and it grows old */
    wh_speed_start(&rig->speed, config->impossible_radps);
    wh_lockin_gap(&rig->lockin);
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
        begin_record(rig, now_ticks);
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
    measure(config, rig);
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
        if (off_target(rig) > config->record_band_radps) {
            wh_guard_trip(&rig->guard, WH_TRIP_UNSETTLED);
        }
        if (!record_lasts(config, rig, now_ticks)) {
            end_record(config, rig, now_ticks);
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

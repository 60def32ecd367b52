/* phases.c: a test run of the eccentric-mass rig, phase by phase. */
#include "phases.h"

#include "core/text.h"
#include "datasheet.h"

static void enter(wh_run *run, wh_rig_phase phase, uint32_t now_ticks) {
    run->phase = phase;
    run->since_ticks = now_ticks;
    run->band_ticks = now_ticks;
    run->ample_ticks = now_ticks;
}

void wh_run_start(wh_run *run, wh_real target_radps, uint32_t now_ticks) {
    *run = (wh_run){.target_radps = target_radps};
    enter(run, WH_PHASE_TARE, now_ticks);
}

void wh_run_set(wh_run *run, wh_real target_radps, uint32_t now_ticks) {
    run->target_radps = target_radps;
    if (wh_run_is_closed(run)) {
        enter(run, WH_PHASE_RAMP, now_ticks);
    }
}

void wh_run_off(wh_run *run, wh_real speed_radps, uint32_t now_ticks) {
    run->volts = WH_R(0.0);
    run->off_radps = speed_radps;
    enter(run, WH_PHASE_OFF, now_ticks);
}

/* For this time after the loop has closed, the measured speed may jump, because the first turn began in the spin-up. */
#define JUMP_S WH_R(0.5)

wh_setpoint wh_run_setpoint(const wh_run_config *config, const wh_run *run, uint32_t ticks) {
    if (!wh_run_drives(run)) {
        return (wh_setpoint){.setpoint_radps = run->off_radps, .limit_radps = run->off_radps};
    }
    /* The commanded speed is `unloaded` in the spin-up, the higher of `unloaded` and `setpoint` for the next
     * WH_RUN_START_S, and `setpoint` after that. */
    const wh_real unloaded = run->volts / config->rated_V * config->no_load_radps;
    const wh_real setpoint = run->drive.setpoint_radps;
    const bool opens = run->phase == WH_PHASE_SPIN_UP;
    const wh_real closed_s = wh_rig_since_s(run->closed_ticks, ticks);
    const bool starts = opens || (unloaded > setpoint && closed_s < WH_RUN_START_S);
    const wh_real lead = starts ? unloaded : setpoint;
    return (wh_setpoint){.setpoint_radps = lead,
                         .limit_radps = lead > run->left_radps ? lead : run->left_radps,
                         .jumps = opens || closed_s < JUMP_S};
}

wh_real wh_run_needs_V(const wh_run_config *config, wh_real speed_radps) {
    return speed_radps / config->no_load_radps * config->rated_V + config->drag_V;
}

/* A set-point that needs gravity compensation is used only while gravity is compensated. */
static bool ramp(wh_run *run, const wh_run_scene *scene) {
    const bool allowed = wh_guard_allows(scene->guarding, run->target_radps, scene->compensated);
    run->drive.target_radps = allowed ? run->target_radps : scene->guarding->target_min_radps;
    if (wh_rig_is_over(run->since_ticks, scene->now_ticks, scene->config->ramp_max_s)) {
        wh_guard_trip(scene->guard, WH_TRIP_UNSETTLED);
    }
    return allowed && wh_drive_at_target(&run->drive);
}

/* The slot of a hanging rotor is at sensor 1. So jitter may cause up to this many pulses of sensor 1 during the tare.
 * More pulses, or a pulse of sensor 2, mean that the rotor does not hang. */
#define TARE_PULSES_MOST 2U

static void tare(wh_run *run, const wh_run_scene *scene) {
    const wh_measure *measure = scene->measure;
    if (measure->tare.count < scene->measuring->tare.samples) {
        return;
    }
    if (run->tare_pulses[0] > TARE_PULSES_MOST || run->tare_pulses[1] > 0 ||
        !wh_tare_is_still(&scene->measuring->tare, &measure->tare)) {
        wh_guard_trip(scene->guard, WH_TRIP_MOVING);
        return;
    }
    run->volts = scene->config->spin_up_V;
    /* Earlier pulses are old, or come from jitter while the hanging rotor's slot is at sensor 1. */
    wh_pulses_forget(scene->pulses);
    wh_guard_drives(scene->guard);
    wh_lockin_gap(&scene->measure->lockin);
    enter(run, WH_PHASE_SPIN_UP, scene->now_ticks);
}

static void spin_up(wh_run *run, const wh_run_scene *scene) {
    const wh_run_config *config = scene->config;
    const wh_speed *speed = &scene->pulses->speed;
    const wh_real wanted =
        config->spin_up_V +
        config->spin_up_V_per_s * wh_rig_since_s(run->since_ticks, scene->now_ticks);
    const wh_real most = scene->supply_V < config->rated_V ? scene->supply_V : config->rated_V;
    run->volts = wanted < most ? wanted : most;
    if (speed->known && speed->turn_radps >= config->take_over_radps) {
        wh_drive_start(&run->drive, speed->turn_radps, run->volts);
        run->closed_ticks = scene->now_ticks;
        /* The speed varies so much in the first turns that lost pulses cannot be counted. */
        scene->guard->lost_before = speed->lost;
        scene->guard->rejected_before = scene->pulses->rejected;
        enter(run, WH_PHASE_RAMP, scene->now_ticks);
    } else if (wh_rig_is_over(run->since_ticks, scene->now_ticks, config->spin_up_max_s)) {
        wh_guard_trip(scene->guard, WH_TRIP_STALLED);
    }
}

static void see_turn(wh_run *run, const wh_speed *speed) {
    if (speed->taken == run->turns_taken) {
        return;
    }
    run->turns_taken = speed->taken;
    run->turn_radps[run->turns % WH_RUN_TURNS] = speed->turn_radps;
    run->turns++;
    wh_real sum = WH_R(0.0);
    for (unsigned i = 0; i < WH_RUN_TURNS; i++) {
        sum += run->turn_radps[i];
    }
    run->mean_radps = sum / (wh_real)WH_RUN_TURNS;
}

static void settle(wh_run *run, const wh_run_scene *scene) {
    const wh_run_config *config = scene->config;
    const uint32_t now = scene->now_ticks;
    see_turn(run, &scene->pulses->speed);
    /* Pulses jitter, so a mean speed within the band is enough. */
    const wh_real turn_off = WH_ABS(scene->pulses->speed.turn_radps - run->target_radps);
    const wh_real mean_off = WH_ABS(run->mean_radps - run->target_radps);
    if (turn_off > config->settle_band_radps &&
        (run->turns < WH_RUN_TURNS || mean_off > config->settle_band_radps)) {
        run->band_ticks = now;
    }
    if (!scene->busy && wh_rig_since_s(run->band_ticks, now) >= config->settle_s) {
        wh_measure_record(scene->measuring, scene->measure, run->target_radps, now);
        enter(run, WH_PHASE_RECORD, now);
    } else if (wh_rig_is_over(run->since_ticks, now, config->settle_max_s)) {
        wh_guard_trip(scene->guard, WH_TRIP_UNSETTLED);
    }
}

/* A single turn outside the band trips the rig, because a mean over several turns would react too late to a runaway
 * drive. The band of 2 rpm is six times the error of a turn at 330 rpm with 120 us of jitter. */
static bool record(wh_run *run, const wh_run_scene *scene) {
    see_turn(run, &scene->pulses->speed);
    const wh_real off = WH_ABS(scene->pulses->speed.turn_radps - run->target_radps);
    if (off > scene->config->record_band_radps) {
        wh_guard_trip(scene->guard, WH_TRIP_UNSETTLED);
        return false;
    }
    wh_measure *measure = scene->measure;
    if (wh_measure_lasts(measure, scene->now_ticks) || scene->busy ||
        !wh_measure_end(measure, scene->now_ticks)) {
        return false;
    }
    if (measure->merge.turns == 0) {
        wh_guard_trip(scene->guard, WH_TRIP_RECORD);
        return false;
    }
    measure->result.volts = run->volts;
    measure->result.lost = scene->pulses->speed.lost - scene->guard->lost_before;
    measure->result.rejected = scene->pulses->rejected - scene->guard->rejected_before;
    if (scene->config->slow_radps < run->target_radps) {
        run->drive.target_radps = scene->config->slow_radps;
    }
    enter(run, WH_PHASE_RAMP_DOWN, scene->now_ticks);
    return true;
}

static void close_loop(wh_run *run, const wh_run_scene *scene) {
    const wh_run_config *config = scene->config;
    const wh_speed *speed = &scene->pulses->speed;
    /* If the pulses no longer confirm the speed, it must not control the motor. */
    if (speed->known && !wh_speed_is_overdue(speed, scene->now_ticks)) {
        run->volts = wh_drive_step(&config->drive, &run->drive, speed->turn_radps, scene->supply_V,
                                   config->step_s);
    }
    const bool too_slow = run->drive.setpoint_radps - speed->turn_radps > config->record_band_radps;
    if (!too_slow || run->volts < scene->supply_V) {
        run->ample_ticks = scene->now_ticks;
    } else if (wh_rig_is_over(run->ample_ticks, scene->now_ticks, config->short_max_s)) {
        wh_guard_trip(scene->guard, WH_TRIP_SUPPLY);
    }
}

bool wh_run_step(wh_run *run, const wh_run_scene *scene) {
    if (wh_run_is_closed(run)) {
        close_loop(run, scene);
    }
    switch (run->phase) {
    case WH_PHASE_TARE: tare(run, scene); break;
    case WH_PHASE_SPIN_UP: spin_up(run, scene); break;
    case WH_PHASE_RAMP:
        if (ramp(run, scene)) {
            run->turns = 0;
            enter(run, WH_PHASE_SETTLE, scene->now_ticks);
        }
        break;
    case WH_PHASE_SETTLE: settle(run, scene); break;
    case WH_PHASE_RECORD: return record(run, scene);
    case WH_PHASE_RAMP_DOWN:
        if (wh_drive_at_target(&run->drive)) {
            wh_run_off(run, scene->pulses->speed.turn_radps, scene->now_ticks);
        }
        break;
    case WH_PHASE_NONE:
    case WH_PHASE_OFF:
    case WH_PHASES: break;
    }
    return false;
}

#define ITEM(name, words) words "\0"

const char *wh_phase_text(wh_rig_phase phase) {
    static const char words[] WH_WORD_LIST =
        WH_PHASE_ROWS(ITEM) WH_WORDS("brake") WH_WORDS("unknown phase");
    return wh_words_item(words, phase);
}

/* === bounds on the speed and time of the next slot pulse ==================================== */

/* Fractions of a turn by which a pulse may be early. */
#define SETTLE_WINDOW WH_R(0.03)
#define RAMP_WINDOW WH_R(0.12)
#define RECORD_PART WH_R(0.8) /* as a part of record_band_radps / target_radps */
/* For the first two pulses from rest, the bound uses this part of the commanded speed: the rotor is still slower. */
#define FIRST_PART WH_R(0.8)
/* The last one or two pulses of a braked rotor come at less than this speed. */
#define SLOW_RADPS WH_R(16.0)

void wh_pulse_window_set(const wh_guard_config *guard, const wh_run_config *running, wh_run *run,
                         wh_pulses *pulses, bool open, uint32_t ticks) {
    const wh_rig_phase phase = run->phase;
    const wh_speed *speed = &pulses->speed;
    const wh_setpoint setpoint = wh_run_setpoint(running, run, ticks);
    const bool from_rest = phase == WH_PHASE_SPIN_UP && !speed->known;
    const wh_real part = from_rest && speed->taken < 2U ? FIRST_PART : WH_R(1.0);
    const wh_real falls = from_rest ? WH_R(0.0) : open ? WH_GUARD_LIGHTER : WH_R(1.0);
    pulses->bound_radps = wh_guard_bound_radps(guard, part * setpoint.limit_radps, falls);
    pulses->climb_radps2 =
        setpoint.jumps ? guard->climb_start_radps2
                       : wh_guard_climb_radps2(guard, setpoint.setpoint_radps - speed->turn_radps,
                                               wh_run_is_closed(run));
    /* left_radps falls with the rotor's speed. Only the commanded speed can raise it; a runaway drive cannot. */
    run->left_radps = speed->known && speed->turn_radps < setpoint.limit_radps
                          ? speed->turn_radps
                          : setpoint.limit_radps;
    pulses->window = phase == WH_PHASE_RECORD
                         ? RECORD_PART * running->record_band_radps / run->target_radps
                         : (phase == WH_PHASE_SETTLE ? SETTLE_WINDOW : RAMP_WINDOW);
}

void wh_pulse_window_off(wh_run *run, wh_pulses *pulses, bool brakes, unsigned sensor,
                         uint32_t ticks) {
    static const wh_real moved_rad[] = {WH_R(0.75) * WH_RIG_TWO_PI, WH_R(0.25) * WH_RIG_TWO_PI};
    if (!pulses->speed.running) {
        return;
    }
    /* pulses->last is the last accepted pulse. A suspect may have come after it. */
    const bool same = sensor == pulses->last.pulse.sensor;
    const bool again = same && !pulses->suspects;
    const wh_real moved = same ? WH_RIG_TWO_PI : moved_rad[sensor];
    const wh_real passed_s = wh_rig_since_s(pulses->speed.ticks, ticks);
    /* The motor must have been off for the whole interval, because a driven rotor may have gained speed. */
    const bool coasted = (int32_t)(pulses->speed.ticks - run->since_ticks) >= 0;
    if (coasted && moved < run->off_radps * passed_s) {
        run->off_radps = moved / passed_s;
    }
    if (again) {
        wh_pulses_forget(pulses);
    }
    /* A rotor that only swings must not count as slow. */
    pulses->slow =
        run->phase == WH_PHASE_OFF && brakes && sensor == 1U && run->off_radps < SLOW_RADPS;
}

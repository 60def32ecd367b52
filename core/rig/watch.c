/* watch.c: what the guard is told of the rig, in every state. */
#include "watch.h"

#include "datasheet.h"

/* How fast, and how early, may a pulse come? */
#define SETTLE_WINDOW WH_R(0.03)
#define RAMP_WINDOW WH_R(0.12) /* no mark is sure before */
#define RECORD_PART WH_R(0.8)  /* of what the record lets the speed be off */
#define FIRST_PART WH_R(0.8)   /* of where it is led: from rest it takes time to get there */
#define SLOW_RADPS WH_R(16.0)  /* a pulse or two of a rotor that brakes are slower */

static void expect(const wh_rig_config *config, wh_rig *rig, uint32_t ticks) {
    const wh_guard_config *guard = &config->guard;
    const wh_rig_phase phase = rig->run.phase;
    const wh_speed *speed = &rig->pulses.speed;
    const wh_led led = wh_run_led(&config->run, &rig->run, ticks);
    const bool from_rest = phase == WH_PHASE_SPIN_UP && !speed->known;
    const wh_real part = from_rest && speed->taken < 2U ? FIRST_PART : WH_R(1.0);
    rig->pulses.bound_radps = wh_guard_bound_radps(guard, part * led.base_radps, !from_rest);
    rig->pulses.climb_radps2 =
        led.jumps ? guard->climb_start_radps2
                  : wh_guard_climb_radps2(guard, led.base_radps - speed->turn_radps,
                                          wh_run_is_closed(&rig->run));
    rig->pulses.window = phase == WH_PHASE_RECORD
                             ? RECORD_PART * config->run.record_band_radps / rig->run.target_radps
                             : (phase == WH_PHASE_SETTLE ? SETTLE_WINDOW : RAMP_WINDOW);
}

/* With the motor off nothing makes the rotor faster again than it was between its last two pulses, but gravity. A sensor
 * that fires again is one in whose slot it swings, or has missed a pulse: what was known of its speed is nothing now. */
static void slower(const wh_rig_config *config, wh_rig *rig, unsigned sensor, uint32_t ticks) {
    static const wh_real moved_rad[] = {WH_R(0.75) * WH_RIG_TWO_PI, WH_R(0.25) * WH_RIG_TWO_PI};
    const wh_pulses *pulses = &rig->pulses;
    if (!pulses->speed.running || sensor >= WH_SPEED_SENSORS) {
        return;
    }
    const bool again = sensor == pulses->last.pulse.sensor && !pulses->suspects;
    const wh_real moved = again ? WH_RIG_TWO_PI : moved_rad[sensor];
    const wh_real passed_s = wh_rig_since_s(pulses->speed.ticks, ticks);
    /* over which it was not driven: before that it may have gathered speed */
    const bool coasted = (int32_t)(pulses->speed.ticks - rig->run.since_ticks) >= 0;
    if (coasted && moved < rig->run.off_radps * passed_s) {
        rig->run.off_radps = moved / passed_s;
    }
    if (again) {
        wh_pulses_start(&rig->pulses, config->impossible_radps);
    }
    /* where it brakes: one that swings freely passes the sensors to and fro, and no interval is a speed */
    rig->pulses.slow =
        rig->run.phase == WH_PHASE_OFF && rig->brakes && rig->run.off_radps < SLOW_RADPS;
}

void wh_rig_expect(const wh_rig_config *config, wh_rig *rig, unsigned sensor, uint32_t ticks) {
    if (!wh_run_drives(&rig->run)) {
        slower(config, rig, sensor, ticks);
    }
    expect(config, rig, ticks);
}

/* --- every control step ---------------------------------------------------------------------------- */

/* At a slow speed silence is measured in turns: two lost pulses leave nearly two. */
#define SILENT_RAD WH_R(12.0)

static wh_real silence_s(const wh_rig_config *config, const wh_rig *rig) {
    if (!wh_run_is_closed(&rig->run)) {
        return config->guard.slow_silence_max_s;
    }
    const wh_real least = config->guard.silence_max_s * rig->run.drive.setpoint_radps;
    return least >= SILENT_RAD ? config->guard.silence_max_s
                               : SILENT_RAD / rig->run.drive.setpoint_radps;
}

/* With the motor off: what is known of a rotor that rests? */
static void rest(const wh_rig_config *config, wh_rig *rig, uint32_t now_ticks) {
    wh_guard_quiet(&config->guard, &rig->guard, rig->pulses_ever, now_ticks);
    if (rig->guard.quiet) {
        rig->run.off_radps = WH_R(0.0);
        if (rig->pulses.speed.running) { /* times of old pulses wrap */
            wh_pulses_start(&rig->pulses, config->impossible_radps);
        }
    }
}

void wh_rig_watch(const wh_rig_config *config, wh_rig *rig, const wh_rig_inputs *inputs) {
    wh_guard *guard = &rig->guard;
    const bool drives = wh_run_drives(&rig->run);
    if (inputs->watchdog_has_cut) {
        wh_guard_trip(guard, WH_TRIP_WATCHDOG);
    }
    if (!drives) {
        rest(config, rig, inputs->now_ticks);
    }
    /* with the motor off nothing speeds up a rotor whose speed was known */
    const bool slows = !drives && rig->run.off_radps < config->guard.limit_radps;
    wh_guard_speed(&config->guard, guard, &rig->pulses, slows ? WH_TRIP_RUNS_ON : WH_TRIP_OVERSPEED,
                   drives);
    if (rig->run.phase == WH_PHASE_SPIN_UP && !rig->pulses.speed.running &&
        wh_rig_since_s(rig->run.since_ticks, inputs->now_ticks) >
            config->guard.slow_silence_max_s) {
        wh_guard_trip(guard, WH_TRIP_STALLED); /* or is not seen: it must not get fast */
    }
    if (drives) {
        wh_guard_pulses(&config->guard, guard, &rig->pulses, silence_s(config, rig),
                        inputs->now_ticks);
    }
    const bool needed = rig->state == WH_LIFE_ARMED || rig->state == WH_LIFE_RUNNING || drives;
    if (needed && !wh_guard_supply(&config->guard, inputs->supply_V)) {
        wh_guard_trip(guard, WH_TRIP_SUPPLY);
    }
    if (needed && !wh_guard_load_comes(&config->guard, guard, inputs->now_ticks)) {
        wh_guard_trip(guard, WH_TRIP_LOAD_CELL);
    }
}

/* rig.c: the eccentric-mass rig's controller. Each control step runs the guard, takes the orders and steps the run. */
#include "rig.h"

#include <stddef.h>

#include "core/frame.h"
#include "datasheet.h"

void wh_rig_slots(wh_rig_config *config, wh_real lead_rad) {
    config->measure.rotor.pulse_rad[0] = -lead_rad;
    config->measure.rotor.pulse_rad[1] = WH_R(0.25) * WH_RIG_TWO_PI - lead_rad;
    config->swing.lead_rad = lead_rad;
    config->observer.pulse_rad[0] = config->measure.rotor.pulse_rad[0];
    config->observer.pulse_rad[1] = config->measure.rotor.pulse_rad[1];
}

static void enter(wh_rig *rig, wh_rig_state state, uint32_t now_ticks) {
    rig->state = state;
    rig->since_ticks = now_ticks;
    rig->rested = false;
    rig->at_rest = false;
}

void wh_rig_start(const wh_rig_config *config, wh_rig *rig, uint32_t now_ticks,
                  const wh_trip_record *before) {
    *rig = (wh_rig){.state = WH_RIG_IDLE};
    wh_pulses_start(&rig->pulses, config->impossible_radps);
    wh_guard_start(&rig->guard, now_ticks);
    (void)wh_observer_start(&config->observer, &rig->observer, now_ticks);
    enter(rig, WH_RIG_IDLE, now_ticks);
    /* the rotor may turn at an unknown speed: assume the limit */
    rig->run.off_radps = config->guard.limit_radps;
    rig->run.since_ticks = now_ticks;
    if (before != NULL && before->trip != WH_TRIP_NONE) {
        rig->record = *before;
        rig->guard.trip = before->trip;
        enter(rig, WH_RIG_TRIPPED, now_ticks);
    }
}

bool wh_rig_post(wh_rig *rig, wh_rig_event event, wh_real value) {
    if (rig->orders == WH_RIG_ORDERS_MOST) {
        return false;
    }
    rig->order[rig->orders++] = (wh_rig_order){.event = event, .value = value};
    return true;
}

static bool brakes(const wh_rig *rig) {
    return rig->brakes && rig->run.phase == WH_PHASE_OFF && !rig->guard.off.released;
}

void wh_rig_pulse(const wh_rig_config *config, wh_rig *rig, unsigned sensor, uint32_t ticks) {
    if (sensor >= WH_RIG_SENSORS) {
        rig->pulses.rejected++;
        return;
    }
    rig->pulses_ever++;
    rig->busy = true;
    rig->decides = rig->decides || rig->pulses.suspects;
    const bool open = !wh_run_drives(&rig->run) && !brakes(rig);
    if (!wh_run_drives(&rig->run)) {
        wh_guard_off_pulse(&config->guard, &rig->guard, !open, sensor, ticks);
        wh_pulse_window_off(&rig->run, &rig->pulses, !open, sensor, ticks);
    }
    wh_pulse_window_set(&config->guard, &config->run, &rig->run, &rig->pulses, open, ticks);
    rig->heard_ticks[sensor][1] = rig->heard_ticks[sensor][0];
    rig->heard_ticks[sensor][0] = ticks;
    if (rig->run.phase == WH_PHASE_TARE) {
        rig->run.tare_pulses[sensor]++;
    }
    wh_pulses_take(&rig->pulses, sensor, ticks);
    if (WH_RIG_SWINGS && !wh_run_drives(&rig->run)) {
        wh_swing_pulse(&rig->swing, sensor, ticks);
    }
}

void wh_rig_load(const wh_rig_config *config, wh_rig *rig, uint32_t ticks, int32_t raw,
                 wh_load_status status) {
    const wh_load load = wh_cell_load(&config->measure.cell, ticks, raw, status);
    rig->loads++;
    const bool needed = rig->state == WH_RIG_ARMED || rig->run.phase != WH_PHASE_NONE;
    wh_guard_load(&config->guard, &rig->guard, &rig->pulses.speed, &load,
                  wh_run_is_closed(&rig->run), needed);
    const bool at_rest = rig->run.phase == WH_PHASE_TARE;
    if (at_rest || wh_run_drives(&rig->run)) {
        wh_measure_load(&rig->measure, &load, at_rest);
    }
}

/* === the likely cause of a trip ============================================================== */

#define HEARD_TICKS (8U * WH_RIG_TICKS_PER_S)

/* Returns true if the last four pulses are recent and their sensors alternate. Sets way[] to the three times between
 * these pulses, in ticks, the newest first. Sets *last to the sensor of the newest pulse. */
static bool last_ways(const wh_rig *rig, uint32_t now_ticks, uint32_t *way, unsigned *last) {
    *last = (int32_t)(rig->heard_ticks[1][0] - rig->heard_ticks[0][0]) > 0 ? 1U : 0U;
    const uint32_t *newest = rig->heard_ticks[*last];
    const uint32_t *other = rig->heard_ticks[1U - *last];
    way[0] = newest[0] - other[0];
    way[1] = other[0] - newest[1];
    way[2] = newest[1] - other[1];
    bool alternate =
        rig->pulses_ever - rig->pulses_before >= 4U && now_ticks - other[1] < HEARD_TICKS;
    for (unsigned i = 0; i < 3U; i++) {
        alternate = alternate && way[i] > 0 && way[i] < HEARD_TICKS;
    }
    return alternate;
}

/* Duration of a turn at 3,200 rpm. Shorter turns are noise, because no motor of the settings turns that fast. */
#define STORM_TICKS 18750U

/* In the right order, sensor 2 fires a quarter turn after sensor 1. */
static bool order_is_wrong(const wh_rig *rig, uint32_t now_ticks) {
    uint32_t way[3];
    unsigned last;
    if (!last_ways(rig, now_ticks, way, &last)) {
        return false;
    }
    if (way[0] + way[1] < STORM_TICKS || way[1] + way[2] < STORM_TICKS) {
        return false;
    }
    return last == 1U ? way[0] > way[1] && way[2] > way[1] : way[1] > way[0] && way[1] > way[2];
}

/* A trip for over-speed needs two pulses, which may take this time. */
#define TWO_PULSES_S WH_R(0.5)

/* Returns the likely cause of the guard's trip, or that trip itself if the cause is unknown. */
static wh_trip cause_of(const wh_rig_config *config, const wh_rig *rig, uint32_t now_ticks) {
    const wh_trip trip = rig->guard.trip;
    const bool of_pulses = trip == WH_TRIP_OVERSPEED || trip == WH_TRIP_PULSES ||
                           trip == WH_TRIP_STALLED || trip == WH_TRIP_UNSETTLED;
    if (!of_pulses || !wh_run_drives(&rig->run)) {
        return trip;
    }
    if (order_is_wrong(rig, now_ticks)) {
        return WH_TRIP_ORDER;
    }
    if (trip != WH_TRIP_OVERSPEED || rig->pulses.speed.turn_radps > config->guard.limit_radps) {
        return trip;
    }
    const bool starts =
        rig->run.phase == WH_PHASE_SPIN_UP ||
        !wh_rig_is_over(rig->run.closed_ticks, now_ticks, WH_RUN_START_S + TWO_PULSES_S);
    return starts ? WH_TRIP_FASTER : trip;
}

/* === reasons to refuse an order =============================================================== */

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
    const bool can_compensate =
        config->compensation_when != WH_COMPENSATION_NEVER && rig->observer.status == WH_OK;
    const bool compensates =
        can_compensate && (config->compensation_when == WH_COMPENSATION_ALWAYS ||
                           target_radps < config->guard.target_min_radps);
    if (!wh_guard_allows(&config->guard, target_radps, compensates)) {
        return WH_REFUSED_TARGET;
    }
    return wh_run_needs_V(&config->run, target_radps) <= inputs->supply_V ? WH_ALLOWED
                                                                          : WH_REFUSED_VOLTAGE;
}

/* A trip can be cleared if the rotor is at rest and the trip's cause is gone. */
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

static wh_refusal order_refused(const wh_rig_config *config, const wh_rig *rig,
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

/* === a control step ========================================================================== */

static void trip(wh_rig *rig, const wh_rig_inputs *inputs) {
    rig->record = (wh_trip_record){.trip = rig->guard.trip,
                                   .phase = rig->run.phase,
                                   .ticks = inputs->now_ticks,
                                   .speed_radps = rig->pulses.speed.turn_radps,
                                   .volts = rig->run.volts,
                                   .supply_V = inputs->supply_V};
}

static WH_CALLED void choose_feed(const wh_rig_config *config, wh_rig *rig, wh_real target_radps) {
    rig->compensated = config->compensation_when == WH_COMPENSATION_ALWAYS ||
                       (config->compensation_when == WH_COMPENSATION_SLOW &&
                        target_radps < config->guard.target_min_radps);
    if (!rig->compensated) {
        wh_lockin_compensate(&rig->measure.lockin, false, WH_R(0.0));
    }
}

static void begin_run(const wh_rig_config *config, wh_rig *rig, wh_real target_radps,
                      uint32_t now_ticks) {
    wh_pulses_start(&rig->pulses, config->impossible_radps);
    wh_measure_begin(&config->measure, &rig->measure);
    wh_observer_forget(&rig->observer);
    rig->observed = 0;
    rig->brakes = config->stop_brakes && !config->swings;
    choose_feed(config, rig, target_radps);
    rig->guard.lost_before = 0;
    rig->guard.rejected_before = 0;
    rig->has_result = false;
    rig->ended = WH_END_NONE;
    rig->runs++;
    wh_run_start(&rig->run, target_radps, now_ticks);
}

/* Returns an upper bound on the present speed. The last turn's speed is too old if the rotor accelerates. */
static wh_real fastest_radps(const wh_rig_config *config, const wh_rig *rig, uint32_t now_ticks) {
    const wh_real turn_radps = rig->pulses.speed.turn_radps;
    const wh_real limit_radps =
        wh_run_drives(&rig->run) ? wh_run_setpoint(&config->run, &rig->run, now_ticks).limit_radps
                                 : WH_R(0.0);
    return limit_radps > turn_radps ? limit_radps : turn_radps;
}

static wh_rig_end stopped_by(const wh_rig_inputs *inputs, wh_rig_event event) {
    if (event == WH_EVENT_HOST_LOST) {
        return WH_END_HOST_LOST;
    }
    if (!inputs->stop_pressed) {
        return WH_END_STOP;
    }
    switch (inputs->stop_by) {
    case WH_STOP_BY_INPUT: return WH_END_STOP_INPUT;
    case WH_STOP_BY_DRIVE: return WH_END_DRIVE_FAULT;
    case WH_STOP_BY_EITHER: break;
    }
    return WH_END_STOP_OR_FAULT;
}

/* Does what an allowed order asks for, and enters `next` if it is another state. */
static void follow(const wh_rig_config *config, wh_rig *rig, const wh_rig_inputs *inputs,
                   const wh_rig_order *order, wh_rig_state next) {
    const uint32_t now = inputs->now_ticks;
    const bool moves = rig->state == WH_RIG_RUNNING || rig->state == WH_RIG_STOPPING;
    switch (order->event) {
    case WH_EVENT_START: begin_run(config, rig, order->value, now); break;
    case WH_EVENT_SET:
        wh_run_set(&rig->run, order->value, now);
        choose_feed(config, rig, order->value);
        break;
    case WH_EVENT_STOP:
    case WH_EVENT_HOST_LOST:
        /* Brake only if the enable is already on, because a stop must never switch it on. */
        rig->brakes = config->stop_brakes && (wh_run_drives(&rig->run) || brakes(rig));
        if (moves && rig->run.phase != WH_PHASE_OFF) {
            rig->ended = stopped_by(inputs, order->event);
            wh_run_off(&rig->run, fastest_radps(config, rig, now), now);
        }
        break;
    case WH_EVENT_TRIP:
        rig->guard.trip = cause_of(config, rig, now);
        if (moves && rig->run.phase != WH_PHASE_OFF) {
            rig->ended = WH_END_TRIP;
        }
        trip(rig, inputs);
        wh_run_off(&rig->run, rig->pulses.speed.turn_radps, now);
        rig->run.phase = WH_PHASE_NONE;
        break;
    case WH_EVENT_RESTED:
    case WH_EVENT_EXPIRED: rig->run.phase = WH_PHASE_NONE; break;
    case WH_EVENT_CLEAR:
        rig->guard.trip = WH_TRIP_NONE;
        /* a reset must not restore this trip */
        rig->record = (wh_trip_record){.trip = WH_TRIP_NONE};
        break;
    case WH_EVENT_ARM: rig->pulses_before = rig->pulses_ever; break;
    case WH_EVENT_DONE: rig->ended = WH_END_DONE; break;
    case WH_EVENTS: break;
    }
    if (next != rig->state) {
        enter(rig, next, now);
    }
}

static wh_refusal happens(const wh_rig_config *config, wh_rig *rig, const wh_rig_inputs *inputs,
                          const wh_rig_order *order) {
    const wh_rig_transition rule = wh_rig_transition_of(rig->state, order->event);
    if (rule.refusal != WH_ALLOWED) {
        return rule.refusal;
    }
    const wh_refusal refusal = order_refused(config, rig, inputs, order);
    if (refusal == WH_ALLOWED && (order->event != WH_EVENT_HOST_LOST || config->host_loss_stops)) {
        follow(config, rig, inputs, order, rule.next);
    }
    return refusal;
}

static void finds(const wh_rig_config *config, wh_rig *rig, const wh_rig_inputs *inputs,
                  wh_rig_event event) {
    const wh_rig_order order = {.event = event};
    (void)happens(config, rig, inputs, &order);
}

static void take_orders(const wh_rig_config *config, wh_rig *rig, const wh_rig_inputs *inputs) {
    for (unsigned i = 0; i < rig->orders; i++) {
        const wh_rig_order *order = &rig->order[i];
        rig->asked = order->event;
        rig->answer = order->event <= WH_EVENT_HOST_LOST ? happens(config, rig, inputs, order)
                                                         : WH_REFUSED_EVENT;
        rig->answers++;
    }
    rig->orders = 0;
}

/* Two lost pulses leave a gap of up to 7 quarter turns: 11 rad. */
#define SILENT_RAD WH_R(12.0)

static wh_real silence_s(const wh_rig_config *config, const wh_rig *rig) {
    if (!wh_run_is_closed(&rig->run)) {
        return config->guard.slow_silence_max_s;
    }
    const wh_real least = config->guard.silence_max_s * rig->run.drive.setpoint_radps;
    return least >= SILENT_RAD ? config->guard.silence_max_s
                               : SILENT_RAD / rig->run.drive.setpoint_radps;
}

/* With the motor off: clears data that are invalid when the rotor is at rest. */
static void rest(const wh_rig_config *config, wh_rig *rig, uint32_t now_ticks) {
    wh_guard_quiet(&config->guard, &rig->guard, rig->pulses_ever, now_ticks);
    if (rig->guard.quiet) {
        rig->run.off_radps = WH_R(0.0);
        if (rig->pulses.speed.running) { /* old pulses look recent after the timer wraps */
            wh_pulses_forget(&rig->pulses);
        }
    }
}

static void watch(const wh_rig_config *config, wh_rig *rig, const wh_rig_inputs *inputs) {
    wh_guard *guard = &rig->guard;
    const bool drives = wh_run_drives(&rig->run);
    if (inputs->watchdog_has_cut) {
        wh_guard_trip(guard, WH_TRIP_WATCHDOG);
    }
    if (!drives) {
        rest(config, rig, inputs->now_ticks);
    }
    const bool slows = !drives && rig->run.off_radps < config->guard.limit_radps;
    wh_guard_speed(&config->guard, guard, &rig->pulses,
                   !slows        ? WH_TRIP_OVERSPEED
                   : brakes(rig) ? WH_TRIP_UNBRAKED
                                 : WH_TRIP_RUNS_ON,
                   drives        ? 0U
                   : brakes(rig) ? WH_GUARD_BRAKES
                                 : WH_GUARD_COASTS);
    if (rig->run.phase == WH_PHASE_SPIN_UP && !rig->pulses.speed.running &&
        wh_rig_is_over(rig->run.since_ticks, inputs->now_ticks, config->guard.slow_silence_max_s)) {
        /* No pulses come: the rotor is stalled, or turns unseen and could become too fast. */
        wh_guard_trip(guard, WH_TRIP_STALLED);
    }
    if (drives) {
        wh_guard_pulses(&config->guard, guard, &rig->pulses, silence_s(config, rig),
                        inputs->now_ticks);
    }
    const bool needed = rig->state == WH_RIG_ARMED || rig->state == WH_RIG_RUNNING || drives;
    if (needed && !wh_guard_supply(&config->guard, inputs->supply_V)) {
        wh_guard_trip(guard, WH_TRIP_SUPPLY);
    }
    if (!wh_guard_load_comes(&config->guard, guard, inputs->now_ticks)) {
        guard->load_good = false; /* the last sample would look recent after the timer wraps */
        if (needed) {
            wh_guard_trip(guard, WH_TRIP_LOAD_CELL);
        }
    }
}

static void observe(const wh_rig_config *config, wh_rig *rig, uint32_t now_ticks) {
    /* A step that decides about a suspect has no time left for the observer. */
    if (rig->decides && now_ticks - rig->observer.ticks < 2U * rig->observer.step_ticks) {
        return;
    }
    const uint32_t before_ticks = rig->observer.ticks;
    wh_observer_step(&config->observer, &rig->observer, now_ticks,
                     rig->command.volts / config->run.rated_V);
    if (rig->observer.ticks - before_ticks > rig->observer.step_ticks) {
        rig->loads++; /* after two observer steps, measure() has less time */
    }
    if (!rig->busy && rig->pulses.speed.taken != rig->observed) {
        rig->busy = true;
        rig->observed = rig->pulses.speed.taken;
        wh_observer_pulse(&config->observer, &rig->observer, rig->pulses.last.pulse.sensor,
                          rig->pulses.last.pulse.ticks);
    }
}

static wh_real compensation_V(const wh_rig_config *config, wh_rig *rig, uint32_t now_ticks) {
    if (!rig->compensated || !wh_run_is_closed(&rig->run)) {
        rig->compensation.part = WH_R(0.0);
        return WH_R(0.0);
    }
    if (rig->measure.lockin.angle.compensated != (rig->compensation.part >= WH_R(1.0))) {
        wh_lockin_compensate(&rig->measure.lockin, rig->compensation.part >= WH_R(1.0),
                             config->compensation.stall_Nm / config->run.rated_V);
    }
    rig->measure.lockin.angle.drive_V = rig->run.volts;
    return config->run.rated_V * wh_compensation_step(&config->compensation, &rig->compensation,
                                                      &rig->observer, now_ticks,
                                                      config->run.step_s);
}

/* Waits, with the motor off, until no pulses come, which shows that the rotor is at rest. */
static void wait_for_rest(const wh_rig_config *config, wh_rig *rig, const wh_rig_inputs *inputs) {
    const bool tripped = rig->state == WH_RIG_TRIPPED;
    const wh_real passed_s =
        wh_rig_since_s(tripped ? rig->since_ticks : rig->run.since_ticks, inputs->now_ticks);
    const bool late = passed_s > (tripped ? config->tripped_max_s : config->rest_max_s);
    const bool blind = rig->guard.trip == WH_TRIP_PULSES || rig->guard.trip == WH_TRIP_STALLED ||
                       rig->guard.trip == WH_TRIP_ORDER;
    const bool silent = rig->guard.quiet && passed_s >= config->guard.rest_s;
    if (tripped) {
        if (silent && (!blind || passed_s > config->rest_max_s)) {
            rig->at_rest = true;
        }
        if (rig->at_rest || late) {
            rig->rested = true;
        }
    } else if (silent) {
        finds(config, rig, inputs, WH_EVENT_RESTED);
    } else if (late) {
        wh_guard_trip(&rig->guard, WH_TRIP_RUNS_ON);
    }
}

/* Maximum number of pulses from jitter while the rig is armed. If there are more, a person turns the rotor. */
#define ARMED_PULSES_MOST 2U

static void step_run(const wh_rig_config *config, wh_rig *rig, const wh_rig_inputs *inputs) {
    const bool armed = rig->state == WH_RIG_ARMED;
    if (armed && (wh_rig_is_over(rig->since_ticks, inputs->now_ticks, config->armed_max_s) ||
                  rig->pulses_ever - rig->pulses_before > ARMED_PULSES_MOST)) {
        finds(config, rig, inputs, WH_EVENT_EXPIRED);
    }
    if (rig->run.phase == WH_PHASE_OFF || rig->state == WH_RIG_TRIPPED) {
        wait_for_rest(config, rig, inputs);
    }
    const wh_run_scene scene = {.config = &config->run,
                                .measuring = &config->measure,
                                .guarding = &config->guard,
                                .guard = &rig->guard,
                                .pulses = &rig->pulses,
                                .measure = &rig->measure,
                                .supply_V = inputs->supply_V,
                                .compensated = rig->compensation.part >= WH_R(1.0),
                                .busy = rig->busy,
                                .now_ticks = inputs->now_ticks};
    if (wh_run_step(&rig->run, &scene)) {
        rig->result = rig->measure.result;
        rig->has_result = true;
        rig->settings = config->settings;
        rig->result_s = 0;
        rig->result_ticks = inputs->now_ticks;
        finds(config, rig, inputs, WH_EVENT_DONE);
    }
}

/* Returns the number of half nodes for which this step has time. Load samples leave less time. */
static unsigned halves(const wh_rig *rig) {
    if (WH_RIG_SMALL_PIECES) {
        return rig->loads == 0 ? WH_LOCKIN_HALVES_AT_ONCE : rig->loads == 1U ? 1U : 0U;
    }
    if (rig->loads != 1U) {
        return rig->loads == 0 ? WH_LOCKIN_HALVES_AT_ONCE + 1U : 1U;
    }
    return WH_LOCKIN_HALVES_AT_ONCE - (rig->compensated && rig->pulses.waits ? 1U : 0U);
}

/* A busy step takes a confirmed pulse only if more than this number are waiting. */
#define CONFIRMED_WAIT 1U

static void measure(const wh_rig_config *config, wh_rig *rig, uint32_t now_ticks) {
    wh_index_pulse index;
    if ((!rig->busy || rig->pulses.confirmed_count > CONFIRMED_WAIT) &&
        wh_pulses_confirmed(&rig->pulses, now_ticks, &index)) {
        wh_measure_pulse(&rig->measure, &index);
        rig->busy = true;
    }
    if (wh_run_drives(&rig->run) && !rig->busy) {
        wh_measure_work(&config->measure, &rig->measure, halves(rig));
    }
    rig->busy = false;
    rig->decides = false;
    rig->loads = 0;
}

static wh_rig_command command_of(const wh_rig_config *config, wh_rig *rig,
                                 const wh_rig_inputs *inputs) {
    if (rig->guard.trip == WH_TRIP_NONE && wh_run_drives(&rig->run)) {
        const wh_real volts = rig->run.volts + compensation_V(config, rig, inputs->now_ticks);
        const wh_real most = volts < inputs->supply_V ? volts : inputs->supply_V;
        return (wh_rig_command){WH_MOTOR_DRIVES, most > WH_R(0.0) ? most : WH_R(0.0)};
    }
    return (wh_rig_command){brakes(rig) ? WH_MOTOR_BRAKES : WH_MOTOR_COASTS, WH_R(0.0)};
}

static void follow_trip(const wh_rig_config *config, wh_rig *rig, const wh_rig_inputs *inputs) {
    if (rig->guard.trip != WH_TRIP_NONE && rig->state != WH_RIG_TRIPPED) {
        finds(config, rig, inputs, WH_EVENT_TRIP);
    }
}

/* Values that one part of a step sets and a later part reads:
 *
 *   set by                       value                           read by
 *   earlier wh_rig_pulse()       pulses, busy, decides           all parts
 *   earlier wh_rig_load()        loads, the measurement's load   measure()
 *   observe()                    observer, busy, loads           compensation_V(), measure()
 *   watch()                      guard.trip                      follow_trip(), command_of()
 *   step_run()                   run.phase, run.volts            measure(), command_of()
 *   compensation_V()             compensation.part               step_run() of the next step */
wh_rig_command wh_rig_step(const wh_rig_config *config, wh_rig *rig, const wh_rig_inputs *inputs) {
    if (rig->compensated && wh_run_is_closed(&rig->run)) {
        observe(config, rig, inputs->now_ticks);
    }
    watch(config, rig, inputs);
    if (inputs->stop_pressed) {
        finds(config, rig, inputs, WH_EVENT_STOP);
        rig->guard.off.released = true; /* the stop input releases the brake */
    }
    take_orders(config, rig, inputs);
    const wh_rig_phase phase = rig->run.phase;
    follow_trip(config, rig, inputs);
    step_run(config, rig, inputs);
    /* step_run() may have tripped */
    follow_trip(config, rig, inputs);
    if (rig->run.phase != phase) {
        rig->busy = true;
    }
    measure(config, rig, inputs->now_ticks);
    if (!wh_run_drives(&rig->run)) {
        if (inputs->now_ticks - rig->result_ticks >= WH_RIG_TICKS_PER_S) {
            rig->result_ticks += WH_RIG_TICKS_PER_S;
            rig->result_s++; /* seconds, because the timer wraps */
        }
        if (WH_RIG_SWINGS) { /* follows a free swing, or evaluates it if the rotor is at rest */
            const bool swings = config->swings && rig->run.phase == WH_PHASE_OFF && !rig->brakes;
            wh_swing_step(&config->swing, &config->measure.rotor, &rig->swing, swings,
                          rig->state == WH_RIG_IDLE);
            wh_swing_doubt(&config->swing, &rig->swing, &rig->result.force);
        }
    }
    rig->command = command_of(config, rig, inputs);
    return rig->command;
}

/* === read-out: stage, speed, age of the result =============================================== */

WH_CALLED unsigned wh_rig_stage(const wh_rig *rig) {
    return rig->run.phase == WH_PHASE_NONE ? (unsigned)rig->state
                                           : WH_RIG_STAGE_OF_PHASE + (unsigned)rig->run.phase;
}

WH_CALLED unsigned wh_rig_shown_stage(const wh_rig *rig) {
    return rig->command.way == WH_MOTOR_BRAKES && rig->run.phase == WH_PHASE_OFF
               ? WH_RIG_STAGE_BRAKES
               : wh_rig_stage(rig);
}

WH_CALLED const char *wh_rig_stage_text(unsigned stage) {
    return stage < WH_RIG_STAGE_OF_PHASE
               ? wh_rig_state_text((wh_rig_state)stage)
               : wh_phase_text((wh_rig_phase)(stage - WH_RIG_STAGE_OF_PHASE));
}

uint32_t wh_rig_result_age_s(const wh_rig *rig, uint32_t now_ticks) {
    return rig->result_s + (now_ticks - rig->result_ticks) / WH_RIG_TICKS_PER_S;
}

bool wh_rig_speed(const wh_rig *rig, uint32_t now_ticks, wh_real *speed_radps) {
    uint32_t way[3];
    unsigned last;
    const bool drives = wh_run_drives(&rig->run);
    *speed_radps = rig->pulses.speed.known ? rig->pulses.speed.turn_radps : WH_R(0.0);
    if (!drives && rig->guard.quiet) {
        return true;
    }
    /* speed.h mistakes a slow pass over the top for a gap. It then keeps an old speed, which is too high. */
    if (!drives && last_ways(rig, now_ticks, way, &last)) {
        *speed_radps = WH_RIG_TWO_PI * (wh_real)WH_RIG_TICKS_PER_S / (wh_real)(way[0] + way[1]);
        return true;
    }
    return rig->pulses.speed.known;
}

/* === a trip's record as bytes ================================================================ */

void wh_trip_record_put(const wh_trip_record *record, uint8_t *bytes) {
    wh_bytes out = {.to = bytes, .room = WH_TRIP_RECORD_BYTES};
    wh_bytes_put(&out, (uint32_t)record->trip, 1);
    wh_bytes_put(&out, (uint32_t)record->phase, 1);
    wh_bytes_put(&out, record->ticks, 4);
    wh_bytes_put_float(&out, (float)record->speed_radps);
    wh_bytes_put_float(&out, (float)record->volts);
    wh_bytes_put_float(&out, (float)record->supply_V);
}

bool wh_trip_record_get(wh_trip_record *record, const uint8_t *bytes, unsigned length) {
    wh_bytes in = {.from = bytes, .room = length};
    const uint32_t trip = wh_bytes_get(&in, 1);
    const uint32_t phase = wh_bytes_get(&in, 1);
#define IS(name, value, words) || trip == (value)
    const bool is_trip = trip != (uint32_t)WH_TRIP_NONE && (false WH_TRIP_ROWS(IS));
#undef IS
    if (length != WH_TRIP_RECORD_BYTES || !is_trip || phase >= (uint32_t)WH_PHASES) {
        return false;
    }
    record->trip = (wh_trip)trip;
    record->phase = (wh_rig_phase)phase;
    record->ticks = wh_bytes_get(&in, 4);
    record->speed_radps = (wh_real)wh_bytes_get_float(&in);
    record->volts = (wh_real)wh_bytes_get_float(&in);
    record->supply_V = (wh_real)wh_bytes_get_float(&in);
    return true;
}

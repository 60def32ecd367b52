/* observer.c: the rotor's angle and speed at any time, from a generated scene that runs beside the rig. */
#include "observer.h"

#include "datasheet.h"
#include "polar.h"

/* After this angle without a pulse, both sensors have missed one. */
#define MISSED_RAD (WH_R(1.06) * WH_RIG_TWO_PI)

const wh_observer_config wh_observer_standard = WH_OBSERVER_STANDARD;

static wh_real signed_rad(wh_phase difference) {
#if WH_DOUBLE
    const double turns = difference / WH_RIG_TWO_PI;
    const double whole = (double)(int64_t)(turns + (turns < 0.0 ? -0.5 : 0.5));
    return difference - whole * WH_RIG_TWO_PI;
#else
    return (wh_real)(int32_t)difference / WH_PHASE_PER_RAD;
#endif
}

static wh_real clamp(wh_real value, wh_real most) {
    return value < -most ? -most : value > most ? most : value;
}

WH_CALLED wh_status wh_observer_start(const wh_observer_config *config, wh_observer *observer,
                                      uint32_t now_ticks) {
    const wh_scene *scene = config->scene;
    *observer = (wh_observer){.status = WH_E_ARGUMENT, .ticks = now_ticks};
    if (scene == NULL || scene->form != WH_SECOND_ORDER || scene->angles != 1 ||
        scene->reals != 1 || scene->inputs != 1 || scene->contacts != 0 || scene->compensated ||
        scene->ledger != NULL) {
        return observer->status;
    }
    const wh_real ticks = scene->step_s * (wh_real)WH_RIG_TICKS_PER_S;
    if (ticks > WH_R(0.5) && ticks < WH_R(1e5)) {
        observer->step_ticks = (uint32_t)(ticks + WH_R(0.5));
        const wh_real off = ticks - (wh_real)observer->step_ticks;
        if (WH_ABS(off) < WH_R(0.01)) {
            observer->status =
                wh_scene_start(scene, &observer->state, observer->memory, sizeof observer->memory);
        }
    }
    return observer->status;
}

WH_CALLED void wh_observer_forget(wh_observer *observer) {
    observer->valid = false;
    observer->runs = false;
    observer->had_pulse = false;
    observer->good_pulses = 0;
    observer->torque_Nm = WH_R(0.0);
}

wh_real wh_observer_speed_radps(const wh_observer *observer) {
    return observer->status == WH_OK ? observer->state.real[0] : WH_R(0.0);
}

wh_real wh_observer_coasting(const wh_observer_config *config, const wh_observer *observer) {
    return wh_observer_speed_radps(observer) / config->no_load_radps;
}

void wh_observer_step(const wh_observer_config *config, wh_observer *observer, uint32_t now_ticks,
                      wh_real drive) {
    if (observer->status != WH_OK) {
        return;
    }
    if (observer->had_pulse && now_ticks - observer->pulse_ticks > config->silence_ticks) {
        wh_observer_forget(observer);
    }
    const uint32_t late_ticks = now_ticks - observer->ticks;
    if (!observer->runs || late_ticks >= WH_OBSERVER_STEPS_MOST * observer->step_ticks) {
        if (observer->runs) {
            wh_observer_forget(observer);
        }
        observer->ticks = now_ticks;
        return;
    }
    wh_state *state = &observer->state;
    wh_real voltage = drive;
    if (config->freewheels) {
        const wh_real coasting = wh_observer_coasting(config, observer);
        voltage = drive < coasting ? coasting : drive;
    }
    state->input[0] = config->per_drive * voltage + config->per_radps * state->real[0] +
                      observer->torque_Nm / config->stall_Nm;
    const uint32_t due = late_ticks / observer->step_ticks;
    const uint32_t steps = due < WH_OBSERVER_STEPS_AT_ONCE ? due : WH_OBSERVER_STEPS_AT_ONCE;
    const uint32_t way_ticks = steps * observer->step_ticks;
    const wh_real before_radps = state->real[0];
    wh_status status = WH_OK;
    for (uint32_t i = 0; i < steps && status == WH_OK; i++) { /* usually one step */
        status = wh_scene_step(config->scene, state);
    }
    if (status != WH_OK) { /* the drive is NaN */
        wh_observer_forget(observer);
        observer->ticks = now_ticks;
        return;
    }
    observer->ticks += way_ticks;
    observer->since_pulse_rad += WH_R(0.5) * (before_radps + state->real[0]) * (wh_real)way_ticks /
                                 (wh_real)WH_RIG_TICKS_PER_S;
    if (!(observer->since_pulse_rad <= MISSED_RAD) || !(state->real[0] > WH_R(0.0))) {
        observer->valid = false;
        observer->good_pulses = 0;
    }
}

wh_phase wh_observer_phase(const wh_observer *observer, uint32_t ticks) {
    if (observer->status != WH_OK) {
        return wh_phase_from_rad(WH_R(0.0));
    }
    wh_phase phase = wh_phase_of(observer->state.angle[0]);
    const wh_real way_rad = observer->state.real[0] * wh_rig_way_s(observer->ticks, ticks);
    (void)wh_phase_move(phase, way_rad * WH_PHASE_PER_RAD, &phase);
    return phase;
}

wh_real wh_observer_angle_rad(const wh_observer *observer, uint32_t ticks) {
    return signed_rad(wh_observer_phase(observer, ticks));
}

/* Starts the observer at this pulse, with the mean speed since the previous one. */
static void set_out(const wh_observer_config *config, wh_observer *observer, unsigned sensor,
                    uint32_t ticks) {
    const wh_real time_s = wh_rig_way_s(observer->pulse_ticks, ticks);
    wh_real turned_rad = signed_rad(wh_phase_from_rad(config->pulse_rad[sensor]) -
                                    wh_phase_from_rad(config->pulse_rad[observer->pulse_sensor]));
    if (!(turned_rad > WH_R(0.0))) { /* pulses of one sensor are a whole turn apart */
        turned_rad += WH_RIG_TWO_PI;
    }
    const wh_real speed_radps = turned_rad / time_s;
    observer->valid = false;
    observer->good_pulses = 0;
    observer->runs = time_s > WH_R(0.0) && speed_radps > config->slowest_radps &&
                     speed_radps < config->fastest_radps;
    if (observer->runs) {
        observer->state.angle[0] = wh_angle_from_rad(
            config->pulse_rad[sensor] + speed_radps * wh_rig_way_s(ticks, observer->ticks));
        observer->state.real[0] = speed_radps;
    }
}

static void correct(const wh_observer_config *config, wh_observer *observer, unsigned sensor) {
    wh_state *state = &observer->state;
    const wh_real off_rad = observer->innovation_rad;
    const wh_real faster =
        state->real[0] > config->slowest_radps ? state->real[0] : config->slowest_radps;
    const wh_real turns = faster / WH_RIG_TWO_PI;
    state->angle[0] += wh_angle_from_rad(config->angle_gain[sensor] * off_rad);
    state->real[0] += config->speed_gain[sensor] * off_rad * turns;
    observer->torque_Nm =
        clamp(observer->torque_Nm + config->torque_gain_kgm2[sensor] * off_rad * turns * turns,
              config->torque_most_Nm);
    if (!(WH_ABS(off_rad) <= config->trusted_rad)) {
        observer->good_pulses = 0;
    } else if (observer->good_pulses < config->trusted_pulses) {
        observer->good_pulses++;
    }
    observer->valid = observer->good_pulses >= config->trusted_pulses;
}

WH_CALLED void wh_observer_pulse(const wh_observer_config *config, wh_observer *observer,
                                 unsigned sensor, uint32_t ticks) {
    if (observer->status != WH_OK) {
        return;
    }
    if (observer->runs) {
        observer->innovation_rad = signed_rad(wh_phase_from_rad(config->pulse_rad[sensor]) -
                                              wh_observer_phase(observer, ticks));
    }
    if (observer->runs && WH_ABS(observer->innovation_rad) <= config->lost_rad) {
        correct(config, observer, sensor);
    } else if (observer->had_pulse) {
        set_out(config, observer, sensor, ticks);
    }
    observer->had_pulse = true;
    observer->pulse_ticks = ticks;
    observer->pulse_sensor = sensor;
    observer->since_pulse_rad =
        wh_observer_speed_radps(observer) * wh_rig_way_s(ticks, observer->ticks);
}

/* fed_rotor.c: the imitated rotor under a speed drive, with observer and gravity compensation. */
#include "fed_rotor.h"

#include "build/gen/scenes.h"
#include "core/angle.h"
#include "core/rig/datasheet.h"
#include "core/rig/polar.h"
#include "core/rig/rig.h"
#include "core/root.h"

#define RPM WH_RIG_RADPS_PER_RPM

void fed_rotor_standard(fed_rotor *fed, uint64_t seed) {
    *fed = (fed_rotor){.kind = rotor_nominal(),
                       .observing = wh_observer_standard,
                       .feeding = wh_compensation_standard,
                       .driving = wh_rig_standard.run.drive};
    fed->observing.scene = &rig_fixed;
    for (unsigned i = 0; i < 2; i++) {
        fed->observing.pulse_rad[i] = fed->kind.pulse_rad[i];
    }
    fed->rotor.seed = seed;
    fed->rotor.ticks = UINT32_MAX - UINT32_C(2500000); /* the timer wraps during the run */
}

static wh_real voltage_of(const rotor_kind *kind, wh_real speed_radps) {
    return (kind->drag_Nms * speed_radps + kind->friction_Nm) / kind->stall_Nm +
           speed_radps / kind->no_load_radps;
}

void fed_rotor_hold(fed_rotor *fed, wh_real speed_rpm) {
    fed->driving.proportional_V_per_radps = fed->driving.integral_V_per_rad = WH_R(0.0);
    wh_drive_start(&fed->drive, speed_rpm * RPM,
                   WH_RIG_RATED_V * voltage_of(&fed->kind, speed_rpm * RPM));
}

wh_status fed_rotor_start(fed_rotor *fed, wh_real speed_rpm) {
    const wh_real speed = speed_rpm * RPM;
    fed->rotor.speed_radps = speed;
    fed->rotor.angle_rad = WH_R(3.0);
    fed->voltage = voltage_of(&fed->kind, speed);
    wh_speed_start(&fed->speed, WH_RIG_IMPOSSIBLE_RADPS);
    wh_drive_start(&fed->drive, speed, WH_RIG_RATED_V * fed->voltage);
    fed_rotor_count(fed);
    return wh_observer_start(&fed->observing, &fed->observer, fed->rotor.ticks);
}

static wh_real sine_of(wh_real rad) { return wh_wave_of(rad).sine; }

static void take_marks(fed_rotor *fed) {
    const rotor_state *truth = &fed->rotor;
    for (unsigned i = 0; i < truth->marks; i++) {
        if (fed->lose_marks > 0) {
            fed->lose_marks--;
            continue;
        }
        wh_speed_pulse(&fed->speed, truth->mark_sensor[i], truth->mark_ticks[i]);
        wh_observer_pulse(&fed->observing, &fed->observer, truth->mark_sensor[i],
                          truth->mark_ticks[i]);
    }
}

static void count(fed_rotor *fed) {
    const wh_real speed = fed->rotor.speed_radps;
    fed->least_radps = fed->steps == 0 || speed < fed->least_radps ? speed : fed->least_radps;
    fed->most_radps = fed->steps == 0 || speed > fed->most_radps ? speed : fed->most_radps;
    fed->sum_radps += speed;
    fed->stood = fed->stood || speed < WH_R(10.0) * RPM;
    fed->steps++;
    if (fed->observer.valid) {
        const wh_real seen = wh_observer_angle_rad(&fed->observer, fed->rotor.ticks);
        const wh_real off = WH_ABS(rotor_ahead_rad(&fed->rotor, seen));
        fed->worst_rad = off > fed->worst_rad ? off : fed->worst_rad;
        fed->square_rad2 += off * off;
        fed->lies += off > FED_LIE_RAD ? 1U : 0U;
        fed->valid++;
    }
}

/* Does a control step. The voltage that a step computes acts in the next one. */
static void control(fed_rotor *fed) {
    const uint32_t now = fed->rotor.ticks;
    const wh_real speed = fed->speed.known ? fed->speed.turn_radps : fed->drive.setpoint_radps;
    wh_real voltage = wh_drive_step(&fed->driving, &fed->drive, speed, WH_RIG_RATED_V, FED_STEP_S) /
                      WH_RIG_RATED_V;
    const wh_real fed_in =
        wh_compensation_step(&fed->feeding, &fed->compensation, &fed->observer, now, FED_STEP_S);
    if (fed->by == FED_BY_OBSERVER) {
        voltage += fed_in;
    } else if (fed->by == FED_BY_TRUTH) {
        const wh_compensation_config *feeding = &fed->feeding;
        const wh_real at = fed->rotor.angle_rad + WH_R(1.5) * FED_STEP_S * fed->rotor.speed_radps;
        voltage += feeding->weight_Nm / feeding->stall_Nm * sine_of(at);
    }
    voltage = voltage < WH_R(0.0) ? WH_R(0.0) : voltage > WH_R(1.0) ? WH_R(1.0) : voltage;
    rotor_turn(&fed->kind, &fed->rotor, fed->voltage, FED_STEP_TICKS);
    wh_observer_step(&fed->observing, &fed->observer, fed->rotor.ticks, fed->voltage);
    take_marks(fed);
    count(fed);
    fed->voltage = voltage;
}

void fed_rotor_run(fed_rotor *fed, wh_real target_rpm, wh_real time_s) {
    fed->drive.target_radps = target_rpm * RPM;
    for (uint32_t left = (uint32_t)(time_s / FED_STEP_S + WH_R(0.5)); left > 0; left--) {
        control(fed);
    }
}

void fed_rotor_count(fed_rotor *fed) {
    fed->steps = fed->valid = fed->lies = 0;
    fed->worst_rad = fed->square_rad2 = fed->sum_radps = WH_R(0.0);
    fed->stood = false;
}

wh_real fed_rotor_rms_rad(const fed_rotor *fed) {
    return fed->valid > 0 ? WH_SQRT(fed->square_rad2 / (wh_real)fed->valid) : WH_R(9.0);
}

wh_real fed_rotor_ripple(const fed_rotor *fed) {
    return WH_R(0.5) * (fed->most_radps - fed->least_radps) * (wh_real)fed->steps / fed->sum_radps;
}

wh_real fed_rotor_mean_rpm(const fed_rotor *fed) {
    return fed->sum_radps / (wh_real)fed->steps / RPM;
}

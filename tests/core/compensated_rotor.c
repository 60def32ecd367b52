/* compensated_rotor.c: the imitated rotor under a speed drive, with observer and gravity compensation. */
#include "compensated_rotor.h"

#include "build/gen/scenes.h"
#include "core/angle.h"
#include "core/rig/datasheet.h"
#include "core/rig/polar.h"
#include "core/rig/rig.h"
#include "core/root.h"

#define RPM WH_RIG_RADPS_PER_RPM

void compensated_rotor_standard(compensated_rotor *compensated, uint64_t seed) {
    *compensated = (compensated_rotor){.kind = rotor_nominal(),
                                       .observing = wh_observer_standard,
                                       .feeding = wh_compensation_standard,
                                       .driving = wh_rig_standard.run.drive};
    compensated->observing.scene = &rig_fixed;
    for (unsigned i = 0; i < 2; i++) {
        compensated->observing.pulse_rad[i] = compensated->kind.pulse_rad[i];
    }
    compensated->rotor.seed = seed;
    compensated->rotor.ticks = UINT32_MAX - UINT32_C(2500000); /* the timer wraps during the run */
}

static wh_real voltage_of(const rotor_kind *kind, wh_real speed_radps) {
    return (kind->drag_Nms * speed_radps + kind->friction_Nm) / kind->stall_Nm +
           speed_radps / kind->no_load_radps;
}

void compensated_rotor_hold(compensated_rotor *compensated, wh_real speed_rpm) {
    compensated->driving.proportional_V_per_radps = compensated->driving.integral_V_per_rad =
        WH_R(0.0);
    wh_drive_start(&compensated->drive, speed_rpm * RPM,
                   WH_RIG_RATED_V * voltage_of(&compensated->kind, speed_rpm * RPM));
}

wh_status compensated_rotor_start(compensated_rotor *compensated, wh_real speed_rpm) {
    const wh_real speed = speed_rpm * RPM;
    compensated->rotor.speed_radps = speed;
    compensated->rotor.angle_rad = WH_R(3.0);
    compensated->voltage = voltage_of(&compensated->kind, speed);
    wh_speed_start(&compensated->speed, WH_RIG_IMPOSSIBLE_RADPS);
    wh_drive_start(&compensated->drive, speed, WH_RIG_RATED_V * compensated->voltage);
    compensated_rotor_count(compensated);
    return wh_observer_start(&compensated->observing, &compensated->observer,
                             compensated->rotor.ticks);
}

static wh_real sine_of(wh_real rad) { return wh_wave_of(rad).sine; }

static void take_pulses(compensated_rotor *compensated) {
    const rotor_state *truth = &compensated->rotor;
    for (unsigned i = 0; i < truth->pulses; i++) {
        if (compensated->lose_pulses > 0) {
            compensated->lose_pulses--;
            continue;
        }
        wh_speed_pulse(&compensated->speed, truth->pulse_sensor[i], truth->pulse_ticks[i]);
        wh_observer_pulse(&compensated->observing, &compensated->observer, truth->pulse_sensor[i],
                          truth->pulse_ticks[i]);
    }
}

static void count(compensated_rotor *compensated) {
    const wh_real speed = compensated->rotor.speed_radps;
    compensated->least_radps = compensated->steps == 0 || speed < compensated->least_radps
                                   ? speed
                                   : compensated->least_radps;
    compensated->most_radps = compensated->steps == 0 || speed > compensated->most_radps
                                  ? speed
                                  : compensated->most_radps;
    compensated->sum_radps += speed;
    compensated->stood = compensated->stood || speed < WH_R(10.0) * RPM;
    compensated->steps++;
    if (compensated->observer.valid) {
        const wh_real seen =
            wh_observer_angle_rad(&compensated->observer, compensated->rotor.ticks);
        const wh_real off = WH_ABS(rotor_ahead_rad(&compensated->rotor, seen));
        compensated->worst_rad = off > compensated->worst_rad ? off : compensated->worst_rad;
        compensated->square_rad2 += off * off;
        compensated->lies += off > FED_LIE_RAD ? 1U : 0U;
        compensated->valid++;
    }
}

/* Does a control step. The voltage that a step computes acts in the next one. */
static void control(compensated_rotor *compensated) {
    const uint32_t now = compensated->rotor.ticks;
    const wh_real speed = compensated->speed.known ? compensated->speed.turn_radps
                                                   : compensated->drive.setpoint_radps;
    wh_real voltage = wh_drive_step(&compensated->driving, &compensated->drive, speed,
                                    WH_RIG_RATED_V, FED_STEP_S) /
                      WH_RIG_RATED_V;
    const wh_real fed_in = wh_compensation_step(&compensated->feeding, &compensated->compensation,
                                                &compensated->observer, now, FED_STEP_S);
    if (compensated->by == FED_BY_OBSERVER) {
        voltage += fed_in;
    } else if (compensated->by == FED_BY_TRUTH) {
        const wh_compensation_config *feeding = &compensated->feeding;
        const wh_real at =
            compensated->rotor.angle_rad + WH_R(1.5) * FED_STEP_S * compensated->rotor.speed_radps;
        voltage += feeding->weight_Nm / feeding->stall_Nm * sine_of(at);
    }
    voltage = voltage < WH_R(0.0) ? WH_R(0.0) : voltage > WH_R(1.0) ? WH_R(1.0) : voltage;
    rotor_turn(&compensated->kind, &compensated->rotor, compensated->voltage, FED_STEP_TICKS);
    wh_observer_step(&compensated->observing, &compensated->observer, compensated->rotor.ticks,
                     compensated->voltage);
    take_pulses(compensated);
    count(compensated);
    compensated->voltage = voltage;
}

void compensated_rotor_run(compensated_rotor *compensated, wh_real target_rpm, wh_real time_s) {
    compensated->drive.target_radps = target_rpm * RPM;
    for (uint32_t left = (uint32_t)(time_s / FED_STEP_S + WH_R(0.5)); left > 0; left--) {
        control(compensated);
    }
}

void compensated_rotor_count(compensated_rotor *compensated) {
    compensated->steps = compensated->valid = compensated->lies = 0;
    compensated->worst_rad = compensated->square_rad2 = compensated->sum_radps = WH_R(0.0);
    compensated->stood = false;
}

wh_real fed_rotor_rms_rad(const compensated_rotor *compensated) {
    return compensated->valid > 0 ? WH_SQRT(compensated->square_rad2 / (wh_real)compensated->valid)
                                  : WH_R(9.0);
}

wh_real compensated_rotor_ripple(const compensated_rotor *compensated) {
    return WH_R(0.5) * (compensated->most_radps - compensated->least_radps) *
           (wh_real)compensated->steps / compensated->sum_radps;
}

wh_real fed_rotor_mean_rpm(const compensated_rotor *compensated) {
    return compensated->sum_radps / (wh_real)compensated->steps / RPM;
}

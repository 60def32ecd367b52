/* rig_report.h: the report of a run. */
#ifndef PROGRAMS_RIG_REPORT_H
#define PROGRAMS_RIG_REPORT_H

#include "core/rig/datasheet.h"
#include "core/rig/rig.h"
#include "core/text.h"
#include "hal/console.h"

#define RPM_PER_RADPS (1.0f / WH_RIG_RADPS_PER_RPM)

static inline void put(const char *words) {
    char bytes[96];
    wh_text text;
    wh_text_start(&text, bytes, sizeof bytes);
    wh_text_add(&text, words);
    hal_console_write(text.bytes, text.length);
}

/* Prints a line "name value unit". */
static inline void put_value(const char *name, float value, unsigned decimals, const char *unit) {
    char bytes[96];
    wh_text text;
    wh_text_start(&text, bytes, sizeof bytes);
    wh_text_add(&text, "  ");
    wh_text_add(&text, name);
    while (text.length < 32U) {
        wh_text_add_char(&text, ' ');
    }
    wh_text_add_fixed(&text, value, decimals);
    if (unit[0] != '\0') {
        wh_text_add_char(&text, ' ');
        wh_text_add(&text, unit);
    }
    wh_text_add_char(&text, '\n');
    hal_console_write(text.bytes, text.length);
}

/* Prints a line with a force in newtons and in pounds-force. */
static inline void put_force(const char *name, float force_N) {
    char bytes[96];
    wh_text text;
    wh_text_start(&text, bytes, sizeof bytes);
    wh_text_add(&text, "N (");
    wh_text_add_fixed(&text, force_N * WH_RIG_LBF_PER_N, 2);
    wh_text_add(&text, " lbf)");
    put_value(name, force_N, 2, text.bytes);
}

/* Prints the half-width of the interval around the value of the previous line. */
static inline void put_interval(const char *name, float half, unsigned decimals, const char *unit) {
    char bytes[32];
    wh_text text;
    wh_text_start(&text, bytes, sizeof bytes);
    wh_text_add(&text, unit);
    wh_text_add(&text, ", either way");
    put_value(name, half, decimals, text.bytes);
}

static inline void put_verdict(const wh_measured *force) {
    put("  verdict                       ");
    put(wh_quality_text(force->quality));
    put(": ");
    put(wh_why_text(force->why));
    put("\n");
    if (!force->calibrated) {
        put("  uncalibrated: 0.5 % and 0.5 deg are assumed (amplitude_floor, phase_floor)\n");
    }
}

static inline void put_turns(const wh_run *run) {
    if (run->turns < WH_RUN_TURNS) {
        return;
    }
    float least = run->turn_radps[0];
    float most = least;
    for (unsigned i = 1; i < WH_RUN_TURNS; i++) {
        least = run->turn_radps[i] < least ? run->turn_radps[i] : least;
        most = run->turn_radps[i] > most ? run->turn_radps[i] : most;
    }
    put_value("mean of the last four turns", run->mean_radps * RPM_PER_RADPS, 2, "rpm");
    put_value("  fastest minus slowest turn", (most - least) * RPM_PER_RADPS, 2, "rpm");
}

static inline void put_result(const wh_rig_config *config, const wh_rig_result *result,
                              float nominal_radps) {
    const float formula_N = config->measure.rotor.unbalance_kgm * nominal_radps * nominal_radps;
    const wh_measured *force = &result->force;
    put("Measured, over the whole turns of a record at 500 samples/s\n");
    put_value("turns", (float)force->turns, 0, "");
    put_value("speed", force->speed_radps * RPM_PER_RADPS, 2, "rpm");
    put_value("  turns scatter by", force->scatter_radps * RPM_PER_RADPS, 3, "rpm");
    put_force("force, once per turn", force->amplitude_N);
    put_interval("  known to within", force->amplitude_half_N, 3, "N");
    put_value("phase, force to masses", force->phase_rad * WH_RIG_DEG_PER_RAD, 2, "deg");
    put_interval("  known to within", force->phase_half_rad * WH_RIG_DEG_PER_RAD, 3, "deg");
    put_verdict(force);
    put_force("expected from masses, speed", force->expected_N);
    put_value("residual of the load, rms", force->residual_N, 3, "N");
    put_value("  repeats each turn", force->repeats_N, 3, "N");
    put_value("  largest expected from noise", force->repeats_limit_N, 3, "N");
    put_value("samples left out", (float)force->outliers, 0, "");
    put_value("turns left out", (float)force->left_out, 0, "");
    put_force("mean force", force->mean_N);
    put_force("lowest peak", result->low_N);
    put_force("highest peak", result->high_N);
    put_force("load at pulses of sensor 1", force->at_pulse_N[0]);
    put_force("load at pulses of sensor 2", force->at_pulse_N[1]);
    put_force("tare subtracted", result->tare_N);
    put_value("motor voltage", result->volts, 2, "V");
    put_value("slot pulses lost", (float)result->lost, 0, "");
    put_value("slot pulses rejected", (float)result->rejected, 0, "");
    put("Formula, sum of m r w^2 at the nominal speed\n");
    put_value("speed", nominal_radps * RPM_PER_RADPS, 2, "rpm");
    put_force("force", formula_N);
    put_value("phase", 0.0f, 2, "deg");
    put_value("measured / formula", 100.0f * force->amplitude_N / formula_N, 2, "%");
}

static inline void put_place(const char *name, const wh_swung *swung, unsigned sensor) {
    put_value(name, swung->place_rad[sensor] * WH_RIG_DEG_PER_RAD, 2, "deg off");
    put_interval("  known to within", swung->half_rad[sensor] * WH_RIG_DEG_PER_RAD, 2, "deg");
}

static inline void put_swung(const wh_swung *swung) {
    if (swung->why == WH_SWING_NONE) {
        return;
    }
    put("Free swing at the end of the run: ");
    put(wh_swing_text(swung->why));
    put("\n");
    if (swung->why == WH_SWING_FOUND) {
        put_place("sensor 1 stands", swung, 0);
        put_place("sensor 2 stands", swung, 1);
    }
}

static inline void put_carriage(const wh_rig_config *config, const wh_carriage *carriage,
                                float displacement_m) {
    const float part = config->measure.result.mount_factor;
    const float lever_m = config->measure.rotor.unbalance_kgm / WH_RIG_ECCENTRIC_KG;
    put("On a carriage the force of a fixed mount is multiplied by 1/(1 + ratio)\n");
    put_value("eccentric / carriage weight", carriage->ratio, 4, "");
    put_value("radius of the discs", 1e3f * carriage->disc_m, 1, "mm");
    put_value("1/(1 + ratio)", 100.0f * part, 2, "%");
    put_value("amplitude of the carriage", 1e3f * displacement_m, 3, "mm");
    put_value("formula S/(M + m)", 1e3f * lever_m * (1.0f - part), 3, "mm");
}

#endif

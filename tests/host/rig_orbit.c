/* rig_orbit.c: one turn of the eccentric-mass rig in fine steps, and synthetic measurements of this turn. */
#include "rig_orbit.h"

#include <math.h>

#include "core/rig/rig.h"
#include "hal/averaged.h"
#include "hal/loadcell.h"
#include "hal/slots.h"
#include "tests/scattered.h"

#define PI 3.14159265358979323846

const rig_plant rig_plant_nominal = {
    /* two arms of 0.152 lb, 7.25 in long, each with a disc of 0.15 lb at 6.5 in; motor and shafts have 5e-4 kg m^2 */
    .unbalance_kgm = 2.0 * (0.152 * 3.625 + 0.15 * 6.5) * 0.45359237 * 0.0254,
    .inertia_kgm2 =
        2.0 * (0.152 * 7.25 * 7.25 / 3.0 + 0.15 * 6.5 * 6.5) * 0.45359237 * 0.0254 * 0.0254 + 5e-4,
    .drag_Nms = 0.001,
    .line_Nms = 1.5 / (600.0 * 2.0 * PI / 60.0),
    .gravity_mps2 = 9.80665,
    .tare_N = (12.0 + 2.0 * (0.152 + 0.15)) * 0.45359237 * 9.80665,
};

/* --- one turn: dw/dtheta = torque/(I w), dt/dtheta = 1/w, with the angle theta and the speed w --- */

static double acceleration(const rig_plant *p, double drive_Nm, double theta, double w) {
    const double given_Nm = fmax(0.0, drive_Nm + p->fed_Nm * sin(theta - p->fed_late_rad));
    return (given_Nm - (p->line_Nms + p->drag_Nms) * w -
            p->unbalance_kgm * p->gravity_mps2 * sin(theta) +
            p->twice_Nm * cos(2.0 * theta + p->twice_rad)) /
           p->inertia_kgm2;
}

static double bend(const rig_plant *p, double drive_Nm, double theta, double w) {
    return acceleration(p, drive_Nm, theta, w) / w;
}

#define STEPS 1024U
static double speed_at[2U * STEPS + 1U]; /* the speed at each half step of the angle */
static double time_at[STEPS + 1U];

/* Integrates a turn that begins at angle `from` with the speed w. Returns the speed at its end. Fills time_at and
 * speed_at. */
static double turn(const rig_plant *p, double drive_Nm, double from, double w) {
    const double h = 2.0 * PI / STEPS;
    time_at[0] = 0.0;
    speed_at[0] = w;
    for (unsigned i = 0; i < STEPS; i++) {
        const double a = from + h * i;
        const double k1 = bend(p, drive_Nm, a, w);
        const double k2 = bend(p, drive_Nm, a + h / 2.0, w + h / 2.0 * k1);
        const double k3 = bend(p, drive_Nm, a + h / 2.0, w + h / 2.0 * k2);
        const double k4 = bend(p, drive_Nm, a + h, w + h * k3);
        const double next = w + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
        /* the middle of a cubic Hermite interpolation */
        const double middle = (w + next) / 2.0 + h / 8.0 * (k1 - bend(p, drive_Nm, a + h, next));
        time_at[i + 1U] = time_at[i] + h / 6.0 * (1.0 / w + 4.0 / middle + 1.0 / next);
        speed_at[2U * i + 1U] = middle;
        speed_at[2U * i + 2U] = next;
        w = next;
    }
    return w;
}

/* Finds the speed w with which a turn under this torque ends as fast as it began, by the secant method. */
static double periodic(const rig_plant *p, double drive_Nm, double from) {
    double w = drive_Nm / (p->line_Nms + p->drag_Nms);
    for (unsigned round = 0; round < 60; round++) {
        const double off = turn(p, drive_Nm, from, w) - w;
        const double slope =
            (turn(p, drive_Nm, from, w * (1.0 + 1e-6)) - w * (1.0 + 1e-6) - off) / (w * 1e-6);
        w -= off / slope;
        if (fabs(off) < 1e-13 * w) {
            break;
        }
    }
    turn(p, drive_Nm, from, w);
    return time_at[STEPS];
}

static double force(const rig_plant *p, double drive_Nm, double theta, double w) {
    return p->unbalance_kgm *
           (w * w * cos(theta) + acceleration(p, drive_Nm, theta, w) * sin(theta));
}

/* The number of the step that contains the time `t` of the turn. */
static unsigned step_of(double t) {
    unsigned low = 0;
    unsigned high = STEPS;
    while (high - low > 1U) {
        const unsigned middle = (low + high) / 2U;
        if (time_at[middle] <= t) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

void rig_orbit_find(const rig_plant *plant, double speed_rpm, double lead_rad, rig_orbit *orbit) {
    const double from = -lead_rad;
    const double wanted_s = 60.0 / speed_rpm;
    double drive_Nm = (plant->line_Nms + plant->drag_Nms) * 2.0 * PI / wanted_s;
    for (unsigned round = 0; round < 60; round++) {
        const double off = periodic(plant, drive_Nm, from) - wanted_s;
        const double more = drive_Nm * (1.0 + 1e-5);
        const double slope = (periodic(plant, more, from) - wanted_s - off) / (drive_Nm * 1e-5);
        if (fabs(off) < 1e-11) {
            break;
        }
        drive_Nm -= off / slope;
    }
    orbit->turn_s = periodic(plant, drive_Nm, from);
    orbit->tare_N = plant->tare_N;
    orbit->drive_Nm = drive_Nm;
    orbit->compensated = plant->fed_Nm > 0.0;
    const double h = 2.0 * PI / STEPS;
    orbit->split = time_at[STEPS / 4U] / orbit->turn_s;
    orbit->in_phase_N = 0.0;
    orbit->quadrature_N = 0.0;
    double least = speed_at[0];
    double most = speed_at[0];
    for (unsigned i = 0; i < STEPS; i++) {
        /* this sum gives the integral exactly, because the integrand is smooth and periodic */
        const double theta = from + h * i;
        const double w = speed_at[2U * i];
        const double f = force(plant, drive_Nm, theta, w);
        orbit->in_phase_N += h / PI * f * cos(theta);
        orbit->quadrature_N += h / PI * f * sin(theta);
        least = fmin(least, w);
        most = fmax(most, w);
    }
    orbit->swing = (most - least) / 2.0 * orbit->turn_s / (2.0 * PI);
    orbit->amplitude_N = hypot(orbit->in_phase_N, orbit->quadrature_N);
    orbit->phase_rad = atan2(-orbit->quadrature_N, orbit->in_phase_N);
    orbit->node_s = orbit->turn_s / ORBIT_NODES;
    for (unsigned k = 0; k <= ORBIT_NODES; k++) {
        const double t = fmin(k * orbit->node_s, time_at[STEPS]);
        const unsigned i = step_of(t);
        /* the angle within the step follows from the speeds at both ends */
        double part = (t - time_at[i]) / (time_at[i + 1U] - time_at[i]);
        const double w0 = speed_at[2U * i];
        const double w1 = speed_at[2U * i + 2U];
        part = part + part * (1.0 - part) * (w0 - w1) / (w0 + w1);
        const double w = w0 + part * (w1 - w0);
        orbit->force_N[k] = force(plant, drive_Nm, from + h * (i + part), w);
    }
}

static double uniform(void) { return ((double)(scattered() >> 11) + 0.5) * 0x1p-53; }

/* A normal random number (Box and Muller, Annals of Mathematical Statistics 29 (1958) 610). */
static double normal(void) { return sqrt(-2.0 * log(uniform())) * cos(2.0 * PI * uniform()); }

void rig_measure_config(wh_result_config *result, wh_rotor_config *rotor, wh_cell_config *cell) {
    *result = wh_rig_standard.measure.result;
    result->amplitude_floor = WH_R(1e-4);
    result->phase_floor_rad = (wh_real)(0.01 * PI / 180.0);
    *rotor = wh_rig_standard.measure.rotor;
    rotor->pulse_rad[0] = (wh_real)(-(double)HAL_SLOT_LEAD_DEG * PI / 180.0);
    rotor->pulse_rad[1] = (wh_real)((90.0 - (double)HAL_SLOT_LEAD_DEG) * PI / 180.0);
    *cell = (wh_cell_config){.newton_per_count = HAL_LOADCELL_N_PER_COUNT,
                             .period_ticks = HAL_LOADCELL_PERIOD_TICKS,
                             .raw_max = HAL_LOADCELL_RAW_MAX};
}

static double force_at(const rig_orbit *orbit, double t_s) {
    const double at = t_s / orbit->node_s;
    const double whole = floor(at);
    const unsigned k = (unsigned)fmod(whole, ORBIT_NODES);
    return orbit->force_N[k] + (at - whole) * (orbit->force_N[k + 1U] - orbit->force_N[k]);
}

/* The force that a cell with clipping, a curved characteristic, hysteresis or a gain error shows. *follows_N is the
 * state of the hysteresis. */
static double shown_at(const rig_orbit *orbit, const rig_noise *noise, double t_s,
                       double *follows_N) {
    double least_N = 0.0;
    double most_N = 0.0;
    for (unsigned k = 0; k < ORBIT_NODES; k += 8U) {
        least_N = fmin(least_N, orbit->force_N[k]);
        most_N = fmax(most_N, orbit->force_N[k]);
    }
    const double peak_N = fmax(most_N, -least_N);
    double force_N = force_at(orbit, t_s);
    if (noise->clips > 0.0) {
        force_N = fmin(force_N, noise->clips * most_N);
    } else if (noise->clips < 0.0) {
        force_N = fmax(force_N, -noise->clips * least_N);
    }
    force_N *= 1.0 - noise->bend * (force_N / peak_N) * (force_N / peak_N);
    *follows_N = fmin(fmax(*follows_N, force_N - noise->play_N), force_N + noise->play_N);
    return (1.0 + noise->gain_off) * *follows_N;
}

/* Mean of the coarse converter's readings within 1 ms of t_s, in counts of the load cell. */
static int32_t mean_at(const rig_orbit *orbit, const rig_noise *noise, double t_s,
                       double on_top_N) {
    double sum = 0.0;
    for (unsigned i = 0; i < noise->conversions; i++) {
        const double at_s = t_s + 0.002 * (((double)i + 0.5) / noise->conversions - 0.5);
        const double force_N = noise->mute ? 0.0 : (1.0 + noise->gain_off) * force_at(orbit, at_s);
        sum +=
            round((force_N + on_top_N) / noise->conversion_N + noise->conversion_counts * normal());
    }
    const double mean_N = noise->conversion_N * sum / noise->conversions;
    return (int32_t)lround(mean_N / (double)HAL_LOADCELL_N_PER_COUNT);
}

void rig_measure(const rig_orbit *orbit, const rig_noise *noise, const wh_rotor_config *rotor,
                 unsigned before, unsigned turns, uint64_t scattered_seed, wh_measured *measured) {
    static wh_lockin lockin;
    wh_result_config judged;
    wh_rotor_config unused;
    wh_cell_config cell;
    rig_measure_config(&judged, &unused, &cell);
    cell.period_ticks *= noise->slower > 0 ? noise->slower : 1U;
    const double period_s = cell.period_ticks * 1e-6;
    scattered_state = scattered_seed * UINT64_C(0x9e3779b97f4a7c15) + 1U;
    for (unsigned i = 0; i < 16; i++) {
        scattered();
    }
    lockin = (wh_lockin){0};
    wh_lockin_forget(rotor, &lockin);
    wh_lockin_compensate(&lockin, orbit->compensated, WH_R(0.0625));
    lockin.angle.drive_V = (wh_real)(orbit->drive_Nm / 0.0625);
    wh_merge merge = {0};
    const uint32_t begin = UINT32_MAX - 1500000U; /* the timer wraps during the measurement */
    const double first_mark_s = uniform() * period_s + 0.001;
    unsigned marks = 0;
    double due_s = first_mark_s + noise->jitter_s * normal();
    unsigned done = 0;
    double shown_N = orbit->tare_N;
    double follows_N = 0.0;
    int32_t mean[3] = {0};
    for (uint32_t i = 1; merge.turns + merge.left_out < turns && done < before + turns; i++) {
        const double now_s = i * period_s;
        /* the conversion to uint32_t drops fractions of a tick, as a timer does */
        while (due_s <= now_s) {
            wh_lockin_pulse(&lockin, marks % 2U, begin + (uint32_t)(due_s * 1e6),
                            marks / 2U * 4U + marks % 2U);
            marks++;
            const unsigned whole = marks / 2U;
            due_s = first_mark_s +
                    ((double)whole + (double)(marks % 2U) * orbit->split) * orbit->turn_s +
                    noise->jitter_s * normal();
        }
        const double t_s = now_s - first_mark_s + (1.0 + noise->turned_by) * orbit->turn_s;
        const double on_top_N =
            orbit->tare_N + noise->cell_N * normal() +
            noise->hum_N * sin(2.0 * PI * (noise->hum_Hz > 0.0 ? noise->hum_Hz : 60.0) * now_s);
        double force_N = on_top_N + (noise->mute ? 0.0 : shown_at(orbit, noise, t_s, &follows_N));
        if (noise->spikes > 0.0 && uniform() < noise->spikes) {
            force_N += noise->spike_N;
        }
        const double frozen_from_s = (before + 0.43 * turns) * orbit->turn_s;
        if (now_s < frozen_from_s || now_s > frozen_from_s + noise->frozen_s) {
            shown_N = force_N;
        }
        int32_t raw = (int32_t)lround(shown_N / (double)HAL_LOADCELL_N_PER_COUNT);
        uint32_t stamp = begin + i * cell.period_ticks;
        if (noise->conversions > 0) {
            mean[0] = mean[1];
            mean[1] = mean[2];
            mean[2] = mean_at(orbit, noise, t_s, on_top_N);
            raw = hal_averaged_middle(mean[0], mean[1], mean[2]);
            stamp -= cell.period_ticks;
        }
        const wh_load load = wh_cell_load(&cell, stamp, raw, WH_LOAD_OK);
        wh_lockin_load(&lockin, &load);
        if (wh_lockin_work(rotor, &cell, &lockin, WH_LOCKIN_HALVES_AT_ONCE) && ++done > before) {
            wh_merge_add(&judged, rotor, &merge, &lockin.turn, &lockin.angle);
            if (lockin.turn.fault == WH_TURN_OK) {
                wh_repeats_merge(&merge.repeats, &lockin.repeats, lockin.turn.samples);
            }
        }
    }
    for (unsigned k = WH_REPEATS_FIRST; k <= WH_REPEATS_LAST; k++) {
        wh_merge_harmonic(&merge, k);
    }
    for (unsigned i = 0; i < WH_MERGE_MEAN_PIECES; i++) {
        wh_merge_mean_piece(&judged, rotor, &merge, &lockin.angle, (wh_real)orbit->tare_N, measured,
                            i);
    }
    wh_merge_compare(rotor, &merge, &lockin.angle, measured);
    wh_merge_judge(&judged, rotor, &merge, &lockin.angle, measured);
}

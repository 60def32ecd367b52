/* rig_orbit.h: one turn of the eccentric-mass rig at a steady mean speed, integrated finely in double, and
 * measurements of it with made-up noise by core/rig's lock-in, which knows nothing of it. */
#ifndef TESTS_RIG_ORBIT_H
#define TESTS_RIG_ORBIT_H

#include <stdbool.h>
#include <stdint.h>

#include "core/rig/result.h"

/* The plant: eccentric_fixed with gravity of core/models/eccentric.whirl, written down once more. */
typedef struct rig_plant {
    double mass_moment_kgm;
    double inertia_kgm2;
    double drag_Nms; /* of the bearings */
    double line_Nms; /* slope of the motor's torque line */
    double gravity_mps2;
    double tare_N;
    double fed_Nm;       /* gravity's torque as the motor is given it; 0: it is not, */
    double fed_late_rad; /* at an angle that is so much behind; no voltage is below 0 */
    double twice_Nm;     /* a torque twice a turn: twice_Nm cos(2 theta + twice_rad) */
    double twice_rad;
} rig_plant;

extern const rig_plant rig_plant_nominal;

#define ORBIT_NODES 4096U

typedef struct rig_orbit {
    double turn_s;
    double split; /* part of the turn's time at which sensor 2 fires */
    double node_s;
    double force_N[ORBIT_NODES + 1U]; /* without tare, evenly over the time since sensor 1's mark */
    double tare_N;
    /* truth: first Fourier coefficients over the angle */
    double in_phase_N;
    double quadrature_N;
    double amplitude_N;
    double phase_rad;
    bool fed;
    double drive_Nm; /* the motor's torque at standstill, without what it is fed of gravity */
    double swing;    /* half the range of the speed, over its mean */
} rig_orbit;

/* The steady turn at this mean speed. The marks are where the arms are lead_rad short of the sensors. */
void rig_orbit_find(const rig_plant *plant, double speed_rpm, double lead_rad, rig_orbit *orbit);

typedef struct rig_noise {
    double cell_N;   /* standard deviations: of each sample's force, */
    double jitter_s; /* and of each mark's time */
    unsigned
        slower; /* samples come so many times slower than HAL_LOADCELL_PERIOD_TICKS; 0: they do not */
    /* a converter that is coarser than the cell's counts, and its driver: a sample is what a mean of so many conversions,
     * evenly over its 2 ms, says with those beside it (hal/averaged.h); each conversion has whole counts of so much, which
     * the converter's own noise moves by so many. 0: none */
    unsigned conversions;
    double conversion_N;
    double conversion_counts;
    /* faults of the cell, all 0 for none */
    double gain_off; /* it shows so much more, as a part */
    double hum_N;    /* amplitude of what the mains adds, */
    double hum_Hz;   /* 0: of 60 Hz */
    double
        clips; /* the force is limited at this part of its own peak, above or (negative) below; 0: it is not */
    double play_N; /* the reading follows the force when that has moved by so much to either side */
    double bend;   /* it shows F (1 - bend (F/peak)^2) */
    double frozen_s;  /* it stands still for so long in the middle of the turns that are kept */
    double spikes;    /* this part of the samples */
    double spike_N;   /* is off by so much */
    bool mute;        /* no force, but all of the above */
    double turned_by; /* part of a turn by which both sensors stand wrong */
} rig_noise;

/* The configurations that the firmware uses, with a calibration of 0.01 % and 0.01 degrees. */
void rig_measure_config(wh_result_config *result, wh_rotor_config *rotor, wh_cell_config *cell);

/* Measure over `turns` turns, after `before` turns of which nothing is kept. What noise there is is drawn
 * from scattered_seed. */
void rig_measure(const rig_orbit *orbit, const rig_noise *noise, const wh_rotor_config *rotor,
                 unsigned before, unsigned turns, uint64_t scattered_seed, wh_measured *measured);

#endif

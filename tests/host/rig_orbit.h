/* rig_orbit.h: one turn of the eccentric-mass rig at a steady mean speed, integrated finely in double. core/rig's
 * lock-in measures it with synthetic noise and no knowledge of the model. */
#ifndef TESTS_RIG_ORBIT_H
#define TESTS_RIG_ORBIT_H

#include "core/rig/result.h"
#include "test.h"

/* The plant: eccentric_fixed with gravity of core/models/eccentric.whirl, written independently. */
typedef struct rig_plant {
    double unbalance_kgm;
    double inertia_kgm2;
    double drag_Nms; /* of the bearings */
    double line_Nms; /* slope of the motor's torque line */
    double gravity_mps2;
    double tare_N;
    double fed_Nm; /* amplitude of the gravity compensation's torque; 0: off */
    /* lag of the angle that the gravity compensation uses; the motor's torque is never below 0 */
    double fed_late_rad;
    double twice_Nm; /* a torque with two periods a turn: twice_Nm cos(2 theta + twice_rad) */
    double twice_rad;
} rig_plant;

extern const rig_plant rig_plant_nominal;

#define ORBIT_NODES 4096U

typedef struct rig_orbit {
    double turn_s;
    double split; /* part of the turn's time at which sensor 2 fires */
    double node_s;
    /* without tare, at equal intervals of time from sensor 1's pulse on */
    double force_N[ORBIT_NODES + 1U];
    double tare_N;
    /* truth: first Fourier coefficients over the angle */
    double in_phase_N;
    double quadrature_N;
    double amplitude_N;
    double phase_rad;
    bool fed;
    double drive_Nm; /* the motor's torque at standstill, without the compensation */
    double swing;    /* half the range of the speed over its mean */
} rig_orbit;

/* Finds the steady turn at this mean speed. At a pulse the arms are lead_rad before the sensor. */
void rig_orbit_find(const rig_plant *plant, double speed_rpm, double lead_rad, rig_orbit *orbit);

typedef struct rig_noise {
    double cell_N;   /* standard deviation of a sample's force */
    double jitter_s; /* standard deviation of a pulse's time */
    unsigned slower; /* factor on the sample period HAL_LOADCELL_PERIOD_TICKS; 0: one */
    /* A converter coarser than the cell's counts: a sample is the mean of `conversions` readings, spread evenly over
     * 2 ms, and smoothed with its neighbours (hal/averaged.h). A reading is a multiple of conversion_N; its noise has
     * the standard deviation conversion_counts, in such multiples. conversions 0: no such converter */
    unsigned conversions;
    double conversion_N;
    double conversion_counts;
    /* faults of the cell; 0: absent */
    double gain_off;  /* relative gain error */
    double hum_N;     /* amplitude of mains hum */
    double hum_Hz;    /* frequency of the hum; 0: 60 Hz */
    double clips;     /* clips at this part of the upper or (negative) lower peak; 0: never */
    double play_N;    /* hysteresis: the reading follows the force after a change of this size */
    double bend;      /* the cell shows F (1 - bend (F/peak)^2) for the force F */
    double frozen_s;  /* the cell freezes for this long in the middle of the recorded turns */
    double spikes;    /* share of samples with a spike */
    double spike_N;   /* size of a spike */
    bool mute;        /* no force, only the noise and faults */
    double turned_by; /* both sensors' angular error, in turns */
} rig_noise;

/* The configurations of the firmware, with a calibration of 0.01 % and 0.01 degrees. */
void rig_measure_config(wh_result_config *result, wh_rotor_config *rotor, wh_cell_config *cell);

/* Measures over `turns` turns, after `before` unrecorded turns. scattered_seed seeds the noise. */
void rig_measure(const rig_orbit *orbit, const rig_noise *noise, const wh_rotor_config *rotor,
                 unsigned before, unsigned turns, uint64_t scattered_seed, wh_measured *measured);

#endif

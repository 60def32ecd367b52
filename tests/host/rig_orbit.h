/* rig_orbit.h: one turn of the eccentric-mass rig at a steady mean speed, integrated finely in double. The lock-in
 * of core/rig measures this turn with synthetic noise. The lock-in does not know the model. */
#ifndef TESTS_RIG_ORBIT_H
#define TESTS_RIG_ORBIT_H

#include "core/rig/result.h"
#include "test.h"

/* The plant, written independently of core/models/eccentric.whirl: the mechanism eccentric_fixed with gravity. */
typedef struct rig_plant {
    double unbalance_kgm;
    double inertia_kgm2;
    double drag_Nms; /* damping of the bearings */
    double line_Nms; /* motor torque lost per rad/s of speed */
    double gravity_mps2;
    double tare_N;
    double fed_Nm; /* amplitude of the torque of the gravity compensation; 0: off */
    /* lag of the angle that the gravity compensation uses */
    double fed_late_rad;
    /* amplitude of a torque with two periods a turn, twice_Nm cos(2 theta + twice_rad) */
    double twice_Nm;
    double twice_rad;
} rig_plant;

extern const rig_plant rig_plant_nominal;

#define ORBIT_NODES 4096U

typedef struct rig_orbit {
    double turn_s;
    /* time from the pulse of sensor 1 to that of sensor 2, divided by the turn's time */
    double split;
    double node_s;
    /* force without tare, at equal intervals of time, beginning with the pulse of sensor 1 */
    double force_N[ORBIT_NODES + 1U];
    double tare_N;
    /* the true first Fourier coefficients over the angle */
    double in_phase_N;
    double quadrature_N;
    double amplitude_N;
    double phase_rad;
    bool compensated;
    double drive_Nm; /* the motor's torque at standstill, without gravity compensation */
    double swing;    /* half the range of the speed, divided by the mean speed */
} rig_orbit;

/* Finds the steady turn at this mean speed. When a pulse comes, the arms are lead_rad before the sensor. */
void rig_orbit_find(const rig_plant *plant, double speed_rpm, double lead_rad, rig_orbit *orbit);

typedef struct rig_noise {
    double cell_N;   /* standard deviation of the force of a sample */
    double jitter_s; /* standard deviation of the time of a pulse */
    unsigned slower; /* factor on the sample period HAL_LOADCELL_PERIOD_TICKS; 0 counts as 1 */
    /* A converter that is coarser than the counts of the load cell; conversions = 0: none. A reading is a multiple
     * of conversion_N. Its noise has the standard deviation conversion_counts times conversion_N. A sample is the
     * mean of `conversions` readings over 2 ms, smoothed with its neighbours (hal/averaged.h). */
    unsigned conversions;
    double conversion_N;
    double conversion_counts;
    /* Faults of the load cell; 0: no fault. */
    double gain_off; /* relative gain error */
    double hum_N;    /* amplitude of mains hum */
    double hum_Hz;   /* frequency of the hum; 0 means 60 Hz */
    /* clips the force at this part of its upper peak, or of its lower peak if negative; 0: never */
    double clips;
    double play_N;    /* half width of the hysteresis */
    double bend;      /* curvature: a cell that should show F shows F (1 - bend (F/peak)^2) */
    double frozen_s;  /* duration of a frozen reading in the middle of the recorded turns */
    double spikes;    /* share of samples with a spike */
    double spike_N;   /* size of a spike */
    bool mute;        /* the cell shows noise and faults, but no force */
    double turned_by; /* angular error of both sensors, in turns */
} rig_noise;

/* The firmware's configurations, with sensors calibrated to 0.01 % and 0.01 degrees. */
void rig_measure_config(wh_result_config *result, wh_rotor_config *rotor, wh_cell_config *cell);

/* Measures `turns` turns after `before` turns without recording. scattered_seed is the seed of the noise. */
void rig_measure(const rig_orbit *orbit, const rig_noise *noise, const wh_rotor_config *rotor,
                 unsigned before, unsigned turns, uint64_t scattered_seed, wh_measured *measured);

#endif

/* compensated_rotor.h: the imitated rotor under a speed drive, with observer and gravity compensation (core/rig/observer.c,
 * gravity_compensation.c) and their errors. */
#ifndef TESTS_CORE_FED_ROTOR_H
#define TESTS_CORE_FED_ROTOR_H

#include "core/rig/drive.h"
#include "core/rig/gravity_compensation.h"
#include "core/rig/speed.h"
#include "rotor.h"

#define FED_STEP_TICKS 2000U
#define FED_STEP_S WH_R(0.002)

typedef enum fed_by { FED_BY_NOBODY, FED_BY_OBSERVER, FED_BY_TRUTH } fed_by;

typedef struct compensated_rotor {
    rotor_kind kind;
    rotor_state rotor;
    wh_observer_config observing;
    wh_observer observer;
    wh_compensation_config feeding;
    wh_compensation compensation;
    wh_drive_config driving;
    wh_drive drive;
    wh_speed speed;
    wh_real voltage; /* voltage of the next control step, as a fraction of the rated one */
    fed_by by;
    unsigned lose_pulses; /* number of coming pulses that will be lost, of any sensor */
    /* From here to sum_radps: values counted since compensated_rotor_count(). */
    uint32_t steps;
    uint32_t valid;    /* number of steps with a valid observer */
    uint32_t lies;     /* steps whose observer is valid but has an error above FED_LIE_RAD */
    wh_real worst_rad; /* largest error of the angle while the observer is valid */
    wh_real square_rad2;
    wh_real least_radps;
    wh_real most_radps;
    wh_real sum_radps;
    bool stood; /* the rotor was slower than 10 rpm */
} compensated_rotor;

#define FED_LIE_RAD WH_R(0.35)

/* Sets the rotor and the controller as in the standard rig. If you want another rotor, change it before
 * compensated_rotor_start(). That function gives the rotor its speed. */
void compensated_rotor_standard(compensated_rotor *compensated, uint64_t seed);
wh_status compensated_rotor_start(compensated_rotor *compensated, wh_real speed_rpm);

void compensated_rotor_run(compensated_rotor *compensated, wh_real target_rpm, wh_real time_s);

/* From now on the voltage is constant: the voltage for this speed, without a speed drive. */
void compensated_rotor_hold(compensated_rotor *compensated, wh_real speed_rpm);

void compensated_rotor_count(compensated_rotor *compensated);

/* For the counted steps: RMS error of the angle while the observer is valid. The next function returns half the range
 * of the speed divided by its mean. */
wh_real fed_rotor_rms_rad(const compensated_rotor *compensated);
wh_real compensated_rotor_ripple(const compensated_rotor *compensated);
wh_real fed_rotor_mean_rpm(const compensated_rotor *compensated);

#endif

/* step_inputs.h: the observations of a control step, for telemetry and self-test. */
#ifndef WH_STATION_STEP_INPUTS_H
#define WH_STATION_STEP_INPUTS_H

#include "core/rig/rig.h"

#define WH_STEP_SAMPLES 2U

typedef struct wh_step_sample {
    uint32_t ticks;
    int32_t raw;
    wh_load_status status;
} wh_step_sample;

typedef struct wh_step_inputs {
    wh_rig_inputs inputs;
    bool pulsed; /* a pulse came in this step: the next two members are valid */
    unsigned sensor;
    uint32_t pulse_ticks;
    bool ended; /* the end of a pulse came in this step: the next two members are valid */
    unsigned end_sensor;
    uint32_t end_ticks;
    unsigned samples; /* number of entries in sample[] */
    wh_step_sample sample[WH_STEP_SAMPLES];
} wh_step_inputs;

#endif

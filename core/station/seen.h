/* seen.h: a control step's observations, for telemetry and self-test. */
#ifndef WH_STATION_SEEN_H
#define WH_STATION_SEEN_H

#include "core/rig/rig.h"

#ifdef __cplusplus
extern "C" {
#endif

#define WH_SEEN_SAMPLES 2U

typedef struct wh_seen_sample {
    uint32_t ticks;
    int32_t raw;
    wh_load_status status;
} wh_seen_sample;

typedef struct wh_seen {
    wh_rig_inputs inputs;
    bool pulsed; /* the next two are of this step */
    unsigned sensor;
    uint32_t pulse_ticks;
    bool ended; /* a pulse's end came, too: */
    unsigned end_sensor;
    uint32_t end_ticks;
    unsigned samples; /* number of: */
    wh_seen_sample sample[WH_SEEN_SAMPLES];
} wh_seen;

#ifdef __cplusplus
}
#endif

#endif

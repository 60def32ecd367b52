/* capture.h: the control steps around a trigger: a ring that stops half its length after the trigger. */
#ifndef WH_STATION_CAPTURE_H
#define WH_STATION_CAPTURE_H

#include "core/rig/rig.h"

#ifdef __cplusplus
extern "C" {
#endif

#define WH_CAPTURE_STEPS 192U /* 0.38 s at 500 Hz */
#define WH_CAPTURE_BYTES 8U   /* of a step in a frame */

/* Triggers: X(trigger, word) */
#define WH_CAPTURE_ROWS(X) \
    X(WH_CAPTURE_OFF, "off") \
    X(WH_CAPTURE_PULSE, "pulse") /* a slot pulse */ \
    X(WH_CAPTURE_FAULT, "fault") /* a trip */

#define WH_CAPTURE_NAME(trigger, word) trigger,
typedef enum wh_capture_trigger {
    WH_CAPTURE_ROWS(WH_CAPTURE_NAME) WH_CAPTURE_TRIGGERS
} wh_capture_trigger;
#undef WH_CAPTURE_NAME

typedef struct wh_captured {
    uint16_t ticks; /* of the step, their low half */
    int16_t load;   /* as telemetry has it */
    uint16_t drive_mV;
    uint8_t flags; /* 1, 2: a pulse of sensor 0, 1; 4: it is the trigger; 8: tripped */
    uint8_t stage;
} wh_captured;

/* Progress: X(state, word) */
#define WH_CAPTURE_STATE_ROWS(X) \
    X(WH_CAPTURE_NONE, "off") \
    X(WH_CAPTURE_WAITS, "waiting") \
    X(WH_CAPTURE_TRIGGERED, "triggered") \
    X(WH_CAPTURE_FULL, "full")

#define WH_CAPTURE_NAME(state, word) state,
typedef enum wh_capture_state {
    WH_CAPTURE_STATE_ROWS(WH_CAPTURE_NAME) WH_CAPTURE_STATES
} wh_capture_state;
#undef WH_CAPTURE_NAME

/* All zeros: off. */
typedef struct wh_capture {
    wh_capture_trigger trigger;
    wh_capture_state state;
    unsigned left;        /* steps still to record after the trigger */
    unsigned count;       /* stored steps, */
    unsigned next;        /* and the next one's index */
    uint32_t first_ticks; /* of the oldest, all 32 bits */
    wh_captured step[WH_CAPTURE_STEPS];
} wh_capture;

#define wh_capture_start WH_NAME(wh_capture_start)
#define wh_capture_step WH_NAME(wh_capture_step)
#define wh_capture_at WH_NAME(wh_capture_at)

/* Restart with this trigger. Triggers count once half of the ring is filled. */
void wh_capture_start(wh_capture *capture, wh_capture_trigger trigger);

/* Does it take steps? */
WH_INLINE bool wh_capture_runs(const wh_capture *capture) {
    return capture->state == WH_CAPTURE_WAITS || capture->state == WH_CAPTURE_TRIGGERED;
}

/* In that state: record a step, less than 65 ms after the last; its flags without 4. `now_ticks`: all 32 bits. */
void wh_capture_step(wh_capture *capture, const wh_captured *step, uint32_t now_ticks);

/* Stored step i, from the oldest. */
const wh_captured *wh_capture_at(const wh_capture *capture, unsigned i);

#ifdef __cplusplus
}
#endif

#endif

/* tape_state.h: where a recording of the control steps is (tape_out.h), and the words that begin and end it. */
#ifndef WH_STATION_TAPE_STATE_H
#define WH_STATION_TAPE_STATE_H

#include "core/step_tape.h"
#include "telemetry.h"

#ifdef __cplusplus
extern "C" {
#endif

/* X(state, word) */
#define WH_TAPE_STATE_ROWS(X) \
    X(WH_TAPE_NONE, "off") \
    X(WH_TAPE_WAITS, "waits") /* for the rig to be idle, and the settings to be out */ \
    X(WH_TAPE_RUNS, "runs") \
    X(WH_TAPE_ENDS, "ends") /* which is still to be told */

#define WH_TAPE_NAME(state, word) state,
typedef enum wh_tape_state { WH_TAPE_STATE_ROWS(WH_TAPE_NAME) WH_TAPE_STATES } wh_tape_state;
#undef WH_TAPE_NAME

/* All zeros: off. */
typedef struct wh_tape {
    wh_tape_state state;
    wh_taped_end end;       /* of one that ends */
    unsigned setting;       /* that goes out next */
    wh_taped_before before; /* the next step */
    uint32_t first_ticks;   /* of the steps that wait to go out, */
    unsigned count;         /* so many bytes of: */
    uint8_t bytes[WH_TEL_PAYLOAD_MOST];
    wh_taped_order order[WH_TAPED_ORDERS]; /* for the next step */
    unsigned orders;
} wh_tape;

/* From the next time that the rig is idle on; anew where it runs already. */
WH_INLINE void wh_tape_on(wh_tape *out) { *out = (wh_tape){.state = WH_TAPE_WAITS}; }

/* Settings are the tape's, and must stay. */
WH_INLINE bool wh_tape_holds(const wh_tape *out) {
    return out->state == WH_TAPE_WAITS || out->state == WH_TAPE_RUNS;
}

WH_INLINE void wh_tape_off(wh_tape *out) {
    if (wh_tape_holds(out)) {
        out->state = WH_TAPE_ENDS;
        out->end = WH_TAPED_OFF;
    }
}

#ifdef __cplusplus
}
#endif

#endif

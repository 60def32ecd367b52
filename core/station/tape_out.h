/* tape_out.h: what each control step sees and answers, to the bit, as frames of telemetry's channel `tape`: a recording that
 * `whirl pil --replay` gives to the same controller again (core/step_tape.h).
 *
 * It begins while the rig is idle: the settings go out, then the controller starts anew, as after a reset that was a
 * power-on, so that nothing from before counts, and from then on each step is told. Settings cannot be changed
 * meanwhile. A frame that finds no room ends it: what is behind a gap could not be replayed.
 *
 * A program that has one (station->tape) calls, in each control step:
 *
 *     wh_station_see(...); wh_tape_see(&station, &rig);
 *     wh_station_step(...); wh_tape_orders(&station, &rig);
 */
#ifndef WH_STATION_TAPE_OUT_H
#define WH_STATION_TAPE_OUT_H

#include "station.h"

#ifdef __cplusplus
extern "C" {
#endif

#define wh_tape_see WH_NAME(wh_tape_see)
#define wh_tape_orders WH_NAME(wh_tape_orders)

/* The step that wh_station_see() has just seen, of which `rig` holds the answer. One that waits goes on: some of the settings go
 * out, or it begins, with which the rig starts anew. The station needs tel and tape; conf may be NULL. */
void wh_tape_see(wh_station *station, wh_rig *rig);

/* What is ordered for the next one. */
void wh_tape_orders(wh_station *station, const wh_rig *rig);

#ifdef __cplusplus
}
#endif

#endif

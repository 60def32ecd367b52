/* lockstep.h: a firmware image and a plant, in turns, until the firmware ends; or a tape in place of the plant. One
 * waits while the other computes, so a run is reproducible at any speed. The firmware's computing costs plant time: its
 * counted instructions times the seconds for each. This delays its outputs, and its next readings. */
#ifndef PIL_LOCKSTEP_H
#define PIL_LOCKSTEP_H

#include "host/pil/report.h"

/* Run it; the process is gone on return. */
void lockstep_run(const lockstep_wish *wish, const image *im, lockstep_report *report);

/* Run the firmware again on the readings of a tape. Each of its orders must equal the tape's, except for instruction
 * counts. */
void lockstep_replay(const lockstep_wish *wish, const char *file, lockstep_report *report);

#endif

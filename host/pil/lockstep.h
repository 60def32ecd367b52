/* lockstep.h: a firmware image and a plant, in turns, until the firmware ends; or a tape in the plant's place.
 *
 * While one computes the other waits, so that a run is the same each time, however fast either is. What the firmware
 * computes with costs plant time: instructions that it counted, times seconds an instruction, until what it set takes
 * effect, and until it hears again. */
#ifndef PIL_LOCKSTEP_H
#define PIL_LOCKSTEP_H

#include "host/pil/report.h"

/* Runs it; the process is gone when it returns. */
void lockstep_run(const lockstep_wish *wish, const image *im, lockstep_report *report);

/* The firmware once more, against what a tape kept; each of its orders must be that of the tape, but for what was
 * counted. */
void lockstep_replay(const lockstep_wish *wish, const char *file, lockstep_report *report);

#endif

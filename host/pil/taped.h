/* taped.h: a tape as a table: one row for each input and output of the firmware. */
#ifndef PIL_TAPED_H
#define PIL_TAPED_H

#include <stdbool.h>

/* Columns:
 *
 *   the event's time, by its stamp, and the time when the firmware received or sent it, s since the plant's time 0.
 *   the kind: edge, sample, output, note; cut: the watchdog has cut the outputs.
 *   the channel of that kind, from 1, and its signal.
 *   value and unit.
 *   a sample's quality: good, saturated, disconnected.
 *
 * An edge has no value. Outputs and notes have a row at each change. `csv` NULL or "-": standard output. Returns false,
 * and reports the reason, if reading or writing is incomplete. */
bool taped_show(const char *name, const char *csv);

#endif

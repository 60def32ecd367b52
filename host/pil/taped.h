/* taped.h: a tape as a table: what the firmware heard, and what it said, a row each. */
#ifndef PIL_TAPED_H
#define PIL_TAPED_H

#include <stdbool.h>

/* Columns: when it was, by its stamp, and when the firmware heard or said it, both in s since the plant's time 0; the kind
 * (edge, sample, output, note; cut: the watchdog has cut the outputs); which of that kind, from 1; its signal; value and
 * unit; what a sample is worth (good, saturated, disconnected). An edge has no value. Outputs and notes have a row when
 * they change. `csv` NULL or "-": standard output. False: not all could be read or written, which was reported. */
bool taped_show(const char *name, const char *csv);

#endif

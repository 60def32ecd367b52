/* traces.h: a run for waveform viewers, as a value change dump (host/io/vcd.h).
 *
 * The records' columns are real numbers with their digits and, in their names, their units; SI units are in the comment
 * after each. Each contact has a wire that is high for a resting stop, an active hold, a sticking friction, and a crossing
 * above its value. A stop and a crossing also have an event at the located instant of the impact or crossing (core/state.h
 * logs the first WH_EVENT_LOG of a step). Inputs are constant during a run. */
#ifndef IO_TRACES_H
#define IO_TRACES_H

#include "records.h"

/* The unit of its times, 10^-power s. It is the coarsest one, of at most a second, that divides the records' spacing;
 * with contacts also at most a thousandth of the step. If there is no such power of ten (a step of 1/3 ms), or the run's
 * end is 2^52 units or more, it is the finest that the end permits. Times are then rounded, and still differ. False if
 * they would not: records less than a femtosecond apart. */
bool traces_power(const image *im, uint64_t every, int *power);

typedef struct traces traces;

/* Writes the head to `out`, which stays the caller's. Records have this form, one every `every` steps, with a
 * unit from traces_power(). */
traces *traces_open(FILE *out, const records *form, uint64_t every);
/* Enters the contacts' events of the last step, after this many steps. */
void traces_step(traces *w, const void *run, uint64_t steps);
/* r->row is the record of that moment, after its traces_step(). False if writing failed. */
bool traces_record(traces *w, uint64_t steps);
/* The end of time; frees it. NULL is fine. */
void traces_close(traces *w);

#endif

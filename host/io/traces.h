/* traces.h: what a run leaves behind for waveform viewers, as a value change dump (host/io/vcd.h).
 *
 * The records' columns are real numbers with their digits and, in their names, their units; of SI units the comment
 * behind each tells. Of each contact there is a wire: a stop that something rests on, a hold that holds, a friction that
 * sticks, a crossing whose value is above it; and an event: a stop that is hit, a crossing that is crossed, at the moment
 * that was located within the step (core/state.h logs the first WH_EVENT_LOG of a step's). Inputs keep their value through
 * a run. */
#ifndef IO_TRACES_H
#define IO_TRACES_H

#include "records.h"

/* The unit of its times, 10^-power s: the coarsest, of a second and less, that the records lie whole multiples of apart,
 * with contacts also no longer than a thousandth of the step. Where no power of ten does that (a step of 1/3 ms), or
 * none in which the run's end is less than 2^52, the finest that the end leaves room for: times are then the nearest,
 * and still differ. False where they would not: records less than a femtosecond apart. */
bool traces_power(const image *im, uint64_t every, int *power);

typedef struct traces traces;

/* Writes the head to `out`, which stays the caller's, for records of this form, every so many steps, of which
 * traces_power() knows a unit. */
traces *traces_open(FILE *out, const records *form, uint64_t every);
/* The run has done so many steps: what its contacts did in the last of them. */
void traces_step(traces *w, const void *run, uint64_t steps);
/* r->row is the record of that moment, of which there must have been a traces_step(). False when writing failed. */
bool traces_record(traces *w, uint64_t steps);
/* The end of time; frees it. NULL is fine. */
void traces_close(traces *w);

#endif

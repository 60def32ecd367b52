/* vcd.h: changes over time for waveform viewers, as a value change dump (IEEE 1364, 18): wires of one bit and real numbers,
 * in microseconds. Vectors of several bits are none of it: viewers have crashed of them.
 *
 * What comes a little out of order is put in order; what comes too late for that is written at the last time that was. */
#ifndef MONITOR_VCD_H
#define MONITOR_VCD_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

enum { VCD_SIGNALS = 64 };

typedef struct vcd vcd;

/* To `out`, which stays the caller's. `what` goes into the head. */
vcd *vcd_new(FILE *out, const char *what);

/* A signal, before the first change; in its name blanks become _, and brackets, which would be vectors, go. Returns its number. */
int vcd_wire(vcd *v, const char *name);
int vcd_real(vcd *v, const char *name);

/* It has this value from time_us on, at the earliest from 0. One that it has already is not written again. */
void vcd_change(vcd *v, int signal, int64_t time_us, double value);

/* Nothing earlier than this will come. */
void vcd_settle(vcd *v, int64_t time_us);

/* What waits is written, and the end of time. Returns how many changes were late; frees it. */
uint64_t vcd_end(vcd *v);

#endif

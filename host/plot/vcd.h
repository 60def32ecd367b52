/* vcd.h: changes over time for waveform viewers, as a value change dump (IEEE 1364, 18): wires of one bit, real numbers, and
 * events, which only happen. Vectors of several bits are none of it: viewers have crashed of them.
 *
 * Only what changes is written, as it is printed. What comes a little out of order is put in order; what comes too late
 * for that is written at the last time that was. Times are whole numbers of the dump's unit, and rise. */
#ifndef PLOT_VCD_H
#define PLOT_VCD_H

#include <stdint.h>
#include <stdio.h>

/* 10^-k s: 0 is a second, 15, the finest that there is, a femtosecond. */
enum { VCD_FINEST = 15 };

typedef struct vcd vcd;

/* To `out`, which stays the caller's: its head, with `what` in it, a unit of 10^-power s, and a scope. Reals have so many
 * digits. */
vcd *vcd_new(FILE *out, const char *what, int power, const char *scope, int digits);

/* What follows stands in a scope of its own, until another begins. */
void vcd_scope(vcd *v, const char *scope);

/* A signal, before the first change. In its name blanks become _, and brackets, which would be vectors, go; where the rest is no
 * simple identifier, such as der(x), the backslash of an escaped one stands before it. `note`, or NULL, is a comment behind it.
 * Returns its number. */
int vcd_wire(vcd *v, const char *name, const char *note);
int vcd_real(vcd *v, const char *name, const char *note);
int vcd_event(vcd *v, const char *name, const char *note);

/* It has this value from this time on, at the earliest from 0; of a wire 0, another, or not a number, which is unknown. An
 * event happens then. */
void vcd_change(vcd *v, int signal, int64_t time, double value);

/* It is this time now: nothing earlier will come. */
void vcd_settle(vcd *v, int64_t time);

/* What waits is written, and the end of time. Returns how many changes were late; frees it. NULL is fine. */
uint64_t vcd_end(vcd *v);

#endif

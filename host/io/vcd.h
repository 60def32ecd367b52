/* vcd.h: a value change dump for waveform viewers (IEEE 1364, 18): wires of one bit, real numbers, and events without a
 * value; no vectors, because they have crashed viewers. Only changes of the printed value are written. Times are whole
 * numbers of the dump's unit, and increase. Changes may come out of order; those before the last written time are
 * written at that time. */
#ifndef IO_VCD_H
#define IO_VCD_H

#include <stdint.h>
#include <stdio.h>

/* Times are in 10^-k s: k is from 0 (second) to 15 (femtosecond). */
enum { VCD_FINEST = 15 };

typedef struct vcd vcd;
typedef enum vcd_kind { VCD_WIRE, VCD_REAL, VCD_EVENT } vcd_kind;

/* Writes the head: `what`, the unit 10^-power s, and `scope`. Reals have `digits` digits. The caller owns `out`. */
vcd *vcd_new(FILE *out, const char *what, int power, const char *scope, int digits);

/* Begins a scope for the following signals. */
void vcd_scope(vcd *v, const char *scope);

/* Adds a signal; call before any change. In its name, blanks become _, and brackets, which would denote vectors, are
 * removed. Other names that are no identifier, such as der(x), get a backslash. `note`: a comment, or NULL. */
int vcd_add(vcd *v, vcd_kind kind, const char *name, const char *note);

/* Sets the value from this time (at least 0) on. A wire is 0 for 0, unknown for NaN, and 1 for other values. */
void vcd_change(vcd *v, int signal, int64_t time, double value);

/* The caller promises that no change before this time will follow. */
void vcd_settle(vcd *v, int64_t time);

/* Writes pending changes and the end time, and frees `v`, which may be NULL. */
void vcd_end(vcd *v);

#endif

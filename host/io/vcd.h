/* vcd.h: a value change dump for waveform viewers (IEEE 1364, 18). A signal is a wire of one bit, a real number, or an
 * event without a value. Vectors have crashed viewers, so no signal is one. A wire or real is written only if its
 * printed value changes. Written times are whole numbers of the dump's unit, and increase. vcd_change() may be called
 * in any order of times. If a time is earlier than the last written one, the change is written at that last time. */
#ifndef IO_VCD_H
#define IO_VCD_H

#include <stdint.h>
#include <stdio.h>

/* Times are in 10^-k s: k is from 0 (second) to 15 (femtosecond). */
enum { VCD_FINEST = 15 };

typedef struct vcd vcd;
typedef enum vcd_kind { VCD_WIRE, VCD_REAL, VCD_EVENT } vcd_kind;

/* Begins a dump on `out`, which vcd_end() leaves open. `what` becomes its comment, 10^-power s its unit of time, and
 * `scope` its first scope. Real numbers have `digits` significant digits. */
vcd *vcd_new(FILE *out, const char *what, int power, const char *scope, int digits);

/* Begins a scope for the following signals. */
void vcd_scope(vcd *v, const char *scope);

/* Adds a signal, and returns its number. Call it before vcd_settle(). In the name, blanks and colons become _, and
 * brackets are removed. If the result is no identifier, as der(x), it gets a backslash. `note`: a comment, or NULL. */
int vcd_add(vcd *v, vcd_kind kind, const char *name, const char *note);

/* Sets the value from this time (at least 0) on. A wire is 0 for 0, unknown for NaN, and 1 for other values. */
void vcd_change(vcd *v, int signal, int64_t time, double value);

/* The caller promises that no change before this time will follow. */
void vcd_settle(vcd *v, int64_t time);

/* Writes pending changes and the end time, and frees `v`, which may be NULL. */
void vcd_end(vcd *v);

#endif

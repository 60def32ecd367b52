/* vcd.h: a value change dump for waveform viewers (IEEE 1364, 18). A signal is one bit, a real number, or an event
 * without a value. A bit or real number is written only if the printed value changes. Changes may come in any order
 * of time. A change before the last written time is written at the last written time. */
#ifndef IO_VCD_H
#define IO_VCD_H

#include <stdint.h>
#include <stdio.h>

/* Times are in 10^-k s: k is from 0 (second) to 15 (femtosecond). */
enum { VCD_FINEST = 15 };

typedef struct vcd vcd;
typedef enum vcd_kind { VCD_WIRE, VCD_REAL, VCD_EVENT } vcd_kind;

/* Begins a dump on `out`. The caller closes `out`. `what` is a comment in the dump. Times are in 10^-power s.
 * `scope` is the name of the first scope. Real numbers have `digits` significant digits. */
vcd *vcd_new(FILE *out, const char *what, int power, const char *scope, int digits);

/* Begins a scope for the following signals. */
void vcd_scope(vcd *v, const char *scope);

/* Adds a signal, and returns the signal's number. Call vcd_add() before vcd_settle(). Blanks and colons of `name`
 * become underscores. Brackets of `name` are left out. `note`: a comment, or NULL. */
int vcd_add(vcd *v, vcd_kind kind, const char *name, const char *note);

/* Sets the value from this time (at least 0) on. A wire is 0 for 0, unknown for NaN, and 1 for other values. */
void vcd_change(vcd *v, int signal, int64_t time, double value);

/* The caller promises that no change before this time will follow. */
void vcd_settle(vcd *v, int64_t time);

/* Writes pending changes and the end time, and frees `v`, which may be NULL. */
void vcd_end(vcd *v);

#endif

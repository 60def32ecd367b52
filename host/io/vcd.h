/* vcd.h: a value change dump for waveform viewers (IEEE 1364, 18): wires of one bit, real numbers, and events without a
 * value. Vectors of several bits are not supported, since they have crashed viewers. Only changes of the printed value
 * are written. Changes that come slightly out of order are sorted; those that come too late for that are written at the
 * last written time. Times are whole numbers of the dump's unit, and increase. */
#ifndef IO_VCD_H
#define IO_VCD_H

#include <stdint.h>
#include <stdio.h>

/* 10^-k s: 0 is a second; the smallest unit, 15, is a femtosecond. */
enum { VCD_FINEST = 15 };

typedef struct vcd vcd;
typedef enum vcd_kind { VCD_WIRE, VCD_REAL, VCD_EVENT } vcd_kind;

/* Writes to `out`, which the caller owns: the head, with the text `what`, a unit of 10^-power s, and a scope. Reals
 * have `digits` digits. */
vcd *vcd_new(FILE *out, const char *what, int power, const char *scope, int digits);

/* Begin a scope for the following signals. */
void vcd_scope(vcd *v, const char *scope);

/* Add a signal, before the first change. In its name blanks become _, and brackets, which would denote vectors, are
 * removed. If the result is not a simple identifier, such as der(x), it is escaped with a backslash. `note`, or NULL,
 * is a comment after it. Returns its number. */
int vcd_add(vcd *v, vcd_kind kind, const char *name, const char *note);

/* The value from this time on, at the earliest from 0. A wire is 0 for 0, unknown for NaN, and 1 for all other numbers.
 * An event occurs at this time. */
void vcd_change(vcd *v, int signal, int64_t time, double value);

/* The present time: no earlier change will follow. */
void vcd_settle(vcd *v, int64_t time);

/* Writes pending changes and the end time, and frees `v`. NULL is allowed. */
void vcd_end(vcd *v);

#endif

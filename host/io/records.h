/* records.h: the records of a run: comma-separated values (RFC 4180), or plain columns, which Octave and
 * Matlab read with `load`: a header line after a percent sign, then numbers between spaces.
 *
 * Columns: time, the coordinates, their derivatives as der(theta), der(der(x)), ..., the outputs. Angles are
 * not wrapped. Numbers are in the unit in which a coordinate or output was declared (image_unit), else SI. A
 * unit other than SI follows the column's name: theta [deg], der(theta) [deg/s]; in plain columns without the
 * blank. */
#ifndef IO_RECORDS_H
#define IO_RECORDS_H

#include <stdio.h>

#include "host/engine/engine.h"

typedef struct record_column {
    const char *name; /* name of the unknown or output; NULL: the time */
    int unknown;      /* index of the unknown; -1 for an output */
    int primes;
    const image_unit *unit; /* unit of the numbers */
    const char *text;       /* the quantity in words, or "" */
} record_column;

typedef struct records {
    FILE *out;   /* comma-separated values; may be NULL */
    FILE *plain; /* plain columns, set and closed by the caller; NULL: none */
    const image *image;
    const engine_kind *kind;
    double *row;           /* [columns]: time, values, derivatives, outputs, in displayed units */
    double *output;        /* [image->outputs] SI */
    record_column *column; /* [columns] */
    int columns;
} records;

/* `out` stays the caller's. */
records *records_open(FILE *out, const image *im, const engine_kind *kind);
void records_close(records *r);
/* der(theta), without its unit; the caller frees it. */
char *records_name(const record_column *c);
void records_header(records *r);
/* Reads the run's state into r->row. The caller gives the time: steps * step, which is exact. */
void records_read(records *r, void *run, double time_s);
/* Write r->row to both files. Returns false if writing failed. */
bool records_write(const records *r);

/* === waves of a run =================================================================================== */
/* A run for waveform viewers, as a value change dump (host/io/vcd.h).
 *
 * The records' columns are real numbers with their digits. A unit other than SI is part of a column's name; the comment
 * after the name has every unit. Each contact has a wire that is high for a resting stop, an active hold, a sticking
 * friction, and a crossing above its value. A stop and a crossing also have an event at the located instant of the
 * impact or crossing (core/state.h logs the first WH_EVENT_LOG of a step). Inputs are constant during a run. */

/* The unit of the dump's times, 10^-power s: the coarsest with a thousand units in a step, or the finest in which the end is
 * below 2^52 units. Returns false if a step is then shorter than a unit, or the end is later. */
bool traces_power(const image *im, int *power);

typedef struct traces traces;

/* Writes the head to `out`, which stays the caller's. `form` has the records' columns. Call it only after traces_power()
 * returned true. */
traces *traces_open(FILE *out, const records *form);
/* Enters the contacts' events of the last step, after this many steps. */
void traces_step(traces *w, const void *run, uint64_t steps);
/* Enters the record in r->row after this many steps; call traces_step() first. Returns false if writing failed. */
bool traces_record(traces *w, uint64_t steps);
/* Writes the end time, and frees `w`. NULL is allowed. */
void traces_close(traces *w);

#endif

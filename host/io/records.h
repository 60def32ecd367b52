/* records.h: the records of a run, as comma-separated values (RFC 4180) or as plain columns. Octave and Matlab read
 * plain columns with `load`. The columns are the time, the unknowns, their derivatives such as der(theta), and the
 * outputs. Angles are not wrapped. Numbers are in declared units (image_unit), otherwise in SI. The header names each
 * unit that is not SI: theta [deg]. */
#ifndef IO_RECORDS_H
#define IO_RECORDS_H

#include <stdio.h>

#include "host/engine/engine.h"

typedef struct record_column {
    const char *name; /* unknown or output; NULL: the time */
    int unknown;      /* index of the unknown; -1 for an output */
    int primes;
    const image_unit *unit;
    const char *text; /* the quantity in words, or "" */
} record_column;

typedef struct records {
    FILE *out;   /* comma-separated values, owned by the caller; or NULL */
    FILE *plain; /* plain columns, set and closed by the caller; or NULL */
    const image *image;
    const engine_kind *kind;
    double *row;           /* [columns] in displayed units */
    double *output;        /* [image->outputs] SI */
    record_column *column; /* [columns] */
    int columns;
} records;

records *records_open(FILE *out, const image *im, const engine_kind *kind);
void records_close(records *r);
/* Returns a name such as "der(theta)", without a unit. The caller frees it. */
char *records_name(const record_column *c);
/* Writes "theta'" to text[], and returns `text`. */
enum { RECORDS_SHOWN_NAME = 100 };
const char *records_shown_name(const record_column *c, char text[RECORDS_SHOWN_NAME]);
void records_header(records *r);
/* Reads the run's state into r->row. `time_s` becomes the column of the time. */
void records_read(records *r, void *run, double time_s);
/* Writes r->row to r->out and r->plain. Returns false if writing failed. */
bool records_write(const records *r);

/* === waves of a run =================================================================================== */
/* A run for waveform viewers, as a value change dump (host/io/vcd.h). Columns and constant inputs are real signals.
 * A wire is high while a stop rests, a hold is active, a friction sticks, or a `when` has its left side above its right
 * side. An event marks an impact or a crossing. The dump has the first WH_EVENT_LOG events of a step. */

/* Sets *power, from 0 to VCD_FINEST: the dump's unit of time is 10^-power s. Returns false if a step is
 * shorter than this unit, or if the run has 2^52 units or more. */
bool traces_power(const image *im, int *power);

typedef struct traces traces;

/* Begins a dump of the columns of `form` on `out`. The caller owns both. traces_power() must have returned true. */
traces *traces_open(FILE *out, const records *form);
/* Adds the contacts' events of the last step. `steps`: steps so far. */
void traces_step(traces *w, const void *run, uint64_t steps);
/* Adds the record r->row; call traces_step() first. Returns false if writing failed. */
bool traces_record(traces *w, uint64_t steps);
/* Writes the end time, and frees `w`, which may be NULL. */
void traces_close(traces *w);

#endif

/* records.h: the records of a run: comma-separated values (RFC 4180), or plain columns, which Octave and Matlab read
 * with `load`: a header line after a percent sign, then numbers between spaces. Columns: time; coordinates; derivatives
 * as der(theta), der(der(x)), ...; outputs. Angles are not wrapped. Numbers are in the declared unit (image_unit), else
 * SI. A unit other than SI follows the column's name: theta [deg]; in plain columns without the blank. */
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
/* "der(theta)", without the unit; the caller frees it. */
char *records_name(const record_column *c);
/* Writes "theta'" to text[], and returns `text`. */
enum { RECORDS_SHOWN_NAME = 100 };
const char *records_shown_name(const record_column *c, char text[RECORDS_SHOWN_NAME]);
void records_header(records *r);
/* Reads the run's state into r->row. `time_s` is steps * step, which is exact. */
void records_read(records *r, void *run, double time_s);
/* Writes r->row to both files. Returns false if writing failed. */
bool records_write(const records *r);

/* === waves of a run =================================================================================== */
/* A run for waveform viewers, as a value change dump (host/io/vcd.h). The records' columns are real signals. A unit
 * other than SI is part of the name; the comment after it has every unit. Each contact has a wire: high for a resting
 * stop, an active hold, a sticking friction, and a crossing above its value. Stops and crossings have an event at the
 * located instant (core/state.h logs the first WH_EVENT_LOG of a step). Inputs are constant during a run. */

/* The unit of the dump's times is 10^-power s: the coarsest with 1000 units in a step, or the finest with the end below
 * 2^52 units. Returns false if a step is then shorter than a unit, or the end is above 2^52 s. */
bool traces_power(const image *im, int *power);

typedef struct traces traces;

/* Writes the head to `out`, which the caller owns. `form` has the columns. traces_power() must have returned true. */
traces *traces_open(FILE *out, const records *form);
/* Adds the contacts' events of the last step. `steps`: steps so far. */
void traces_step(traces *w, const void *run, uint64_t steps);
/* Adds the record r->row; call traces_step() first. Returns false if writing failed. */
bool traces_record(traces *w, uint64_t steps);
/* Writes the end time, and frees `w`, which may be NULL. */
void traces_close(traces *w);

#endif

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
    const char *name; /* of the unknown or output; NULL: the time */
    int unknown;      /* index; -1 for an output */
    int primes;
    const image_unit *unit; /* of the numbers */
} record_column;

typedef struct records {
    FILE *out;   /* comma-separated values; may be NULL */
    FILE *plain; /* plain columns; may be NULL, as records_open leaves it; stays the caller's */
    const image *image;
    const engine_kind *kind;
    double *row;           /* [columns]: time, values, derivatives, outputs, as they are shown */
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
/* Read the run's state into r->row; time is given, since it is steps * step. */
void records_read(records *r, void *run, double time_s);
/* Write r->row to both files. False when writing failed. */
bool records_write(const records *r);

#endif

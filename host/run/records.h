/* records.h: what a run leaves behind, in SI units, angles unwrapped: comma-separated values (RFC 4180),
 * or plain columns, which Octave and Matlab read with `load`: a header line after a percent sign, then
 * numbers between spaces.
 *
 * Columns: time, the coordinates, their derivatives as der(theta), der(der(x)), ..., the outputs. */
#ifndef RUN_RECORDS_H
#define RUN_RECORDS_H

#include <stdio.h>

#include "engine.h"

typedef struct records {
    FILE *out;   /* comma-separated values; may be NULL */
    FILE *plain; /* plain columns; may be NULL, as records_open leaves it; stays the caller's */
    const program *program;
    const equations *equations;
    const engine_kind *kind;
    double *row;    /* [columns]: time, values, derivatives, outputs */
    double *output; /* [program->outputs] */
    int columns;
} records;

/* `out` stays the caller's. */
records *records_open(FILE *out, const program *p, const equations *e, const engine_kind *kind);
void records_close(records *r);
/* Column k's name into text[size]; the unit (SI, "" when none is known). */
void records_name(const records *r, int column, char *text, size_t size);
void records_header(records *r);
/* Read the run's state into r->row; time is given, since it is steps * step. */
void records_read(records *r, void *run, double time_s);
/* Write r->row to both files. False when writing failed. */
bool records_write(const records *r);

#endif

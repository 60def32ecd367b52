/* records.h: what a run leaves behind: comma-separated values (RFC 4180), SI units, angles unwrapped.
 *
 * Columns: time, the coordinates, their derivatives as der(theta), der(der(x)), ..., the outputs. */
#ifndef RUN_RECORDS_H
#define RUN_RECORDS_H

#include <stdio.h>

#include "engine.h"

typedef struct records {
    FILE *out;
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
/* Write r->row. False when writing failed. */
bool records_write(const records *r);

#endif

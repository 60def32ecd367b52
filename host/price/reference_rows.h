/* reference_rows.h: a state in long double as a row of records. */
#ifndef PRICE_REFERENCE_ROWS_H
#define PRICE_REFERENCE_ROWS_H

#include "host/run/records.h"

typedef struct long_rows long_rows;

long_rows *long_rows_new(const records *shape); /* which must outlive it */
void long_rows_free(long_rows *l);
/* row[shape->columns], in their units; `state` as engine_kind.state() has it, angles first. */
void long_rows_read(long_rows *l, const long double *state, long double time_s, long double *row);

#endif

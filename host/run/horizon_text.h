/* horizon_text.h: until when a run can be trusted, in words and as comma-separated values. */
#ifndef TRUST_HORIZON_TEXT_H
#define TRUST_HORIZON_TEXT_H

#include <stdio.h>

#include "horizon.h"

/* All of it: of each coordinate and rate, of the run, and what can be relied on behind that. */
void horizon_print(FILE *out, const horizon *h);
/* One line, for a summary. `doubted`: something is said against the run, which the runs beside it may share. */
void horizon_print_line(FILE *out, const horizon *h, bool doubted);
/* Of each verdict. */
extern const char *const horizon_words[];
/* A header, and a row for each coordinate and rate. */
void horizon_write(FILE *out, const horizon *h);

#endif

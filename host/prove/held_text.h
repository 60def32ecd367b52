/* held_text.h: what is proved of a run, in words and in rows. */
#ifndef PROVE_HELD_TEXT_H
#define PROVE_HELD_TEXT_H

#include <stdio.h>

#include "held.h"

void held_print(FILE *out, const held_found *h, const held_wish *w);

/* Rows of comma-separated values, in SI, with all digits: the time, and of each state the least and the most that the exact
 * motion may be, and what the run has. */
void held_rows_head(FILE *out, const held_wish *w);
void held_row(FILE *out, const held_wish *w, uint64_t step, const enclosure *exact,
              const double *run);

#endif

/* books_text.h: the energy and momentum balance of a run in words. */
#ifndef CHECK_BOOKS_TEXT_H
#define CHECK_BOOKS_TEXT_H

#include <stdio.h>

#include "books.h"
#include "energy_residual.h"
#include "host/engine/engine.h"

/* The energy's account in a few entries, those that are judged (energy_residual.h), and the conserved momenta. */
void books_print(FILE *out, const books *b, const energy_residual *balance);

/* The energy's and the momenta's accounts by statement, from the run's own ledger (`with ledger`). `b` provides
 * the levels. */
void books_print_kept(FILE *out, const image *im, const engine_kind *kind, const void *run,
                      const books *b);

#endif

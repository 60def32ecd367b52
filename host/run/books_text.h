/* books_text.h: the books of a run in words. */
#ifndef RUN_BOOKS_TEXT_H
#define RUN_BOOKS_TEXT_H

#include <stdio.h>

#include "belief.h"
#include "books.h"
#include "engine.h"

/* The energy's account in a few entries, those that are judged (belief.h), and the conserved momenta. */
void books_print(FILE *out, const books *b, const belief *balance);

/* The energy's and the momenta's accounts by statement, as the run itself kept them (`with ledger`). `b` gives the
 * levels. */
void books_print_kept(FILE *out, const image *im, const engine_kind *kind, const void *run,
                      const books *b);

#endif

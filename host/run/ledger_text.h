/* ledger_text.h: the books of a run in words. */
#ifndef RUN_LEDGER_TEXT_H
#define RUN_LEDGER_TEXT_H

#include <stdio.h>

#include "books.h"
#include "engine.h"

/* The energy and momentum books that the run itself kept (`with ledger`). `b` gives the levels. */
void ledger_print(FILE *out, const image *im, const engine_kind *kind, const void *run,
                  const books *b);

#endif

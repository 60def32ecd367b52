/* statement.h: a statement of a model's file in words. */
#ifndef BASE_STATEMENT_H
#define BASE_STATEMENT_H

#include "diag.h"

/* Room for what a message quotes. */
#define STATEMENT_SIZE 161

/* The statement at a place, without indentation and comment, in text[size], size > 4: its line of the source,
 * cut with "..." when it is longer. Empty where there is no source. */
void statement_text(place at, char *text, size_t size);

#endif

/* statement.h: the text of a statement of a model file. */
#ifndef BASE_STATEMENT_H
#define BASE_STATEMENT_H

#include "diag.h"

/* Size of a buffer for the text that a message quotes. */
#define STATEMENT_SIZE 161

/* The source line at a place, without indentation and comment, in text[size], size > 4. A longer line is cut and ends
 * in "...". Empty if the place has no source. */
void statement_text(place at, char *text, size_t size);

#endif

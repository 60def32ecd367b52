/* diag.h: errors in a user's file, each with its place, source line, caret and hint. */
#ifndef BASE_DIAG_H
#define BASE_DIAG_H

#include <stddef.h>
#include <stdio.h>

#define DIAG_MAX 20 /* errors reported for one file; if there were more, a last line says so */

/* A place in a source text. Line and column count from 1, the column in characters. `text` is the whole text, from
 * which the line is printed, or NULL. */
typedef struct source {
    const char *file;
    const char *text;
    size_t length;
} source;

typedef struct place {
    const source *source;
    int line;
    int column;
    size_t offset; /* bytes from the start of the text */
} place;

typedef struct diags diags;

/* Errors go to `out` (standard error in the program) when diags_flush() is called. */
diags *diags_new(void);
void diags_free(diags *diags);

/* Report an error at `at`; `hint` may be NULL or "". Copies its texts. A repeat at the same place is dropped. */
void diag_error(diags *diags, place at, const char *hint, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* Number of errors, including those beyond DIAG_MAX, without repeats. */
int diags_count(const diags *diags);

/* Calls of diag_error() since diags_new(), repeats included: unchanged means no error. */
size_t diags_calls(const diags *diags);

/* Print all errors, ordered by place, and forget them:
 *   file:line:column: error: text
 *       source line
 *            ^
 *   hint: ... */
void diags_flush(diags *diags, FILE *out);

/* === the text of a statement of a model file ================================================== */

/* Size of a buffer for the text that a message quotes. */
#define STATEMENT_SIZE 161

/* The source line at a place, without indentation and comment, in text[size], size > 4. A longer line is cut and ends
 * in "...". Empty if the place has no source. */
void statement_text(place at, char *text, size_t size);

#endif

/* diag.h: errors in a user's file, each with its place, source line, caret and hint. */
#ifndef BASE_DIAG_H
#define BASE_DIAG_H

#include <stddef.h>
#include <stdio.h>

#define DIAG_MAX 20 /* largest number of errors printed; if there were more, a last line says so */

typedef struct source {
    const char *file;
    const char *text; /* if NULL, messages do not show the line */
    size_t length;
} source;

typedef struct place {
    const source *source;
    int line;      /* counts from 1 */
    int column;    /* in characters, counts from 1 */
    size_t offset; /* bytes from the start of the text */
} place;

typedef struct diags diags;

diags *diags_new(void);
void diags_free(diags *diags);

/* Reports an error at `at`. `hint` may be NULL or "". Texts are copied. A second error at the same place is dropped. */
void diag_error(diags *diags, place at, const char *hint, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* Number of errors since the last diags_flush(), without dropped ones. It may exceed DIAG_MAX. */
int diags_count(const diags *diags);

/* Number of calls of diag_error() since diags_new(), including those whose error was dropped. */
size_t diags_calls(const diags *diags);

/* Prints all errors, sorted by place, and removes them:
 *   file:line:column: error: text
 *     source line
 *          ^
 *   hint: ... */
void diags_flush(diags *diags, FILE *out);

/* === the text of a statement of a model file ================================================== */

/* Size of a buffer for the text that a message quotes. */
#define STATEMENT_SIZE 161

/* Writes the statement at `at` to text[size], size > 4, without indentation, comment and enclosing braces. A longer
 * text is cut and ends in "...". If `at` has no source, the text is empty. */
void statement_text(place at, char *text, size_t size);

#endif

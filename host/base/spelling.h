/* spelling.h: UTF-8 characters, and the known name closest to a misspelt one. */
#ifndef BASE_SPELLING_H
#define BASE_SPELLING_H

#include <stddef.h>

/* === well-formed, printable UTF-8 characters ================================================== */

/* Length in bytes of the character at `text`; `left` > 0 bytes of the text remain. Returns 0 if it is malformed, or is
 * a control character above ASCII, which could steer a terminal. */
size_t utf8_length(const char *text, size_t left);
/* A hint with the ASCII replacement of the character at `text`, such as "write -". Without one, returns `otherwise`. */
const char *ascii_hint(const char *text, size_t left, const char *otherwise);

/* === the known name closest to a misspelt one ================================================= */

typedef struct nearest {
    const char *wanted;
    size_t length;
    const char *best; /* NULL: no similar name */
    int cost;
    int offers;
} nearest;

nearest nearest_start(const char *wanted, size_t length);
void nearest_offer(nearest *search, const char *candidate);
/* Writes "did you mean 'NAME'?" to hint[size], or "" if no name is similar. Returns `hint`. */
char *nearest_hint(const nearest *search, char *hint, size_t size);

#endif

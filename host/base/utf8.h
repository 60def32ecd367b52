/* utf8.h: well-formed, printable UTF-8 characters. */
#ifndef BASE_UTF8_H
#define BASE_UTF8_H

#include <stddef.h>

/* Bytes of the character at `text` with `left` bytes to go (left > 0), or 0 when it is malformed or
 * a control character above ASCII, which could steer a terminal as the ASCII ones do. */
size_t utf8_length(const char *text, size_t left);

#endif

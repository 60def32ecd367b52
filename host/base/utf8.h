/* utf8.h: well-formed, printable UTF-8 characters. */
#ifndef BASE_UTF8_H
#define BASE_UTF8_H

#include <stddef.h>

/* Length in bytes of the character at `text`, with `left` > 0 bytes remaining. Returns 0 if it is malformed, or a
 * control character above ASCII: these could steer a terminal, as ASCII ones do. */
size_t utf8_length(const char *text, size_t left);

#endif

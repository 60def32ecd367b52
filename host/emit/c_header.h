/* c_header.h: a scene's C header, and texts of the user in comments. */
#ifndef EMIT_C_HEADER_H
#define EMIT_C_HEADER_H

#include <stdio.h>

#include "host/image/image.h"

/* `text` as part of a comment that it cannot end, nor have compilers warn of: on one line. */
void c_comment(FILE *out, const char *text);

/* Enumerators of components and inputs of a scene in fixed point, a line each. */
void c_header_fixed_state(FILE *out, const image *im);

#endif

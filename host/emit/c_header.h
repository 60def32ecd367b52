/* c_header.h: a scene's C header, and texts of the user in comments. */
#ifndef EMIT_C_HEADER_H
#define EMIT_C_HEADER_H

#include <stdio.h>

#include "host/image/image.h"

/* `text` as part of a comment that it cannot end, nor have compilers warn of: on one line. */
void c_comment(FILE *out, const char *text);

/* Enumerators of components, inputs and outputs of a scene in fixed point, a line each. */
void c_header_fixed_state(FILE *out, const image *im);

/* Parts of headers in floating and fixed point: the licence's line of the head; the check that core and scene are of one
 * version; names and units of lists; values as macros; the range of number i. */
void c_header_licence(FILE *out);
void c_header_version(FILE *out);
void c_header_strings(FILE *out, const image *im);
void c_header_values(FILE *out, const image *im);
void c_header_range(FILE *out, const image *im, int i, double low, double high);

#endif

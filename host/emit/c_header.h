/* c_header.h: a scene's C header, and user texts in comments. */
#ifndef EMIT_C_HEADER_H
#define EMIT_C_HEADER_H

#include <stdio.h>

#include "host/image/image.h"

/* Writes one line of a comment. The text cannot end the comment, and causes no compiler warnings. */
void c_comment(FILE *out, const char *text);

/* Writes the names of components, inputs and outputs in a comment. */
void c_header_names(FILE *out, const image *im);

/* Writes enumerators of components, inputs and outputs for fixed point. */
void c_header_fixed_state(FILE *out, const image *im);

/* Writes the part of the header that follows the scene's declaration. */
typedef void c_header_body(FILE *out, const void *of);
/* Writes the scene's header. `type`: "scene" or "fixed_scene". `form`: text after the scene's name in the first
 * comment. The header links only with its own .c file, by WH_LINKS_TO() of core/version.h. */
void c_header_write(FILE *out, const image *im, const char *file, const char *form,
                    const char *type, c_header_body *body, const void *of);
/* Writes the declaration for the scene's .c file, with WH_LINKED_AS() of core/version.h and a hash of the body. */
void c_header_link(FILE *out, const char *type, const char *scene, c_header_body *body,
                   const void *of);
/* The body for float and double; `of` is an image. */
c_header_body c_header_of_image;
void c_header_strings(FILE *out, const image *im);
void c_header_values(FILE *out, const image *im);
void c_header_range(FILE *out, const image *im, int i, double low, double high);

#endif

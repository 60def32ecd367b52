/* emit.h: the operation lists in other languages. */
#ifndef EMIT_EMIT_H
#define EMIT_EMIT_H

#include <stdio.h>

#include "host/image/image.h"

/* A function file `function dy = NAME(t, y)` that Octave and Matlab integrate as it stands, with the
 * run as a comment. The image must integrate every coordinate (no `conserve`). `file` is the .whirl file's name,
 * for the banner; `contacts` what is to be said of contacts, which the function leaves out: whole lines that begin
 * with a percent sign, or "". */
void emit_octave(FILE *out, const image *im, const char *file, const char *contacts);

/* False when the generated file could not define an object of that name (a word of C or of the core). */
bool emit_c_name_is_free(const char *name);

/* False when a C++ program could not name an object so. */
bool emit_c_name_is_free_in_cpp(const char *name);

/* The scene's header, for C and C++: names of its components, inputs and outputs, their units, its memory. */
void emit_c_header(FILE *out, const image *im, const char *file);

/* The scene as C for the core: constants, start, straight-line right-hand side, one step. */
void emit_c(FILE *out, const image *im, const char *file);

#endif

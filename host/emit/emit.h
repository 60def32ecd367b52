/* emit.h: operation lists in other languages. */
#ifndef EMIT_EMIT_H
#define EMIT_EMIT_H

#include <stdio.h>

#include "host/image/image.h"

/* A function file `function dy = NAME(t, y)` that Octave and Matlab can integrate, with the run as a comment. The image
 * must integrate every coordinate (no `conserve`). `file` is the .whirl file's name, for the banner. `contacts` is the
 * comment on contacts, which the function omits: whole lines that begin with EMIT_OCTAVE_COMMENT, or "". */
#define EMIT_OCTAVE_COMMENT "% "
void emit_octave(FILE *out, const image *im, const char *file, const char *contacts);
/* The lines before and after the calculation, for a calculation with names (host/show). */
void emit_octave_head(FILE *out, const image *im, const char *file, const char *contacts);
void emit_octave_end(FILE *out, const image *im);

/* Can a scene have that name in C? It must be no keyword, no name of C's library, no predefined macro of a compiler,
 * and no name of the core or the generated file. */
bool emit_c_name_is_free(const char *name);

/* Is it free of the words that only C++ reserves? */
bool emit_c_name_is_free_in_cpp(const char *name);

/* Can a function file of Octave and of Matlab have that name? It must be no keyword or constant of theirs, and no name
 * in the file. */
bool emit_octave_name_is_free(const char *name);
/* Can a variable there have that name? A variable may hide constants such as e and I. */
bool emit_octave_variable_is_free(const char *name);

/* The scene's header, for C and C++: names of its components, inputs and outputs, their units, its memory. */
void emit_c_header(FILE *out, const image *im, const char *file);

/* The scene as C for the core: constants, start, straight-line right-hand side, one step. */
void emit_c(FILE *out, const image *im, const char *file);

#endif

/* emit.h: the operation lists in other languages. */
#ifndef EMIT_EMIT_H
#define EMIT_EMIT_H

#include <stdio.h>

#include "host/image/image.h"

/* A function file `function dy = NAME(t, y)` that Octave and Matlab integrate as it stands, with the
 * run as a comment. The image must integrate every coordinate (no `conserve`). `file` is the .whirl file's name,
 * for the banner; `contacts` what is to be said of contacts, which the function leaves out: whole lines that begin
 * with EMIT_OCTAVE_COMMENT, or "". */
#define EMIT_OCTAVE_COMMENT "% "
void emit_octave(FILE *out, const image *im, const char *file, const char *contacts);
/* The same file's lines before and after the calculation, for a calculation with names (host/show). */
void emit_octave_head(FILE *out, const image *im, const char *file, const char *contacts);
void emit_octave_end(FILE *out, const image *im);

/* Can a scene have that name in C: is it no word of C, nor a name of C's library, a macro that compilers have from
 * the start, or a name of the core or the generated file? */
bool emit_c_name_is_free(const char *name);

/* Is it no word that only C++ has? */
bool emit_c_name_is_free_in_cpp(const char *name);

/* Can a function file of Octave and of Matlab have that name: is it no word or constant of theirs, and none that the
 * file itself uses? */
bool emit_octave_name_is_free(const char *name);
/* Can a variable have that name there? Constants such as e and I give way to a variable. */
bool emit_octave_variable_is_free(const char *name);

/* The scene's header, for C and C++: names of its components, inputs and outputs, their units, its memory. */
void emit_c_header(FILE *out, const image *im, const char *file);

/* The scene as C for the core: constants, start, straight-line right-hand side, one step. */
void emit_c(FILE *out, const image *im, const char *file);

#endif

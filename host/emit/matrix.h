/* matrix.h: a whole step as one matrix (IMAGE_MATRIX), written out. */
#ifndef EMIT_MATRIX_H
#define EMIT_MATRIX_H

#include "host/base/json.h"
#include "host/image/image.h"

/* Writes tables of Phi, Gamma and g with ten digits. */
void matrix_text(FILE *out, const image *im);
void matrix_latex(FILE *out, const image *im);

/* A function file `function [Phi, Gamma, g0] = NAME()` for Octave and Matlab, to the last digit, with a run as a comment.
 * Phi and Gamma are the names of Matlab's c2d(). */
void matrix_octave(FILE *out, const image *im, const char *file);

/* Writes the setting; for an image with a matrix also "phi", "gamma" and "g", rows of the components in their order. */
void matrix_json(json *j, const image *im);

#endif

/* matrix.h: a whole step as one matrix (IMAGE_MATRIX), written out. */
#ifndef EMIT_MATRIX_H
#define EMIT_MATRIX_H

#include "host/base/json.h"
#include "host/image/image.h"

/* Tables of Phi, Gamma and g, of ten digits. */
void matrix_text(FILE *out, const image *im);
void matrix_latex(FILE *out, const image *im);

/* A function file `function [Phi, Gamma, g0] = NAME()` for Octave and Matlab, to the last digit, with a run as a comment.
 * Matlab's c2d() calls them so. */
void matrix_octave(FILE *out, const image *im, const char *file);

/* The setting, and of an image with a matrix also "phi", "gamma" and "g", rows of the components in their order. */
void matrix_json(json *j, const image *im);

#endif

/* affine.h: the coefficients of an affine right-hand side, x' = A x + B u + c, from its operation list. */
#ifndef DERIVE_AFFINE_H
#define DERIVE_AFFINE_H

#include "host/image/image.h"
#include "host/number/double_double.h"

/* The states of a scene, angles first, and the columns: states, inputs, and the constant. */
int affine_states(const image *im);
int affine_columns(const image *im);

/* rates[states * columns]: the rates of the states, row by row, with the list's own round-off. Each operation is
 * repeated on its operands' coefficients. Returns -1, or the first operation that is not affine; rates[] is then
 * unchanged. */
int affine_rates(const image *im, twofold *rates);

/* taking[columns]: the columns on which operation `number` of the step's list depends, turn angles included. */
void affine_takes(const image *im, int number, bool *taking);

#endif

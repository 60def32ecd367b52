/* affine.h: a right-hand side that is affine, read off its operation list: x' = A x + B u + c. */
#ifndef DERIVE_AFFINE_H
#define DERIVE_AFFINE_H

#include "host/image/image.h"
#include "host/number/twofold.h"

/* States of a scene, angles first, and the columns that belong to them: the states, the inputs, and what is constant. */
int affine_states(const image *im);
int affine_columns(const image *im);

/* rates[states * columns] of the states, row by row. They are those of the list to the last bits: every operation is done
 * once more with its operands' coefficients. Returns -1; or, of a list that is not affine, the first operation that is
 * the reason, with rates[] as it was. */
int affine_rates(const image *im, twofold *rates);

/* Which columns take part in operation `number` of the step's list: those of turn angles as well. taking[columns]. */
void affine_takes(const image *im, int number, bool *taking);

#endif

/* eliminate.h: solving n linear equations by entering operations into a tape. */
#ifndef DERIVE_ELIMINATE_H
#define DERIVE_ELIMINATE_H

#include "host/image/tape.h"

/* mass[n * n] and force[n] are operations (overwritten). order[n] is the order of elimination; the
 * first `done` of it have been eliminated from the others already, in symbols, and only need their
 * values from back substitution. solution[n] receives the operations. A symmetric matrix is taken
 * as positive definite; any other is solved by the largest pivot at a sample state, and by Cramer's
 * rule once three equations are left, so that no division by a vanishing pivot is made where the
 * determinant does not vanish. */
void eliminate(tape *t, bool symmetric, int n, int *mass, int *force, const int *order, int done,
               int *solution);

#endif

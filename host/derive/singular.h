/* singular.h: can the equations be solved for the highest derivatives at all? */
#ifndef DERIVE_SINGULAR_H
#define DERIVE_SINGULAR_H

#include "host/derive/equations.h"

/* Tries the mass matrix at a number of generic states and at the start. False, with an error that
 * names the cause, when it is singular at all of them, has no finite value at any or, that of a
 * mechanism given by energies, is positive definite at none (a negative mass). A matrix that is
 * singular only here and there (a pole of spherical coordinates) passes: such states are found while
 * running. e->mass_blur is set. */
bool equations_check_solvable(equations *e, diags *errors);

#endif

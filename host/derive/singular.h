/* singular.h: can the equations be solved for the highest derivatives at all? */
#ifndef DERIVE_SINGULAR_H
#define DERIVE_SINGULAR_H

#include "host/derive/equations.h"

/* Tries the mass matrix at a number of generic states and at the start. False, with an error that
 * names the cause, if it is singular at all of them or undefined at all of them. The mass matrix of
 * a mechanism given by energies must also be positive definite at one (otherwise: a negative mass).
 * A matrix that is singular only at some states (a pole of spherical coordinates) passes: such
 * states are found while running. e->mass_blur is set. */
bool equations_check_solvable(equations *e, diags *errors);

#endif

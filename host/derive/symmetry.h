/* symmetry.h: affine symmetries of a mechanism, and their momenta (Noether, "Invariante Variationsprobleme", 1918).
 *
 * The motion q -> q + e*(A q + b), with constant A and b, changes the kinetic energy T by e*dT and the potential energy
 * V by e*dV. All (A, b) with dT = 0 at every state form a linear space, because dT is linear in A and b. If dT = 0, the
 * momentum P = sum dL/dq_i' (A q + b)_i has this rate (equations.h defines L, Q_i and F):
 *
 *     dP/dt = -dV + sum (Q_i - dF/dq_i') (A q + b)_i + contacts
 *
 * The search misses symmetries that are not affine, such as most rotations in spherical coordinates. */
#ifndef DERIVE_SYMMETRY_H
#define DERIVE_SYMMETRY_H

#include "host/derive/equations.h"

typedef struct symmetry {
    const poly **shift;   /* [count] components of A q + b */
    const poly *momentum; /* P, with the parameters as symbols */
    const poly *stored;   /* dV; zero if the potential energy has the symmetry, too */
    bool conserved;       /* no energy, force or contact changes P */
} symmetry;

typedef struct symmetries {
    int count;
    symmetry *each; /* [count] first the conserved symmetries, last those with nonzero `stored` */
    int broken;     /* number of symmetries of T that V lacks and that are not shifts */
    /* values at random states confirm that no affine symmetry of T or V is missing */
    bool complete;
    bool flat; /* T has constant coefficients: every translation and rotation is affine */
} symmetries;

/* Finds the symmetries of a mechanism given by energies. Returns NULL if the algebra overflows. The equations own the
 * result. */
symmetries *symmetries_find(const equations *e);

/* Returns the sum of row[i] * s->shift[i] over all coordinates. */
const poly *symmetry_along(const equations *e, const symmetry *s, const poly *const *row);

#endif

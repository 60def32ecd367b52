/* symmetry.h: affine symmetries of a mechanism, and their momenta (Noether, "Invariante Variationsprobleme", 1918).
 *
 * A motion of the coordinates q -> q + e*(A q + b), with constant A and b, changes the kinetic energy by e*dT. dT is
 * linear in A and b, and each term of its normal form must vanish, so all (A, b) with dT = 0 for every state form a
 * linear space. The potential energy has the same condition. Lagrange's equations give the rate of the momentum P = sum
 * dT/dq_i' (A q + b)_i:
 *
 *     dP/dt = -dV + sum (Q_i - dF/dq_i') (A q + b)_i + contacts
 *
 * Translations and rotations are affine in Cartesian coordinates and in joint angles. In spherical coordinates, for
 * example, they are not, and the search does not find them. */
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
    /* first those with a conserved momentum, then other symmetries of T and V, then shifts (A = 0) of T only */
    int count;
    symmetry *each; /* [count] */
    int broken;     /* number of symmetries of T only that are not shifts */
    /* values at random states confirm that no affine symmetry of T or V is missing */
    bool complete;
    bool flat; /* T has constant coefficients: every translation and rotation is affine */
} symmetries;

/* Finds the symmetries of a mechanism given by energies. Returns NULL if the algebra overflows. The equations own the
 * result. */
symmetries *symmetries_find(const equations *e);

/* The sum of row[i] times the symmetry's motion of coordinate i: the power of a force, or the rate of a gap. */
const poly *symmetry_along(const equations *e, const symmetry *s, const poly *const *row);

#endif

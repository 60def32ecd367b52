/* symmetry.h: affine symmetries of a mechanism, and their momenta (Noether, "Invariante Variationsprobleme", 1918).
 *
 * A motion of the coordinates q -> q + e*(A q + b), with constant A and b, changes the kinetic energy T by e*dT. dT is
 * linear in A and b, and each term of its normal form must vanish, so all (A, b) with dT = 0 for every state form a
 * linear space. The same holds for the potential energy V. If dT = 0, Lagrange's equations (equations.h defines L, Q_i
 * and F) give the rate of the momentum P = sum dL/dq_i' (A q + b)_i:
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
    int count;
    /* [count] first those with a conserved momentum, then other symmetries of both T and V, then shifts (A = 0) of T */
    symmetry *each;
    int broken; /* number of symmetries of T that V lacks and that are not shifts */
    /* values at random states confirm that no affine symmetry of T or V is missing */
    bool complete;
    bool flat; /* T has constant coefficients: every translation and rotation is affine */
} symmetries;

/* Finds the symmetries of a mechanism given by energies. Returns NULL if the algebra overflows. The equations own the
 * result. */
symmetries *symmetries_find(const equations *e);

/* Returns the sum of row[i] * s->shift[i]: for a force row[], its power; for a contact's row J, the rate of the gap. */
const poly *symmetry_along(const equations *e, const symmetry *s, const poly *const *row);

#endif

/* solve.h: the operation list for the highest derivatives, M(q) q'' = f, solved for q''. */
#ifndef DERIVE_SOLVE_H
#define DERIVE_SOLVE_H

#include "host/algebra/poly.h"
#include "host/derive/lower.h"

/* === the equations for the highest derivatives, M(q) x = f ==================================== */

typedef struct linear_system {
    int n;
    bool symmetric;               /* a mass matrix: positive definite, so no pivot vanishes */
    const poly **mass;            /* [n * n], parameters folded */
    const poly **force;           /* [n] */
    const symbol *const *unknown; /* [n] */
    const bool *turning; /* [n] true: the unknown is an angle, whose row gets no scale of its own */
    const bool *wanted;  /* [n] the unknown's solution is needed, so its cost counts */
    /* true: unwanted solutions need not be correct, which allows more arrangements; false: contacts solve with the same
     * matrix, and the bits of their steps must not change */
    bool sparing;
    /* true: no hinge is eliminated (solve.c), because that would multiply the round-off by two to five
     * (docs/dev/numerics.md) */
    bool precise;
} linear_system;

/* Enters the solution into l->list, and stores the operation for each unknown in solution[n]. The caller sets `leaf`,
 * `turn` and `context` of *l. Several arrangements are tried on separate lists; the cheapest is entered. */
void solve_highest(lowering *l, const linear_system *system, int *solution);

#endif

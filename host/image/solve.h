/* solve.h: the operation list for the highest derivatives, M(q) q'' = f, solved for q''. */
#ifndef IMAGE_SOLVE_H
#define IMAGE_SOLVE_H

#include "host/algebra/poly.h"
#include "host/image/lower.h"

/* === the equations for the highest derivatives, M(q) x = f ==================================== */

typedef struct linear_system {
    int n;
    bool symmetric;     /* true for a mass matrix, which is positive definite: no pivot vanishes */
    const poly **mass;  /* [n * n] contains the values of the parameters, not their symbols */
    const poly **force; /* [n] */
    const symbol *const *unknown; /* [n] */
    const bool *turning;          /* [n] true: the unknown is an angle. It is not scaled */
    const bool *wanted;           /* [n] the unknown's solution is needed, so its cost counts */
    /* true: only the wanted solutions must be correct. `sparing` must be false if the model has contacts. */
    bool sparing;
    /* true: no hinge is eliminated. Elimination of hinges multiplies the round-off by 2 to 5 (docs/dev/numerics.md) */
    bool precise;
} linear_system;

/* Enters the cheapest of several arrangements into l->list. solution[n] receives the indices of the operations for
 * the unknowns. The caller must set l->leaf, l->turn and l->context first. */
void solve_highest(lowering *l, const linear_system *system, int *solution);

#endif

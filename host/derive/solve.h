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
    const bool *turning;          /* [n] unknown is an angle: its row keeps the energy's scale */
    const bool *wanted;           /* [n] unknown's solution is needed: what it costs counts */
    /* Solutions that are not wanted may come out as anything, and more arrangements are tried. False where contacts
     * solve with the same matrix: their steps keep their bits. */
    bool sparing;
    /* Roundings count more than operations: no hinge is eliminated (solve.h), whose list rounds two to five times as
     * much as what it replaces (docs/dev/numerics.md). */
    bool precise;
} linear_system;

/* Enters the solution into l->tape and stores the operation for each unknown in solution[n].
 * `leaf`, `turn` and `context` of *l are set by the caller; several arrangements are tried on tapes
 * of their own and the cheapest is entered. */
void solve_highest(lowering *l, const linear_system *system, int *solution);

#endif

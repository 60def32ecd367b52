/* solve.h: the operation list for the highest derivatives, M(q) q'' = f, solved for q''. */
#ifndef DERIVE_SOLVE_H
#define DERIVE_SOLVE_H

#include "linear_system.h"
#include "lower.h"

/* Enters the solution into l->tape and stores the operation for each unknown in solution[n].
 * `leaf`, `turn` and `context` of *l are set by the caller; several arrangements are tried on tapes
 * of their own and the cheapest is entered. */
void solve_highest(lowering *l, const linear_system *system, int *solution);

#endif

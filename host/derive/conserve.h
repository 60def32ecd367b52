/* conserve.h: coordinates recovered from their conserved momentum instead of being integrated (Routh's procedure;
 * Goldstein, Classical Mechanics, section 8.3).
 *
 * A coordinate X that appears in no energy and feels no force keeps its momentum
 *
 *     p = dL/dX' = sum_j m_Xj(q) q_j',
 *
 * so X' follows from the other rates. If the momentum is the rate of a function G(q) (a centre of mass times the total
 * mass), X follows, too: G(q) = G(q0) + p t. Then neither X nor X' is part of the state, and their drift is round-off
 * only. Otherwise X is integrated from X'. X is integrated, too, if a force or a contact depends on X, because a step
 * does not know the time. */
#ifndef DERIVE_CONSERVE_H
#define DERIVE_CONSERVE_H

#include "host/derive/equations.h"

typedef struct conservation {
    int count;         /* unknowns recovered */
    int *unknown;      /* [count] */
    int *number;       /* [equations->count] index of the unknown in unknown[], or -1 */
    bool closed;       /* the coordinates follow from G(q); otherwise they are integrated */
    const poly **rate; /* [count] the conserved rates as functions of the other rates */
    /* [count] the conserved coordinates as functions of the other coordinates and time; NULL unless closed */
    const poly **value;
} conservation;

/* Largest number of coordinates of one scene that are recovered from momenta. */
#define CONSERVED_MAX 3

/* The symbol of time in the polys above. */
extern const symbol conservation_time;

/* Recovers the coordinates for which wanted[equations->count] is true (NULL: none). Returns NULL, and reports the
 * reason, if such a coordinate's momentum is not conserved. */
conservation *conservation_make(const equations *e, const bool *wanted, diags *errors);
void conservation_free(conservation *c);

/* Returns p with the conserved coordinates and rates replaced by their expressions. */
const poly *conservation_settle(const equations *e, const conservation *c, const poly *p);

#endif

/* conserve.h: coordinates recovered from their conserved momentum instead of being integrated (Routh's procedure;
 * Goldstein, Classical Mechanics, section 8.3).
 *
 * A coordinate X that appears in no energy and feels no force has a constant momentum
 *
 *     p = dL/dX' = sum_j m_Xj(q) q_j',
 *
 * so X' follows from the other rates. If the momentum is the rate of a function G(q), such as total mass times centre
 * of mass, X follows, too: G(q) = G(q0) + p t. Then neither X nor X' is part of the state, and their drift is round-off
 * only. If there is no G(q), X is integrated from X'. X is also integrated if a force or contact depends on it, because
 * G(q0) + p t contains t, which a step does not know. */
#ifndef DERIVE_CONSERVE_H
#define DERIVE_CONSERVE_H

#include "host/derive/equations.h"

#define CONSERVED_MAX 3 /* coordinates of one scene that are recovered from momenta */

typedef struct conservation {
    int count;    /* unknowns recovered */
    int *unknown; /* [count] index of each in equations->unknowns */
    int *number;  /* [equations->count] index of the unknown in unknown[], or -1 */
    bool closed;  /* the coordinates follow from G(q); otherwise they are integrated */
    const poly *rate[CONSERVED_MAX]; /* the conserved rates as functions of the other rates */
    /* the conserved coordinates as functions of the other coordinates and time; NULL unless closed */
    const poly *value[CONSERVED_MAX];
} conservation;

extern const symbol conservation_time; /* the symbol of time in value[] */

/* Recovers the coordinates for which wanted[equations->count] is true (NULL: none). Returns NULL, reported, if the
 * momentum of such a coordinate is not conserved. The equations own the result. */
conservation *conservation_make(const equations *e, const bool *wanted, diags *errors);

/* Returns p with the conserved coordinates and rates replaced by their expressions. */
const poly *conservation_settle(const equations *e, const conservation *c, const poly *p);

#endif

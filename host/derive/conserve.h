/* conserve.h: coordinates recovered from their conserved momentum instead of being integrated.
 *
 * A coordinate X that appears in no energy and feels no force keeps its momentum
 *
 *     p = dL/dX' = sum_j m_Xj(q) q_j',
 *
 * so its rate follows algebraically from the others'. Where the momentum is the rate of a function
 * G(q) (a centre of mass times the total mass), X itself follows too: G(q) = G(q0) + p t. Then neither
 * X nor X' is part of the state, and their drift is rounding only. Where it is not, or where a force or a contact
 * depends on X (a step knows no time), X is integrated from its algebraic rate. (Routh's procedure; Goldstein, Classical Mechanics, section 8.3.)
 */
#ifndef DERIVE_CONSERVE_H
#define DERIVE_CONSERVE_H

#include "host/derive/equations.h"

typedef struct conservation {
    int count;          /* unknowns recovered */
    int *unknown;       /* [count] */
    int *number;        /* [equations->count] place in unknown[], or -1 */
    bool closed;        /* the coordinates follow from G(q); else they are integrated */
    const poly **rate;  /* [count] the rates from the others' */
    const poly **value; /* [count] the coordinates from the others and time; NULL unless closed */
} conservation;

/* At most so many coordinates are recovered at once. */
#define CONSERVED_MAX 3

/* The time of a run, in the polys above. */
extern const symbol conservation_time;

/* What `wanted` [equations->count] asks for (NULL: nothing), checked. NULL with an error when a named
 * coordinate's momentum is not conserved. */
conservation *conservation_make(const equations *e, const bool *wanted, diags *errors);
void conservation_free(conservation *c);

/* p with the conserved coordinates and rates replaced by what they follow from. */
const poly *conservation_settle(const equations *e, const conservation *c, const poly *p);

#endif

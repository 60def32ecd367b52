/* exact_motion.h: a scene's equations of motion as they are written: Lagrange's equations of its energies, or those of a
 * system, solved for the highest derivatives without a number being rounded (graph.h). */
#ifndef PROVE_EXACT_MOTION_H
#define PROVE_EXACT_MOTION_H

#include "host/lang/model.h"
#include "host/prove/graph.h"

/* Which unknown of the mechanism, and which of its derivatives. */
typedef struct exact_state {
    int unknown;
    int primes;
} exact_state;

typedef struct exact_motion {
    int states;
    exact_state *state; /* [states] */
    enclosure *start;   /* [states] SI */
    int *rate;          /* [states] nodes of the program: x' */
    /* Nodes that the rates need: the variables first, 0 to states - 1, then in the order in which they can be
     * evaluated. */
    node *node;
    int nodes;
} exact_motion;

/* NULL: it cannot be enclosed, which is reported: contacts, functions with corners, what is not defined at the start. */
exact_motion *exact_motion_make(const instance *inst, diags *errors);
void exact_motion_free(exact_motion *m);

#endif

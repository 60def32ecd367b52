/* exact_motion.h: a scene's exact equations of motion (Lagrange's, or those of a system), solved for the highest
 * derivatives without rounding any number (graph.h). */
#ifndef PROVE_EXACT_MOTION_H
#define PROVE_EXACT_MOTION_H

#include "host/lang/model.h"
#include "host/prove/graph.h"

typedef struct exact_state {
    int unknown;
    int primes;
} exact_state;

typedef struct exact_motion {
    int states;
    exact_state *state; /* [states] */
    enclosure *start;   /* [states] SI */
    int *rate;          /* [states] node of each state's rate */
    /* all nodes: the variables 0 to states - 1, then the others in order of evaluation */
    node *node;
    int nodes;
} exact_motion;

/* Returns NULL (reported) for contacts, functions with corners, or expressions undefined at the start. */
exact_motion *exact_motion_make(const instance *inst, diags *errors);
void exact_motion_free(exact_motion *m);

#endif

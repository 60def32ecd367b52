/* taylor.h: intervals that contain the Taylor coefficients of every motion through a box of states. They are computed
 * by recurrences (Moore; Rall and Corliss, An introduction to automatic differentiation, 1996). */
#ifndef PROVE_TAYLOR_H
#define PROVE_TAYLOR_H

#include "host/prove/exact_motion.h"

typedef struct taylor {
    const exact_motion *motion;
    int order;        /* order of the highest computed coefficient */
    int slopes_to;    /* order of the highest coefficient with derivatives; -1: none */
    int width;        /* stride of value[]: 1 + states if slopes_to >= 0, else 1 */
    enclosure *value; /* [nodes][order + 1][width] */
} taylor;

taylor *taylor_new(const exact_motion *m, int order, int slopes_to);
void taylor_free(taylor *t);

/* Computes all coefficients for x[states]. Returns false if one is not finite. */
bool taylor_find(taylor *t, const enclosure *x);

/* Estimates how many products of enclosures taylor_find() computes. */
double taylor_products(const taylor *t);

/* Coefficient k of state i: the value, followed by its derivatives if k <= slopes_to. */
const enclosure *taylor_of(const taylor *t, int i, int k);

#endif

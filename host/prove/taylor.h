/* taylor.h: the Taylor coefficients of a motion at a time, x(t + h) = sum of x_k h^k, by recurrences (Moore; Rall and
 * Corliss, An introduction to automatic differentiation, 1996), in enclosures: of all motions through a box of states at
 * once. With the slopes of the first coefficients by the state, where wished. */
#ifndef PROVE_TAYLOR_H
#define PROVE_TAYLOR_H

#include "exact_motion.h"

typedef struct taylor {
    const exact_motion *motion;
    int order;        /* coefficients from 0 to this one, */
    int slopes_to;    /* with slopes from 0 to this one; -1: without */
    int width;        /* 1, or 1 + states: with slopes */
    enclosure *value; /* [nodes][order + 1][width] */
} taylor;

taylor *taylor_new(const exact_motion *m, int order, int slopes_to);
void taylor_free(taylor *t);

/* All coefficients at the states x[states]. False: not all of them are finite there. */
bool taylor_find(taylor *t, const enclosure *x);

/* Products of enclosures that this takes, about. */
double taylor_products(const taylor *t);

/* Coefficient k of state i: the value, then, up to slopes_to, its slopes. */
const enclosure *taylor_of(const taylor *t, int i, int k);

#endif

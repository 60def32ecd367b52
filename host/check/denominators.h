/* denominators.h: expressions with a sign change at a pole, and expressions that may grow there.
 *
 * Watched are divisors, and bases of negative powers, down to their factors. If a system has moving factors of a highest
 * derivative, as in (k + s)*s' = -v*s, the divisors of its solution are watched, too. Values that depend on anything
 * outside the state, such as a rate recovered from a momentum, are not. */
#ifndef CHECK_DENOMINATORS_H
#define CHECK_DENOMINATORS_H

#include "host/check/nonfinite.h"
#include "host/engine/vector_field.h"

typedef struct divisor {
    int node;      /* of the blame list; if `derived`, an operation of the books list */
    bool of_a_tan; /* its cosine changes its sign */
    bool derived;
    bool leaps;    /* an event may change it at once */
    bool bends;    /* it is no straight line over the state, and may touch zero */
    double before; /* the step, */
    double aside;  /* hardly on its way, */
    double now;    /* and after it */
} divisor;

typedef struct denominators {
    blamed at;
    unsigned char *is; /* [nodes] */
    int *order;        /* [ordered] nodes that are needed for those watched, operands first */
    int ordered;
    divisor *divisor; /* [count] */
    int count;
    bool some_bend;
    int *asked; /* [questions] those that may grow, of the image's */
    int questions;
    vector_field *field; /* of the derived divisors; NULL without any */
    double *slope;       /* [field->n] */
} denominators;

denominators denominators_open(const image *im);
void denominators_close(denominators *d);

/* At a state, angles first: the watched values; or every expression, and value[denominators_values()] of those that may
 * grow. */
void denominators_see(denominators *d, const double *state);
void denominators_see_all(denominators *d, const double *state, double *value);
int denominators_values(const denominators *d);
/* At the state that was seen last. */
double denominators_value(const denominators *d, const divisor *of);
/* The image's question of one of the values: for a slope, the first equation with it. */
int denominators_question(const denominators *d, int value);

#endif

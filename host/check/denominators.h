/* denominators.h: what changes its sign where an expression of the file has a pole, and what may grow there.
 *
 * Watched is what is divided by, or raised to less than nothing, down to its factors, and what a tangent is taken of. Of a
 * system whose equations have factors that move before a highest derivative, as (k + s)*s' = -v*s has, what its solution is
 * divided by. What depends on what is no component of the state, as on what a momentum gives, is not. */
#ifndef CHECK_DENOMINATORS_H
#define CHECK_DENOMINATORS_H

#include "host/check/nonfinite.h"
#include "host/engine/vector_field.h"

typedef struct divisor {
    int node;      /* of the blame list; where `derived` an operation of the books list */
    bool of_a_tan; /* its cosine changes its sign */
    bool derived;
    bool leaps;    /* an event may change it at once */
    bool bends;    /* it is no straight line over the state, and may touch zero */
    double before; /* the step, */
    double aside;  /* hardly on its way, */
    double now;    /* and behind it */
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
    vector_field *field; /* of what is derived; NULL where nothing is */
    double *slope;       /* [field->n] */
} denominators;

denominators denominators_open(const image *im);
void denominators_close(denominators *d);

/* At a state, angles first: what is watched; or every expression, and value[denominators_values()] of what may grow. */
void denominators_see(denominators *d, const double *state);
void denominators_see_all(denominators *d, const double *state, double *value);
int denominators_values(const denominators *d);
/* At the state that was seen last. */
double denominators_value(const denominators *d, const divisor *of);
/* The question of the image that one of the values stands for: of a slope, the first equation that has it. */
int denominators_question(const denominators *d, int value);

#endif

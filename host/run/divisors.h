/* divisors.h: what changes its sign where an expression of the file has a pole, and what may grow there.
 *
 * Watched is what is divided by, or raised to less than nothing, down to its factors, and what a tangent is taken of. Of a
 * system whose equations have factors that move before a highest derivative, as (k + s)*s' = -v*s has, what its solution is
 * divided by. What depends on what is no component of the state, as on what a momentum gives, is not. */
#ifndef RUN_DIVISORS_H
#define RUN_DIVISORS_H

#include "field.h"
#include "host/run/undefined.h"

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

typedef struct divisors {
    blamed at;
    unsigned char *is; /* [nodes] */
    int *order;        /* [ordered] nodes that are needed for those watched, operands first */
    int ordered;
    divisor *divisor; /* [count] */
    int count;
    bool some_bend;
    int *asked; /* [questions] those that may grow, of the image's */
    int questions;
    field *field;  /* of what is derived; NULL where nothing is */
    double *slope; /* [field->n] */
} divisors;

divisors divisors_open(const image *im);
void divisors_close(divisors *d);

/* At a state, angles first: what is watched; or every expression, and value[divisors_values()] of what may grow. */
void divisors_see(divisors *d, const double *state);
void divisors_see_all(divisors *d, const double *state, double *value);
int divisors_values(const divisors *d);
/* At the state that was seen last. */
double divisors_value(const divisors *d, const divisor *of);
/* The question of the image that one of the values stands for: of a slope, the first equation that has it. */
int divisors_question(const divisors *d, int value);

#endif

/* vector_field.h: a scene's right-hand side in double: slopes at any state, without contact forces. Inputs keep their
 * start values.
 *
 * A state is x[n], angles then reals, as from engine_kind.state(). Slopes and energies must not contain a position that
 * is recovered from its momentum (host/derive/conserve.c), because such a position depends on time. */
#ifndef ENGINE_VECTOR_FIELD_H
#define ENGINE_VECTOR_FIELD_H

#include "engine.h"

typedef struct vector_field {
    int n;           /* components of the state */
    state_list list; /* list of the role IMAGE_BOOKS */
    int *
        next; /* [n] component that is the slope of component i; -1 - unknown: a highest derivative */
} vector_field;

vector_field *vector_field_open(const image *im, const engine_kind *kind);
void vector_field_close(vector_field *f);

void vector_field_slope(vector_field *f, const double *x, double *slope);
/* off[n]: bounds on the double round-off of the last slope's highest derivatives, at the same state; else 0. */
void vector_field_rounding(vector_field *f, const double *x, double *off);

#endif

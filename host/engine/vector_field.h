/* vector_field.h: a scene's right-hand side in double, whatever the number type of the run: slopes at any state. Contact
 * forces are not included.
 *
 * A state is x[n]: angles first, then reals, as engine_kind.state() gives them. Inputs keep their start values, as in the
 * balance. Slopes and energies must not contain a place that is recovered from its momentum (host/derive/conserve.c):
 * such a place depends on time. */
#ifndef ENGINE_VECTOR_FIELD_H
#define ENGINE_VECTOR_FIELD_H

#include "engine.h"

typedef struct vector_field {
    int n;           /* components of the state */
    state_list list; /* IMAGE_BOOKS */
    int *
        /* [n] the component that is the slope of component i. If the slope is the highest derivative of an unknown, it
         * is -1 - unknown. */
        next;
} vector_field;

vector_field *vector_field_open(const image *im, const engine_kind *kind);
void vector_field_close(vector_field *f);

/* Computes slope[n] at the state x[n]. */
void vector_field_slope(vector_field *f, const double *x, double *slope);
/* Computes off[n], bounds on the double round-off of the highest derivatives in the last slope, at the same state x[n].
 * It is 0 for all other components. */
void vector_field_rounding(vector_field *f, const double *x, double *off);

#endif

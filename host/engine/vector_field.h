/* vector_field.h: a scene's slopes in double at any state, without contact forces. Inputs keep their start values.
 *
 * A state is x[n]: angles, then reals, as from engine_kind.state(). Slopes and energies must not contain a position
 * that host/derive/conserve.c recovers from its momentum: such a position depends on time. */
#ifndef ENGINE_VECTOR_FIELD_H
#define ENGINE_VECTOR_FIELD_H

#include "engine.h"

typedef struct vector_field {
    int n;           /* components of the state */
    state_list list; /* list of the role IMAGE_BOOKS */
    /* [n] slope[i] = x[next[i]] if next[i] >= 0; otherwise result -1 - next[i] of `list` */
    int *next;
} vector_field;

vector_field *vector_field_open(const image *im, const engine_kind *kind);
void vector_field_close(vector_field *f);

void vector_field_slope(vector_field *f, const double *x, double *slope);
/* Bounds the round-off, in double, of the last slope, which was computed at `x`. off[i] is the bound of slope[i]. It is
 * zero if slope[i] is not a highest derivative, because such a slope is copied from `x`. */
void vector_field_rounding(vector_field *f, const double *x, double *off);

#endif

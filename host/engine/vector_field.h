/* vector_field.h: a scene's right-hand side in double, whatever its run computes in: slopes, energy and mass matrix at any state,
 * and the way from one state on. Of what goes on between contacts: their forces are not in it.
 *
 * A state is x[n]: angles first, then reals, as engine_kind.state() gives them. Inputs keep the values that they start
 * with, as in the books. No slope and no energy knows the time: what follows from it, a place that conserve recovers, none of
 * them may name (host/derive/conserve.c). */
#ifndef ENGINE_VECTOR_FIELD_H
#define ENGINE_VECTOR_FIELD_H

#include "engine.h"

typedef struct vector_field {
    const image *image;
    int n;    /* components of the state */
    int rows; /* of the mass matrix: coordinates with a rate */
    evaluator *evaluator;
    double *value; /* results of the image's books list at the state looked at last */
    double *input;
    double *base; /* [unknowns] momenta */
    int *next;    /* [n] the component that is the slope of this one; else -1 - its unknown */
    int *rate;    /* [rows] the component that is the rate of this coordinate */
} vector_field;

vector_field *vector_field_open(const image *im, const engine_kind *kind);
void vector_field_close(vector_field *f);

/* slope[n] at the state x[n]. */
void vector_field_slope(vector_field *f, const double *x, double *slope);
/* Of the state x[n] whose slope was asked for last: how far off rounding in double may put each highest one, at most; off[n], of the
 * others 0. */
void vector_field_rounding(vector_field *f, const double *x, double *off);
/* matrix[rows * rows]; `size[n]` is the size of a component where it counts. The scene must have energies. */
void vector_field_mass(vector_field *f, const double *x, const double *size, double *matrix);

#endif

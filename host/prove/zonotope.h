/* zonotope.h: the deviation of a point from a centre as a zonotope: a known drift plus generators, each times a number
 * from -1 to 1. (Kuehn, Rigorously computed orbits of dynamical systems without the wrapping effect, Computing 61,
 * 1998.) A linear map transforms them exactly, except for round-off, which becomes new generators. Only when there are
 * too many generators are the smallest ones enclosed in a box. */
#ifndef PROVE_ZONOTOPE_H
#define PROVE_ZONOTOPE_H

#include "host/number/enclosure.h"

typedef struct zonotope {
    int n; /* dimensions */
    int count;
    int most;
    double *drift;     /* [n] */
    double *generator; /* [most][n] */
} zonotope;

/* `most`: largest number of generators, at least 4 n. */
zonotope *zonotope_new(int n, int most);
void zonotope_free(zonotope *z);

/* The least box, box[n]. */
void zonotope_box(const zonotope *z, enclosure *box);
/* Axes, the columns of axes[n * n], nearly orthogonal, the first along the longest extent; and the deviation's
 * components along them, off[n]. */
void zonotope_frame(const zonotope *z, double *axes, enclosure *off);
/* Apply all maps in map[n * n] and add `more`[n]. */
void zonotope_map(zonotope *z, const enclosure *map, const enclosure *more);

#endif

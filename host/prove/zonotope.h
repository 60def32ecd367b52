/* zonotope.h: what a point may be off a centre, as the sum of a known drift and of generators, each times some number from -1
 * to 1 (Kuehn, Rigorously computed orbits of dynamical systems without the wrapping effect, Computing 61, 1998). A linear map
 * maps them exactly, but for rounding, which becomes more generators: nothing is wrapped into a box until there are too
 * many of them, and then the smallest only. */
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

/* At least 4 n generators at most. */
zonotope *zonotope_new(int n, int most);
void zonotope_free(zonotope *z);

/* The least box, box[n]. */
void zonotope_box(const zonotope *z, enclosure *box);
/* Axes, a column each of axes[n * n], nearly orthogonal, the first along what is longest; and what it is along them: it lies
 * in axes off, off[n]. */
void zonotope_frame(const zonotope *z, double *axes, enclosure *off);
/* It becomes what all maps in map[n * n] make of it, and `more`[n] added. */
void zonotope_map(zonotope *z, const enclosure *map, const enclosure *more);

#endif

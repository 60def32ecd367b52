/* orthogonal.h: axes for a box that turns along with the motion: nearly orthogonal, so that enclosing a turned box by a new one
 * along them costs little. (Lohner, Enclosing the solutions of ordinary initial and boundary value problems, 1987.) */
#ifndef PROVE_ORTHOGONAL_H
#define PROVE_ORTHOGONAL_H

#include "host/number/enclosure.h"

/* axes[n * n], a column each: the columns of `of`, longest first as seen with radii[n], made orthogonal one after the other
 * (Householder's reflections, in doubles: no error in it can make a result wrong, but only wide). */
void orthogonal_axes(int n, const double *of, const double *radii, double *axes);

/* inverse[n * n]: encloses that of `axes`. False: they are too far from orthogonal to tell. */
bool orthogonal_inverse(int n, const double *axes, enclosure *inverse);

/* to[n] = a x. */
void frame_apply(int n, const enclosure *a, const enclosure *x, enclosure *to);

#endif

/* hinge.h: eliminating a coordinate that hangs on a hinge, in symbols. For host/derive only. */
#ifndef DERIVE_HINGE_H
#define DERIVE_HINGE_H

#include "host/algebra/poly.h"

/* Eliminate the angle `turning`, unknown k of n, from the equations of those that are not gone, mass[n * n] and force[n].
 * True where its own diagonal is a number, *own, and its other entries are waves of it of one frequency: then, of what
 * is left,
 *
 *     mass_ij + across_i across_j / own,        force_i + across_i across_n / own
 *
 * stand for the equations without k; row k stays as it was. across[n + 1] is 0 for k and for those that are gone.
 * False, with nothing changed, for all others. */
bool hinge_eliminate(algebra *a, int n, const poly **mass, const poly **force, const bool *gone,
                     int k, const symbol *turning, double *own, const poly **across);

#endif

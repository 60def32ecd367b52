/* hinge.h: eliminating a coordinate that hangs on a hinge, in symbols. For host/derive only. */
#ifndef DERIVE_HINGE_H
#define DERIVE_HINGE_H

#include "host/algebra/poly.h"

/* Eliminate the angle `turning`, unknown k of n, from the others' equations, mass[n * n] and force[n]. True where its own
 * diagonal is a number A and its other entries are waves of it of one frequency: then, of what is left,
 *
 *     mass_ij + across_i across_j,        force_i + across_i tension
 *
 * stand for A times the equations without k; row k stays as it was. across[n] is 0 for i = k. False, with nothing
 * changed, for all others. */
bool hinge_eliminate(algebra *a, int n, const poly **mass, const poly **force, int k,
                     const symbol *turning, const poly **across, const poly **tension);

#endif

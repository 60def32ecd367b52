/* energy.h: which quantity the energy book keeps.
 *
 * Lagrange's equations with forces Q and a dissipation function F change the energy integral (Jacobi's)
 *
 *     h = sum_i q_i' dL/dq_i' - L,      dh/dt = sum_i q_i' (Q_i - dF/dq_i') - (dL/dt of the inputs),
 *
 * and no other sum of energies (Goldstein, Classical Mechanics, section 2.7). With T a homogeneous
 * quadratic form of the rates and V free of them, h is T + V. On a turntable, in a magnetic potential or
 * at relativistic speeds it is not: there T + V also changes by what keeps the turntable turning, which
 * no statement of the file mentions. */
#ifndef DERIVE_ENERGY_H
#define DERIVE_ENERGY_H

#include "equations.h"

/* h, folded, where it is not T + V; NULL where it is, or for a system. Where it is, nothing enters the
 * algebra: the order of its terms, and with it the generated code, stays as it was. */
const poly *energy_integral(const equations *e);

/* The power of what drives unknown i, an input with a rate: what it must do beyond the forces, losses and contacts. */
const poly *energy_drive(const equations *e, int i);

/* Does any mass depend on a rate? Then an impulse is not mass times the change of the rates. */
bool energy_mass_has_rates(const equations *e);

#endif

/* lagrange.h: derivation of the equations of motion of an instance. */
#ifndef DERIVE_LAGRANGE_H
#define DERIVE_LAGRANGE_H

#include "host/derive/equations.h"

/* Derive the equations. Returns NULL after an error, reported to `diags`. Errors are a coordinate without kinetic
 * energy, a singular mass matrix, an equation that is nonlinear in the highest derivative, and an expression above the
 * limit of size. */
equations *equations_derive(const instance *inst, diags *errors);
/* The same in an algebra that was used before (`before` may be NULL). The result must not depend on the earlier use
 * (tests/host/test_asked_first.c). */
typedef void equations_question(void *context, algebra *a, const instance *inst);
equations *equations_derive_after(const instance *inst, equations_question *before, void *context,
                                  diags *errors);

#endif

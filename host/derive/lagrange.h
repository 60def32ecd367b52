/* lagrange.h: deriving the equations of motion of an instance. */
#ifndef DERIVE_LAGRANGE_H
#define DERIVE_LAGRANGE_H

#include "host/derive/equations.h"

/* Derive. Returns NULL on error, reported to `diags` (no kinetic energy for a coordinate, singular
 * mass matrix, not linear in the highest derivative, an expression that grows out of bounds). */
equations *equations_derive(const instance *inst, diags *errors);
/* The same in an algebra that was asked something before (`before` may be NULL): what comes out must not depend on it
 * (tests/host/test_asked_first.c). */
typedef void equations_question(void *context, algebra *a, const instance *inst);
equations *equations_derive_after(const instance *inst, equations_question *before, void *context,
                                  diags *errors);

#endif

/* program.h: an instance as operation lists, with every parameter folded in. */
#ifndef DERIVE_PROGRAM_H
#define DERIVE_PROGRAM_H

#include "host/derive/image_parts.h"
#include "host/derive/layout.h"
#include "host/derive/solve.h"

/* The ledger. By Lagrange's equations, the momentum p_i = dL/dq_i' changes by dL/dq_i (gravity, springs, motion of the
 * other coordinates), and by generalized forces, dampers and contacts. The energy changes by the work of forces,
 * dampers and contacts, and with each input in T or V. If the energy integral is not T + V (equations.h), the integral
 * replaces the energy. */

typedef struct program {
    layout layout;
    const poly *integral; /* the energy integral if it is not T + V, else NULL (equations.h) */
    image_draft draft;    /* the image so far: its settings, lists, contacts and ledger */
} program;

/* Makes the lists of an instance, with tables if the settings ask for them. `conserve` [count] selects the coordinates
 * to recover from their momentum, or is NULL. Returns NULL after an error (reported), such as too many components, a
 * momentum that is not conserved, or a constant that is not finite. The caller frees the image, the equations own the rest. */
program *program_make(const equations *e, const bool *conserve, const image_settings *settings,
                      diags *errors);

uint64_t program_hash(const program *p);

#endif

/* program.h: an instance as operation lists, with every parameter folded in. */
#ifndef IMAGE_PROGRAM_H
#define IMAGE_PROGRAM_H

#include "host/image/image_parts.h"
#include "host/image/layout.h"
#include "host/image/solve.h"

/* The ledger has an entry for each cause that changes a momentum p_i = dL/dq_i' or the energy. Causes for p_i are
 * dL/dq_i, generalized forces, dampers and contacts (Lagrange's equations). Causes for the energy are forces, dampers,
 * contacts and the inputs in T or V. An energy integral other than T + V replaces the energy (equations.h). */

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

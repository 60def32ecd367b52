/* program.h: an instance as operation lists, with every parameter folded in. */
#ifndef DERIVE_PROGRAM_H
#define DERIVE_PROGRAM_H

#include "host/derive/image_parts.h"
#include "host/derive/layout.h"
#include "host/derive/solve.h"

/* The ledger. By Lagrange's equations, the momentum p_i = dL/dq_i' changes by dL/dq_i (gravity, springs, the other
 * coordinates' motion) and by each generalized force, damper and contact. The energy changes by the work of forces,
 * dampers and contacts, and by each change of an input in the energies. If the energy integral is not T + V, the
 * ledger has the integral instead of the energy (equations.h). */

typedef struct program {
    layout layout;
    conservation *conserved;
    const poly *integral; /* the energy integral if it is not T + V, else NULL (equations.h) */
    /* the image so far: its settings, lists, contacts and ledger; made == NULL: the caller has taken it */
    image_draft draft;
} program;

/* Makes the lists of an instance. `conserve` [count] selects the coordinates to recover from their momentum, or is
 * NULL. Returns NULL after an error (reported), such as too many components, a momentum that is not conserved, or a
 * constant that is not finite. */
program *program_make(const equations *e, const bool *conserve, const image_settings *settings,
                      diags *errors);
/* Replaces the step's functions of one angle by tables (tables.h), if the settings ask for it. Returns false (reported)
 * if that is impossible. */
bool program_look_up(program *p, diags *errors);
void program_free(program *p);

uint64_t program_hash(const program *p);

#endif
